// The first crossing of a ray with a surface, against dense samples of the heights in double.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "surface_cases.h"
#include "surface_oracle.h"
#include "water/intersect_surface.h"

namespace {

using namespace shoal;
using surface_cases::kBody;

Vec3d to_double(Vec3f v) { return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)}; }

}  // namespace

TEST_CASE("a ray meets the surface where dense samples first do", "[water]") {
  int hits = 0, misses = 0;
  for (const auto& c : surface_cases::all()) {
    if (c.name != "perlin 4" && c.name != "gradient-waves" && c.name != "ripples" && c.name != "gerstner 1") continue;
    SurfaceSettings settings = c.settings;
    settings.slope = 0.15f;
    const WaterSurface surface = prepare_surface(settings, 1.0, kBody);
    const double bound = static_cast<double>(surface.height_bound_m);
    std::mt19937 random(31);
    const auto s = [&] { return static_cast<float>(static_cast<std::int32_t>(random()) >> 8) * 0x1p-23f; };
    for (int i = 0; i < 60; ++i) {
      const Vec3f middle = {3 * s(), 1.2f * s() * surface.height_bound_m, 3 * s()};
      const Vec3f d = normalize(Vec3f{s(), 0.4f * s(), s()});
      const float back = 2 * std::fabs(s());
      const Vec3f o = middle - d * back;
      const float t_max = 2 * back;
      const float got = intersect_surface(surface, o, d, 0.0f, t_max, true);
      const Vec3d od = to_double(o), dd = to_double(d);
      const auto gap = [&](double t) {
        const Vec3d p = od + dd * t;
        return p.y - surface_oracle::height(surface, p.x, p.z);
      };
      const bool above = gap(0) > 0;
      if (std::fabs(gap(0)) < 0.01 * bound) continue;
      // Nothing before it dips deeper than is stated.
      const double until = got < HUGE_VALF ? static_cast<double>(got) : static_cast<double>(t_max);
      double deepest = 0;
      for (double t = 0; t < until; t += 1e-3) deepest = std::max(deepest, above ? -gap(t) : gap(t));
      CAPTURE(c.name, i, got, t_max, deepest, bound, o.x, o.y, o.z, d.x, d.y, d.z);
      REQUIRE(deepest < 1.1 * static_cast<double>(kLeastDip) * bound);
      if (got < HUGE_VALF) {
        ++hits;
        REQUIRE(got <= t_max);
        REQUIRE(std::fabs(gap(until)) < 2e-5 * bound + 1e-6);
      } else {
        ++misses;
      }
    }
  }
  CHECK(hits > 60);
  CHECK(misses > 20);
}

TEST_CASE("rays that cannot meet the surface do not, and flat water is a plane", "[water]") {
  const WaterSurface surface = prepare_surface(surface_cases::of_kind(SurfaceKind::kPerlin), 1.0, kBody);
  const float top = surface.height_bound_m;
  CHECK(intersect_surface<float>(surface, {0, 2 * top, 0}, {1, 0, 0}, 0.0f, 100.0f, true) == HUGE_VALF);
  CHECK(intersect_surface<float>(surface, {0, 2 * top, 0}, {0, 1, 0}, 0.0f, 100.0f, true) == HUGE_VALF);
  CHECK(intersect_surface<float>(surface, {0, 2 * top, 0}, {0, -1, 0}, 0.0f, 0.5f * top, true) == HUGE_VALF);
  CHECK(intersect_surface<float>(surface, {0, 2 * top, 0}, {0, -1, 0}, 0.0f, 100.0f, false) == HUGE_VALF);
  CHECK(intersect_surface<float>(surface, {0, 2 * top, 0}, {0, -1, 0}, 0.0f, 100.0f, true) ==
        Approx(2 * top - surface_at(surface, 0.0f, 0.0f).height_m));
  const WaterSurface flat = prepare_surface(SurfaceSettings(), 0.0, kBody);
  CHECK(intersect_surface<float>(flat, {1, 2, 3}, {0, -0.5f, 0.5f}, 0.0f, 100.0f, true) == Approx(4));
  CHECK(intersect_surface<float>(flat, {1, 2, 3}, {0, 0.5f, 0.5f}, 0.0f, 100.0f, true) == HUGE_VALF);
}
