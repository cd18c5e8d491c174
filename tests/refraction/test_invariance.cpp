// Every stage's digest is the same for any threads, tile size and instruction set; every method, every camera.
// (Compilers, optimisation levels and NEON: tests/invariance/matrix.sh.)
#include <catch2/catch.hpp>

#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "refraction/renderer.h"
#include "oracle_scene.h"
#include "refraction_oracle.h"

using namespace shoal_test;

namespace {

using Digests = std::vector<std::pair<std::string, std::string>>;

struct How {
  Isa isa;
  int threads, tile_px;
};

// All cameras of a scene, one after the other, by one renderer: buffers are used again.
std::vector<Digests> render_all(const RenderScene& scene, FrameSettings settings, const How& how) {
  settings.isa = how.isa, settings.threads = how.threads, settings.tile_px = how.tile_px;
  Renderer renderer(scene, settings);
  std::vector<Digests> out;
  for (const PlacedCamera& placed : scene.cameras) {
    Frame frame;
    renderer.render(placed.camera, 0.25, frame);
    out.push_back(frame.digests);
    out.back().emplace_back("picture", picture_digest(frame));
  }
  return out;
}

void check_settings(const char* name, int width_px, int height_px, int spp, int anisotropy = 1) {
  const RenderScene scene = built_in(name, 2000);
  for (const MethodInfo& method : method_infos()) {
    FrameSettings settings;
    settings.method = method.name;
    settings.width_px = width_px, settings.height_px = height_px;
    settings.spp = spp;
    settings.anisotropy = anisotropy;
    settings.digests = true;
    settings.shadow_map_px = 512;  // of a map that each of these renderers draws anew
    if (settings.method == "distance-field") settings.method_options["resolution"] = "32";  // likewise a field
    std::vector<Digests> expected;
    try {
      expected = render_all(scene, settings, {supported_isas().back(), 1, 64});
    } catch (const NotApplicable&) {
      continue;  // block-grid, where no floor is level
    }
    std::vector<How> ways;
    const bool is_default = &method == &method_infos().front();
    for (const Isa isa : supported_isas()) {
      // Of the default method the best set in full where a frame is one plain sample, all others along the diagonals;
      // of every other method the corners, for its stages are made of the same templates.
      if (!is_default) {
        ways.push_back({isa, 7, 16});
        if (isa == supported_isas().front()) ways.push_back({isa, 2, 256});
        continue;
      }
      for (const int tile : {16, 32, 64, 128, 256})
        for (const int threads : {1, 2, 7})
          if ((spp == 1 && anisotropy == 1 && isa == supported_isas().front()) || (tile / 16 + threads) % 3 == 0)
            ways.push_back({isa, threads, tile});
    }
    for (const How& how : ways) {
      const std::vector<Digests> got = render_all(scene, settings, how);
      for (std::size_t c = 0; c < expected.size(); ++c) {
        REQUIRE(got[c].size() == expected[c].size());
        for (std::size_t s = 0; s < expected[c].size(); ++s) {
          if (got[c][s] == expected[c][s]) continue;
          FAIL_CHECK(name << " " << method.name << " " << scene.cameras[c].name << " " << width_px << "x" << height_px
                          << " spp " << spp << ", " << isa_name(how.isa) << ", " << how.threads << " threads, tile "
                          << how.tile_px << ": stage " << expected[c][s].first << " differs");
          break;  // the first stage that differs is the guilty one
        }
      }
    }
  }
  SUCCEED();
}

}  // namespace

TEST_CASE("invariance: box, one sample") { check_settings("box", 131, 77, 1); }
TEST_CASE("invariance: box, four samples") { check_settings("box", 67, 131, 4); }
TEST_CASE("invariance: pool, one sample") { check_settings("pool", 131, 77, 1); }
TEST_CASE("invariance: pool, four samples") { check_settings("pool", 97, 65, 4); }
TEST_CASE("invariance: pool, anisotropic textures") { check_settings("pool", 97, 65, 1, 8); }
// Moving water with a shore; two planes of water.
TEST_CASE("invariance: pond") { check_settings("pond", 97, 51, 1); }
TEST_CASE("invariance: tank") { check_settings("tank", 67, 45, 1); }
TEST_CASE("invariance: frames smaller than a block") { check_settings("box", 3, 2, 1); }

TEST_CASE("invariance: a digest sees the camera, the method and the size") {
  const RenderScene scene = built_in("box", 600);
  FrameSettings settings;
  settings.width_px = 131, settings.height_px = 77, settings.digests = true;
  const How how{supported_isas().front(), 2, 64};
  const std::vector<Digests> bent = render_all(scene, settings, how);
  CHECK(bent[0] != bent[1]);
  settings.method = "none";
  CHECK(render_all(scene, settings, how)[0] != bent[0]);
  settings.method = "hybrid";
  settings.width_px = 132;
  CHECK(render_all(scene, settings, how)[0] != bent[0]);
}
