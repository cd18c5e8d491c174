// Displaced water by the methods that rasterize, against the reference.
#include <catch2/catch.hpp>

#include <string>

#include "blend_scene.h"
#include "oracle_scene.h"
#include "refraction_oracle.h"

using namespace shoal_test;

namespace {

constexpr int kWidth = 96, kHeight = 64;

RenderScene wavy(const std::string& name, std::uint64_t triangles, float slope) {
  RenderScene scene = built_in(name, triangles);
  for (WaterBody& body : scene.waters) {
    body.surface.kind = SurfaceKind::kGerstner;
    body.surface.slope = slope;
    body.surface.wavelength_m = 0.7f;
    body.surface.geometry = WaterGeometry::kDisplaced;
  }
  return scene;
}

FrameSettings settings_of(const char* method) {
  FrameSettings s;
  s.method = method;
  s.width_px = kWidth, s.height_px = kHeight;
  s.isa = supported_isas().front();
  s.threads = 2;
  s.keep_linear = true;
  s.aovs = (1u << static_cast<unsigned>(Aov::kCount)) - 1u;
  return s;
}

struct Agreement {
  int water = 0, mask = 0, position = 0, object = 0, hits = 0, far_hits = 0;
};

Agreement compare(const RenderScene& scene, const Camera& camera, const char* method) {
  const Frame truth = render_scene(scene, camera, settings_of("ray-traced")),
              shown = render_scene(scene, camera, settings_of(method));
  Agreement a;
  for (std::size_t i = 0; i < kWidth * kHeight; ++i) {
    const auto uints = [&](const Frame& frame, Aov aov) { return image_of(frame, aov).uints[i]; };
    const auto apart = [&](Aov aov) {
      return norm_of(vector_in(image_of(truth, aov), i) - vector_in(image_of(shown, aov), i));
    };
    const bool wet = uints(truth, Aov::kWaterMask) != 0;
    a.mask += wet != (uints(shown, Aov::kWaterMask) != 0);
    if (!wet || uints(shown, Aov::kWaterMask) == 0) continue;
    ++a.water;
    a.position += apart(Aov::kPosition) != 0 || apart(Aov::kNormal) != 0;
    if (uints(truth, Aov::kHitKind) != uints(shown, Aov::kHitKind) ||
        uints(truth, Aov::kHitId) != uints(shown, Aov::kHitId)) {
      a.object += 1;
      continue;
    }
    if (uints(truth, Aov::kHitKind) != 1) continue;
    ++a.hits;
    a.far_hits += apart(Aov::kHitPosition) > 1e-5;
  }
  return a;
}

}  // namespace

TEST_CASE("displaced: methods see the reference's surface, and through it nearly what it sees", "[displaced]") {
  for (const char* name : {"box", "pool"}) {
    const RenderScene scene = wavy(name, 1500, 0.1f);
    RenderScene plane = scene;
    for (WaterBody& body : plane.waters) body.surface.geometry = WaterGeometry::kNormals;
    for (const PlacedCamera& placed : scene.cameras)
      for (const char* method : {"hybrid", "none"}) {
        const Agreement a = compare(scene, placed.camera, method);
        CAPTURE(name, placed.name, method, a.water, a.mask, a.position, a.object, a.hits, a.far_hits);
        CHECK(a.water > 100);
        CHECK(a.mask * 1000 <= kWidth * kHeight);  // where rasterized edges meet the water
        CHECK(a.position == 0);
        if (std::string(method) == "none") continue;
        // Beyond the surface the narrow phase finds as much as under waves that are normals alone.
        CHECK(a.object <= compare(plane, placed.camera, method).object + a.water / 20);
        CHECK(a.far_hits * 100 <= a.hits);
      }
  }
}

TEST_CASE("displaced: an eye between plane and crest, or in a trough, is on the surface's side", "[displaced]") {
  const RenderScene scene = wavy("box", 600, 0.15f);
  const WaterBody& body = scene.waters[0];
  const WaterSurface surface = prepare_surface(body.surface, 0, plane_extent(body));
  // The highest and the lowest place of a grid over the middle.
  Vec3d high{0, -1, 0}, low{0, 1, 0};
  for (int i = -20; i <= 20; ++i)
    for (int k = -20; k <= 20; ++k) {
      const double x = 0.02 * i, z = 0.02 * k, y = surface_oracle::height(surface, x, z);
      if (y > high.y) high = {x, y, z};
      if (y < low.y) low = {x, y, z};
    }
  REQUIRE(high.y > 0.015);
  REQUIRE(low.y < -0.015);
  for (const bool in_crest : {true, false}) {
    const Vec3d place = in_crest ? high : low;
    const double y = 0.4 * place.y;  // between the plane and the surface
    const Vec3f eye =
        body.origin + Vec3f{static_cast<float>(place.x), static_cast<float>(y), static_cast<float>(place.z)};
    const Camera camera = shoal_test::camera_at(eye, eye + Vec3f{0.6f, in_crest ? -0.05f : -0.1f, 0.3f}, 1.0);
    const Agreement a = compare(scene, camera, "hybrid");
    CAPTURE(in_crest, a.water, a.mask, a.position, a.object, a.hits);
    CHECK(a.water > 50);
    CHECK(a.mask * 200 <= kWidth * kHeight);
    CHECK(a.position == 0);
    // What is in the water right before the eye is dimmed as by the reference.
    const Frame truth = render_scene(scene, camera, settings_of("ray-traced")),
                shown = render_scene(scene, camera, settings_of("hybrid"));
    int same = 0, dry = 0;
    for (std::size_t i = 0; i < kWidth * kHeight; ++i) {
      if (image_of(truth, Aov::kWaterMask).uints[i] != 0 || image_of(truth, Aov::kIdTriangle).uints[i] == kNothing)
        continue;
      if (image_of(truth, Aov::kIdTriangle).uints[i] != image_of(shown, Aov::kIdTriangle).uints[i]) continue;
      ++dry;
      bool equal = true;
      for (std::size_t c = 0; c < 3; ++c)
        equal = equal && std::fabs(truth.linear[4 * i + c] - shown.linear[4 * i + c]) < 1e-5f;
      same += equal;
    }
    CAPTURE(dry, same);
    if (in_crest) CHECK(dry > 100);
    CHECK(same == dry);
  }
}

TEST_CASE("displaced: every stage is the same for any threads, tiles and instruction set", "[displaced]") {
  const RenderScene scene = wavy("box", 600, 0.1f);
  for (const PlacedCamera& placed : scene.cameras) {
    FrameSettings settings = settings_of("hybrid");
    settings.digests = true;
    settings.isa = supported_isas().back(), settings.threads = 1;
    const Frame expected = render_scene(scene, placed.camera, settings);
    for (const Isa isa : supported_isas())
      for (const int threads : {2, 7}) {
        settings.isa = isa, settings.threads = threads, settings.tile_px = threads == 2 ? 32 : 256;
        const Frame got = render_scene(scene, placed.camera, settings);
        CAPTURE(placed.name, isa_name(isa), threads);
        CHECK(got.digests == expected.digests);
        CHECK(got.srgb8 == expected.srgb8);
      }
  }
}
