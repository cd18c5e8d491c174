// block-grid against Snell's law in double on a level floor, and the scenes that it refuses.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "raster/bin.h"
#include "refraction/field/floor.h"
#include "oracle_scene.h"
#include "refraction_oracle.h"

using namespace shoal_test;

namespace {

constexpr double kDepth = 0.8;  // of box's floor

// Where the refracted ray through a point of the frame meets the floor's plane; y is the plane's.
Vec3d floor_point(const Camera& camera, int width_px, int height_px, double x_px, double y_px) {
  const double per_px = 2.0 * static_cast<double>(camera.tan_half_yfov) / height_px;
  const Vec3d d =
      unit_of(as_double(camera.forward_world) + as_double(camera.right_world) * ((x_px - 0.5 * width_px) * per_px) +
              as_double(camera.up_world) * ((0.5 * height_px - y_px) * per_px));
  const Vec3d eye = as_double(camera.position_world), at = eye - d * (eye.y / d.y);
  // Snell's law on the sines; horizontal directions keep.
  const double ior = static_cast<double>(1.333f), sine = std::sqrt(d.x * d.x + d.z * d.z) / ior;
  const double across = kDepth * sine / std::sqrt(1.0 - sine * sine) / (sine * ior);
  return {at.x + d.x * across, -kDepth, at.z + d.z * across};
}

struct Shown {
  Frame frame;
  const PlacedCamera* placed;
};
Shown render(const RenderScene& scene, const char* block, const char* camera) {
  FrameSettings settings;
  settings.method = "block-grid";
  settings.method_options["block"] = block;
  settings.width_px = 131, settings.height_px = 77;
  settings.isa = supported_isas().front();
  settings.shadows = Shadows::kOff;
  settings.aovs = 1u << static_cast<int>(Aov::kHitKind) | 1u << static_cast<int>(Aov::kHitPosition);
  Shown shown;
  shown.placed = &*std::find_if(scene.cameras.begin(), scene.cameras.end(),
                                [&](const PlacedCamera& p) { return p.name == camera; });
  Renderer(scene, settings).render(shown.placed->camera, 0, shown.frame);
  return shown;
}

}  // namespace

TEST_CASE("block-grid interpolates exact rays at the corners of its blocks", "[refraction]") {
  const RenderScene scene = built_in("box", 600);
  for (const int block : {1, 3, 8, 32}) {
    for (const char* camera : {"high", "grazing"}) {
      const Shown shown = render(scene, std::to_string(block).c_str(), camera);
      const AovImage &kind = image_of(shown.frame, Aov::kHitKind), &position = image_of(shown.frame, Aov::kHitPosition);
      const auto corner = [&](int i, int j) {
        return floor_point(shown.placed->camera, 131, 77, i * block, j * block);
      };
      std::size_t surfaces = 0, misses = 0, others = 0;
      double worst_m = 0;
      for (int y = 0; y < 77; ++y)
        for (int x = 0; x < 131; ++x) {
          const std::size_t at = static_cast<std::size_t>(y * 131 + x);
          const auto shows = static_cast<HitKind>(kind.uints[at]);
          if (shows == HitKind::kNoWater) continue;
          misses += shows == HitKind::kMiss ? 1 : 0;
          others += shows != HitKind::kMiss && shows != HitKind::kSurface ? 1 : 0;
          const int i = x / block, j = y / block;
          const double u = (x + 0.5) / block - i, v = (y + 0.5) / block - j;
          const Vec3d want = (corner(i, j) * (1 - u) + corner(i + 1, j) * u) * (1 - v) +
                             (corner(i, j + 1) * (1 - u) + corner(i + 1, j + 1) * u) * v;
          // On the floor exactly where it reaches.
          const bool inside = std::fabs(want.x) < 1.0 && std::fabs(want.z) < 0.7;
          const double to_edge = std::min(std::fabs(std::fabs(want.x) - 1.0), std::fabs(std::fabs(want.z) - 0.7));
          if (to_edge > 1e-4) CHECK(inside == (shows == HitKind::kSurface));
          if (shows != HitKind::kSurface) continue;
          ++surfaces;
          worst_m = std::max(worst_m, norm_of(vector_in(position, at) - want));
        }
      CAPTURE(block, camera, surfaces, misses, worst_m);
      CHECK(surfaces > 400);
      CHECK(misses > 50);
      CHECK(others == 0);
      CHECK(worst_m < 2e-5);
    }
  }
}

TEST_CASE("block-grid with the smallest blocks is right where the floor is seen", "[refraction]") {
  const RenderScene scene = built_in("box", 600);
  const RefractionOracle oracle(scene, true);
  const Shown shown = render(scene, "1", "high");
  const AovImage &kind = image_of(shown.frame, Aov::kHitKind), &position = image_of(shown.frame, Aov::kHitPosition);
  std::size_t on_floor = 0;
  double worst_m = 0;
  for (int y = 0; y < 77; ++y)
    for (int x = 0; x < 131; ++x) {
      const OraclePixel want = oracle.trace(shown.placed->camera, 131, 77, x + 0.5, y + 0.5);
      if (!want.water || std::fabs(want.hit_position.y + kDepth) > 1e-6) continue;
      // At the floor's very edge the corners' mean may be beyond it.
      if (std::fabs(want.hit_position.x) > 0.999 || std::fabs(want.hit_position.z) > 0.699) continue;
      const std::size_t at = static_cast<std::size_t>(y * 131 + x);
      ++on_floor;
      CHECK(kind.uints[at] == static_cast<std::uint32_t>(HitKind::kSurface));
      worst_m = std::max(worst_m, norm_of(vector_in(position, at) - want.hit_position));
    }
  CHECK(on_floor > 500);
  CHECK(worst_m < 1e-3);  // a pixel is 2 cm there
}

TEST_CASE("block-grid finds box's floor, and refuses a scene without one", "[refraction]") {
  const RenderScene box = built_in("box", 600);
  const Floor floor = find_floor(box, box.waters.front());
  CHECK(floor.height_m == Approx(-kDepth));
  CHECK(floor.at(0.0f, 0.0f) != kNoId);
  CHECK(floor.at(0.99f, -0.69f) != kNoId);
  CHECK(floor.at(1.01f, 0.0f) == kNoId);
  // Every place is in the triangle that is found there.
  for (float x = -0.95f; x < 1.0f; x += 0.1f) {
    const std::int32_t id = floor.at(x, 0.31f);
    REQUIRE(id != kNoId);
    const auto& t = box.geometry.triangles[static_cast<std::size_t>(id)];
    double lo = 9, hi = -9;
    for (const std::uint32_t v : t.vertex) {
      lo = std::min(lo, static_cast<double>(box.geometry.vertices[v].position_world.x));
      hi = std::max(hi, static_cast<double>(box.geometry.vertices[v].position_world.x));
      CHECK(static_cast<double>(box.geometry.vertices[v].position_world.y) == Approx(-kDepth));
    }
    CHECK(lo <= static_cast<double>(x) + 1e-6);
    CHECK(hi >= static_cast<double>(x) - 1e-6);
  }

  // The floor and the wall of the tank's room, level and larger, are no part of its water: its sand is uneven, and what
  // its front looks at is its own back.
  const RenderScene tank = built_in("tank", 2000);
  REQUIRE(tank.waters.size() == 2);
  CHECK_THROWS_AS(find_floor(tank, tank.waters[0]), NotApplicable);
  CHECK(find_floor(tank, tank.waters[1]).height_m == Approx(-tank.waters[1].depth_m));

  const RenderScene pool = built_in("pool", 2000);  // its floor slopes
  FrameSettings settings;
  settings.method = "block-grid";
  settings.width_px = 16, settings.height_px = 16;
  CHECK_THROWS_AS(Renderer(pool, settings), NotApplicable);
}
