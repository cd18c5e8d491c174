// Image-space methods: what they show against the ray tracer, and that every configuration gives the same bytes.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "oracle_scene.h"
#include "refraction/renderer.h"
#include "refraction_oracle.h"

using namespace shoal_test;

namespace {

using Options = std::map<std::string, std::string>;

RenderScene scene_with_waves(const char* name, std::uint64_t triangles, float slope) {
  RenderScene scene = built_in(name, triangles);
  for (WaterBody& body : scene.waters) {
    if (slope == 0.0f) continue;
    body.surface.kind = SurfaceKind::kGradientWaves;
    body.surface.slope = slope;
  }
  return scene;
}

FrameSettings settings_of(const char* method, const Options& options) {
  FrameSettings s;
  s.method = method;
  s.method_options = options;
  s.width_px = 320, s.height_px = 180;
  s.isa = supported_isas().front();
  s.shadow_map_px = 512;
  s.aovs = 1u << static_cast<int>(Aov::kHitKind) | 1u << static_cast<int>(Aov::kHitId) |
           1u << static_cast<int>(Aov::kHitPosition) | 1u << static_cast<int>(Aov::kHitApproximate) |
           1u << static_cast<int>(Aov::kWaterMask);
  return s;
}

Frame draw(const RenderScene& scene, int camera, const char* method, const Options& options = {}) {
  Frame frame;
  Renderer(scene, settings_of(method, options))
      .render(scene.cameras[static_cast<std::size_t>(camera)].camera, 1.0, frame);
  return frame;
}

const AovImage& plane_of(const Frame& frame, Aov aov) {
  return *std::find_if(frame.aovs.begin(), frame.aovs.end(), [&](const AovImage& i) { return i.aov == aov; });
}

std::uint32_t object_of(const RenderScene& scene, std::uint32_t id) {
  std::uint32_t last = kNothing;
  for (std::size_t i = 0; i < scene.geometry.drawables.size() && scene.geometry.drawables[i].first_triangle <= id; ++i)
    last = static_cast<std::uint32_t>(i);
  return last;
}

// Over the water: metres between the points where both show a surface, and the share that shows another object or kind.
struct Difference {
  double median_m = 0, p95_m = 0, wrong_object = 0, wrong_surface = 0;  // the last: 10 cm off, or another kind
};

Difference compare(const RenderScene& scene, const Frame& a, const Frame& b) {
  std::vector<double> metres;
  std::size_t water = 0, wrong = 0, far_off = 0;
  const AovImage &kind_a = plane_of(a, Aov::kHitKind), &kind_b = plane_of(b, Aov::kHitKind);
  const AovImage &id_a = plane_of(a, Aov::kHitId), &id_b = plane_of(b, Aov::kHitId);
  const std::vector<float>&p = plane_of(a, Aov::kHitPosition).floats, &q = plane_of(b, Aov::kHitPosition).floats;
  for (std::size_t i = 0; i < kind_a.uints.size(); ++i) {
    if (plane_of(a, Aov::kWaterMask).uints[i] == 0 || plane_of(b, Aov::kWaterMask).uints[i] == 0) continue;
    ++water;
    const bool surfaces = kind_a.uints[i] == 1 && kind_b.uints[i] == 1;
    if (kind_a.uints[i] != kind_b.uints[i] ||
        (surfaces && object_of(scene, id_a.uints[i]) != object_of(scene, id_b.uints[i])))
      ++wrong;
    far_off += kind_a.uints[i] != kind_b.uints[i];
    if (!surfaces) continue;
    double d2 = 0;
    for (std::size_t c = 0; c < 3; ++c)
      d2 += std::pow(static_cast<double>(p[3 * i + c]) - static_cast<double>(q[3 * i + c]), 2);
    metres.push_back(std::sqrt(d2));
    far_off += metres.back() > 0.1;
  }
  REQUIRE(metres.size() > 2000);
  std::sort(metres.begin(), metres.end());
  return {metres[metres.size() / 2], metres[metres.size() * 95 / 100],
          static_cast<double>(wrong) / static_cast<double>(water),
          static_cast<double>(far_off) / static_cast<double>(water)};
}

enum PoolCamera { kHigh, kGrazing, kUnder };

}  // namespace

TEST_CASE("image space: through flat water liu-2020 and steel-2024 show what is there") {
  const RenderScene scene = scene_with_waves("pool", 5000, 0);
  for (const int camera : {kHigh, kGrazing, kUnder}) {
    const Frame truth = draw(scene, camera, "ray-traced");
    const Difference liu = compare(scene, draw(scene, camera, "liu-2020"), truth);
    const Difference steel = compare(scene, draw(scene, camera, "steel-2024"), truth);
    CAPTURE(camera, liu.median_m, liu.p95_m, liu.wrong_object, steel.median_m, steel.p95_m, steel.wrong_object);
    CHECK(liu.median_m < 1e-3);
    CHECK(liu.p95_m < 1e-2);
    CHECK(liu.wrong_object < 0.004);
    CHECK(steel.median_m < 1e-3);
    CHECK(steel.p95_m < 1e-2);
    CHECK(steel.wrong_object < 0.004);
  }
}

TEST_CASE("image space: an orthographic view through flat water") {
  RenderScene scene = scene_with_waves("pool", 5000, 0);
  shoal::Camera& camera = scene.cameras[kHigh].camera;
  camera.orthographic = true;
  camera.xmag_m = 6.0f, camera.ymag_m = 3.375f, camera.far_m = 60.0f;
  const Frame truth = draw(scene, kHigh, "ray-traced");
  for (const char* method : {"liu-2020", "steel-2024"}) {
    const Difference d = compare(scene, draw(scene, kHigh, method), truth);
    CAPTURE(method, d.median_m, d.p95_m, d.wrong_object);
    CHECK(d.median_m < 1e-3);
    CHECK(d.p95_m < 1e-2);
    CHECK(d.wrong_object < 0.004);
  }
  const Difference straight = compare(scene, draw(scene, kHigh, "distort"), draw(scene, kHigh, "none"));
  CHECK(straight.p95_m < 1e-3);
  CHECK(straight.wrong_object < 0.001);
  // The march: every place is in the frame, and it is nearer to the reference than no refraction is.
  const Difference marched = compare(scene, draw(scene, kHigh, "screen-space"), truth),
                   none = compare(scene, draw(scene, kHigh, "none"), truth);
  CHECK(marched.median_m < 0.7 * none.median_m);
}

TEST_CASE("image space: under waves liu-2020 meets planes exactly, steel-2024 nearly, unrefracted frames miss much") {
  const RenderScene scene = scene_with_waves("pool", 5000, 0.05f);
  for (const int camera : {kHigh, kGrazing}) {
    const Frame truth = draw(scene, camera, "ray-traced");
    const auto error = [&](const char* method, const Options& options = {}) {
      const Difference d = compare(scene, draw(scene, camera, method, options), truth);
      UNSCOPED_INFO("camera " << camera << ", " << method << ": median " << d.median_m << " m, p95 " << d.p95_m
                              << " m, wrong object " << d.wrong_object << ", surface " << d.wrong_surface);
      return d;
    };
    const Difference liu = error("liu-2020"), steel = error("steel-2024"), pom = error("steel-2024", {{"pom", "true"}});
    const Difference narrow = error("narrow-only"), screen = error("screen-space"), distort = error("distort");
    CHECK(liu.median_m < 1e-3);
    CHECK(liu.p95_m < 0.05);
    CHECK(liu.wrong_object < 0.03);
    CHECK(steel.median_m < 0.03);
    CHECK(steel.p95_m < 0.15);
    CHECK(steel.wrong_object < 0.03);
    // The march finds what simple parallax jumps over.
    CHECK(pom.wrong_object < 0.03);
    if (camera == kGrazing) CHECK(pom.wrong_surface < 0.7 * steel.wrong_surface);
    for (const Difference& d : {narrow, screen, distort}) CHECK(d.wrong_object > 5 * liu.wrong_object);
    CHECK(distort.median_m > 1.0);
  }
}

TEST_CASE("image space: distort of flat water is none, and of no strength too") {
  const auto same = [](const RenderScene& scene, const Options& options) {
    for (const int camera : {kHigh, kGrazing}) {
      const auto drawn = [&](const char* method, const Options& given) {
        FrameSettings settings = settings_of(method, given);
        settings.reflections = Reflections::kTraced;  // each method samples a planar layer in its own way
        Frame frame;
        Renderer(scene, settings).render(scene.cameras[static_cast<std::size_t>(camera)].camera, 1.0, frame);
        return frame;
      };
      const Frame a = drawn("distort", options), b = drawn("none", {});
      const Difference d = compare(scene, a, b);
      CHECK(d.wrong_object < 0.001);
      CHECK(d.p95_m < 1e-4);
      // Lit from the eye instead of from the water: a level of rounding here and there.
      std::size_t off = 0;
      for (std::size_t i = 0; i < a.srgb8.size(); ++i) off += std::abs(int{a.srgb8[i]} - int{b.srgb8[i]}) > 1;
      CHECK(static_cast<double>(off) < 0.002 * static_cast<double>(a.srgb8.size()));
    }
  };
  same(scene_with_waves("pool", 5000, 0), {});
  same(scene_with_waves("pool", 5000, 0.05f), {{"strength", "0"}, {"reflection", "false"}});
}

TEST_CASE("image space: the mask of places outside of the frame") {
  const RenderScene scene = scene_with_waves("pool", 2000, 0.05f);
  const auto outside = [&](const char* method, const Options& options) {
    return plane_of(draw(scene, kGrazing, method, options), Aov::kHitApproximate).uints;
  };
  // Pushed by less than 0.2 x 0.1 of the frame's height: only what is that near to its edge can leave it.
  const std::vector<std::uint32_t> little = outside("distort", {});
  std::size_t edge = 0, middle = 0;
  for (std::size_t i = 0; i < little.size(); ++i) {
    const std::size_t x = i % 320, y = i / 320;
    (x < 4 || x >= 316 || y < 4 || y >= 176 ? edge : middle) += little[i];
  }
  CHECK(edge > 10);
  CHECK(middle == 0);
  const std::vector<std::uint32_t> none = outside("distort", {{"strength", "0"}});
  CHECK(std::count(none.begin(), none.end(), 1u) == 0);
  const std::vector<std::uint32_t> after = outside("hybrid", {});
  CHECK(std::count(after.begin(), after.end(), 1u) == 0);
}

TEST_CASE("image space: liu-2020 as printed draws all but nothing") {
  const RenderScene scene = scene_with_waves("pool", 2000, 0);
  const Frame printed = draw(scene, kHigh, "liu-2020", {{"as-printed", "true"}});
  const AovImage& kind = plane_of(printed, Aov::kHitKind);
  const std::size_t water = static_cast<std::size_t>(printed.water_pixels);
  const auto surfaces = static_cast<std::size_t>(std::count(kind.uints.begin(), kind.uints.end(), 1u));
  CHECK(surfaces < water / 10);
}

TEST_CASE("image space: the same bytes for any threads, tile size and instruction set, under waves") {
  const RenderScene scene = scene_with_waves("pool", 2000, 0.05f);
  const std::vector<std::pair<const char*, Options>> methods = {
      {"liu-2020", {}},    {"liu-2020", {{"as-printed", "true"}}},
      {"steel-2024", {}},  {"steel-2024", {{"pom", "true"}}},
      {"narrow-only", {}}, {"screen-space", {{"jitter", "1"}, {"stride", "3"}}},
      {"distort", {}}};
  for (const auto& [method, options] : methods) {
    for (const int camera : {kGrazing, kUnder}) {
      FrameSettings settings = settings_of(method, options);
      settings.width_px = 131, settings.height_px = 77;
      settings.digests = true;
      std::vector<std::pair<std::string, std::string>> expected;
      for (const Isa isa : supported_isas())
        for (const auto& [threads, tile] : {std::pair{1, 64}, {7, 16}, {2, 256}}) {
          settings.isa = isa, settings.threads = threads, settings.tile_px = tile;
          Frame frame;
          Renderer(scene, settings).render(scene.cameras[static_cast<std::size_t>(camera)].camera, 0.5, frame);
          if (expected.empty()) expected = frame.digests;
          INFO(method << ", camera " << camera << ", " << isa_name(isa) << ", " << threads << " threads, tile "
                      << tile);
          CHECK(frame.digests == expected);
        }
    }
  }
}
