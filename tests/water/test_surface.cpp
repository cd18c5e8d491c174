// Every kind of surface: its slope against differences of heights in double, its bounds against millions of samples,
// its RMS slope, and what does not change it.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <set>

#include "surface_cases.h"
#include "surface_oracle.h"
#include "water/surface.h"

namespace {

using namespace shoal;
using surface_cases::kBody;

struct Sampler {
  std::mt19937 random{5};
  PlaneExtent extent = kBody;
  float unit() { return static_cast<float>(random() >> 8) * 0x1p-24f; }
  Vec2f next() {
    const float u = unit(), v = unit();
    return {extent.min_x_m + (extent.max_x_m - extent.min_x_m) * u,
            extent.min_z_m + (extent.max_z_m - extent.min_z_m) * v};
  }
};

double length(const SurfacePoint<float>& p) {
  return std::hypot(static_cast<double>(p.slope_x), static_cast<double>(p.slope_z));
}

double rms_slope(const WaterSurface& surface, const PlaneExtent& extent, int samples) {
  Sampler at;
  at.extent = extent;
  double sum = 0;
  for (int first = 0; first < samples; first += 16) {
    alignas(64) float x[16], z[16], slope_x[16], slope_z[16];
    for (int k = 0; k < 16; ++k) {
      const Vec2f p = at.next();
      x[k] = p.x, z[k] = p.y;
    }
    const SurfacePoint<WideF> got = surface_at(surface, WideF::load(x), WideF::load(z));
    got.slope_x.store(slope_x), got.slope_z.store(slope_z);
    for (int k = 0; k < std::min(16, samples - first); ++k)
      sum += std::pow(static_cast<double>(slope_x[k]), 2) + std::pow(static_cast<double>(slope_z[k]), 2);
  }
  return std::sqrt(sum / samples);
}

}  // namespace

TEST_CASE("a surface's height and slope agree with heights in double", "[water]") {
  for (const auto& c : surface_cases::all()) {
    const WaterSurface surface = prepare_surface(c.settings, 3.7, kBody);
    Sampler at;
    double height_error = 0, slope_error = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vec2f p = at.next();
      const double x = static_cast<double>(p.x), z = static_cast<double>(p.y), h = 1e-6;
      const SurfacePoint<float> got = surface_at(surface, p.x, p.y);
      const double height = surface_oracle::height(surface, x, z);
      const double forward_x = (surface_oracle::height(surface, x + h, z) - height) / h;
      const double back_x = (height - surface_oracle::height(surface, x - h, z)) / h;
      const double forward_z = (surface_oracle::height(surface, x, z + h) - height) / h;
      const double back_z = (height - surface_oracle::height(surface, x, z - h)) / h;
      height_error = std::max(height_error, std::fabs(static_cast<double>(got.height_m) - height));
      // A linear ripple ends with a kink: the slope is between those of both sides.
      const auto off = [](double slope, double a, double b) {
        return std::max({0.0, slope - std::max(a, b), std::min(a, b) - slope});
      };
      slope_error = std::max({slope_error, off(static_cast<double>(got.slope_x), forward_x, back_x),
                              off(static_cast<double>(got.slope_z), forward_z, back_z)});
    }
    CAPTURE(c.name, height_error, slope_error, surface.height_bound_m, surface.slope_bound);
    CHECK(height_error < 2e-5 * static_cast<double>(surface.height_bound_m));
    CHECK(slope_error < 1e-4 * static_cast<double>(surface.slope_bound));
  }
}

TEST_CASE("a surface's bounds hold, and are at most twice what four million samples reach", "[water]") {
  for (const auto& c : surface_cases::all()) {
    const WaterSurface surface = prepare_surface(c.settings, 1.3, kBody);
    Sampler at;
    WideF highest(0.0f), steepest(0.0f);
    for (int i = 0; i < 4'200'000; i += 16) {
      alignas(64) float x[16], z[16];
      for (int k = 0; k < 16; ++k) {
        const Vec2f p = at.next();
        x[k] = p.x, z[k] = p.y;
      }
      const SurfacePoint<WideF> got = surface_at(surface, WideF::load(x), WideF::load(z));
      highest = max(highest, abs(got.height_m));
      steepest = max(steepest, got.slope_x * got.slope_x + got.slope_z * got.slope_z);
    }
    const float height = reduce_max(highest);
    const double slope = std::sqrt(static_cast<double>(reduce_max(steepest)));
    CAPTURE(c.name, height, surface.height_bound_m, slope, surface.slope_bound);
    CHECK(height <= surface.height_bound_m);
    CHECK(surface.height_bound_m <= 2 * height);
    CHECK(slope <= static_cast<double>(surface.slope_bound));
    CHECK(static_cast<double>(surface.slope_bound) <= 2 * slope);
  }
}

TEST_CASE("slope= is the RMS slope over the body", "[water]") {
  for (auto c : surface_cases::all()) {
    for (const float slope : {0.02f, 0.1f}) {
      c.settings.slope = slope;
      double mean = 0;
      // Ripples live and die; their mean over a life is what is set.
      const bool fades = c.settings.kind == SurfaceKind::kRipples || c.settings.kind == SurfaceKind::kRippleFilter;
      const double life = c.settings.falloff == RippleFalloff::kExponential ? 24.0 : 4.0;
      const int times = fades ? 59 : 1;
      const SurfaceModel model = make_surface_model(c.settings, kBody);
      for (int i = 0; i < times; ++i) {
        const double time = fades ? life * (i + 0.25) / times : 0.0;
        mean += std::pow(rms_slope(prepare_surface(model, time), kBody, fades ? 10000 : 100000), 2) / times;
      }
      const double rms = std::sqrt(mean);
      CAPTURE(c.name, slope, rms);
      CHECK(rms == Approx(static_cast<double>(slope)).epsilon(0.05));
    }
  }
}

TEST_CASE("an amplitude scales a surface without changing its shape", "[water]") {
  for (const SurfaceKind kind : {SurfaceKind::kPerlin, SurfaceKind::kGradientWaves, SurfaceKind::kRipples}) {
    SurfaceSettings s = surface_cases::of_kind(kind);
    s.amplitude_m = 0.01f;
    const WaterSurface low = prepare_surface(s, 0.5, kBody);
    s.amplitude_m = 0.04f;
    const WaterSurface high = prepare_surface(s, 0.5, kBody);
    Sampler at;
    for (int i = 0; i < 200; ++i) {
      const Vec2f p = at.next();
      const SurfacePoint<float> a = surface_at(low, p.x, p.y), b = surface_at(high, p.x, p.y);
      REQUIRE(b.height_m == Approx(4 * a.height_m).epsilon(1e-5).margin(1e-9));
      REQUIRE(b.slope_x == Approx(4 * a.slope_x).epsilon(1e-5).margin(1e-7));
    }
  }
}

TEST_CASE("a surface moves smoothly, depends on its seed and on nothing else", "[water]") {
  for (const auto& c : surface_cases::all()) {
    CAPTURE(c.name);
    const SurfaceModel model = make_surface_model(c.settings, kBody);
    Sampler at;
    double moved = 0, step = 0;
    bool same = true, seed_matters = false;
    SurfaceSettings other = c.settings;
    other.seed = 8;
    for (auto& part : other.parts) part.seed = 9;
    const WaterSurface reseeded = prepare_surface(other, 2.0, kBody);
    // 2 s apart, and 0.1 ms apart across many moments (births of ripples among them).
    const WaterSurface first = prepare_surface(model, 2.0), later = prepare_surface(model, 4.0);
    const WaterSurface again = prepare_surface(c.settings, 2.0, kBody);
    for (int i = 0; i < 500; ++i) {
      const Vec2f p = at.next();
      const float h = surface_at(first, p.x, p.y).height_m;
      same = same && h == surface_at(again, p.x, p.y).height_m;
      seed_matters = seed_matters || h != surface_at(reseeded, p.x, p.y).height_m;
      moved = std::max(moved, std::fabs(static_cast<double>(h - surface_at(later, p.x, p.y).height_m)));
    }
    for (int i = 0; i < 400; ++i) {
      const double time = 0.01 * i;
      const WaterSurface before = prepare_surface(model, time - 1e-4), after = prepare_surface(model, time + 1e-4);
      const double bound = std::max(1e-9, static_cast<double>(std::max(before.height_bound_m, after.height_bound_m)));
      for (int k = 0; k < 8; ++k) {
        const Vec2f p = at.next();
        step = std::max(step, std::fabs(static_cast<double>(surface_at(before, p.x, p.y).height_m -
                                                            surface_at(after, p.x, p.y).height_m)) /
                                  bound);
      }
    }
    CAPTURE(moved, step);
    CHECK(same);
    if (c.settings.kind != SurfaceKind::kGerstner || *c.settings.octaves > 1) CHECK(seed_matters);
    CHECK(moved > 0.05 * static_cast<double>(first.height_bound_m));
    CHECK(step < 0.02);
  }
}

TEST_CASE("far times and places keep their digits and make no NaN", "[water]") {
  for (const auto& c : surface_cases::all()) {
    CAPTURE(c.name);
    const SurfaceModel model = make_surface_model(c.settings, kBody);
    for (const double time : {-1e6, -3.0, 0.0, 86400.0, 1e6, 1e300}) {
      const WaterSurface surface = prepare_surface(model, time);
      for (const float x : {0.0f, -1e9f, 1e30f, HUGE_VALF, -HUGE_VALF, std::nanf("")}) {
        const SurfacePoint<float> p = surface_at(surface, x, 1.0f);
        REQUIRE(std::fabs(p.height_m) <= std::max(surface.height_bound_m, 10.0f));
        REQUIRE(std::isfinite(p.slope_x));
        REQUIRE(std::isfinite(p.slope_z));
      }
    }
  }
}

TEST_CASE("still settings stand still and flat water is flat", "[water]") {
  SurfaceSettings s = surface_cases::of_kind(SurfaceKind::kPerlin);
  s.speed = 0;
  const SurfaceModel model = make_surface_model(s, kBody);
  CHECK(surface_at(prepare_surface(model, 1.0), 0.3f, 0.7f).height_m ==
        surface_at(prepare_surface(model, 99.0), 0.3f, 0.7f).height_m);
  const WaterSurface flat = prepare_surface(SurfaceSettings(), 1.0, kBody);
  CHECK(flat.height_bound_m == 0);
  CHECK(flat.slope_bound == 0);
  CHECK(surface_at(flat, 0.3f, 0.7f).slope_x == 0);
}

TEST_CASE("ripples start where drops fall and end at their reach", "[water]") {
  SurfaceSettings s = surface_cases::of_kind(SurfaceKind::kRipples);
  s.drops = {{1.0f, 2.0f, 5.0f}};
  s.amplitude_m = 0.1f;
  s.reach_m = 3.0f;
  CHECK(prepare_surface(s, 4.99, kBody).ripples.size() == 0);
  CHECK(prepare_surface(s, 9.01, kBody).ripples.size() == 0);
  const WaterSurface surface = prepare_surface(s, 6.0, kBody);
  REQUIRE(surface.ripples.size() == 1);
  CHECK(surface_at(surface, 4.01f, 2.0f).height_m == 0);
  CHECK(surface_at(surface, 1.0f, -1.01f).slope_z == 0);
  // A quarter of the life of 4 s is gone. Greatest near the drop, and the same all round.
  CHECK(surface.ripples[0].amplitude_m == Approx(0.075));
  CHECK(surface_at(surface, 1.4f, 2.3f).height_m == Approx(surface_at(surface, 0.7f, 1.6f).height_m).epsilon(1e-4));
}

TEST_CASE("a water buffer has the exact heights and normals at its points and blends normals between", "[water]") {
  SurfaceSettings s = surface_cases::of_kind(SurfaceKind::kRipples);
  const WaterSurface exact = prepare_surface(s, 1.0, kBody);
  s.grid = 64;
  s.slope.reset();
  s.amplitude_m = make_surface_model(surface_cases::of_kind(SurfaceKind::kRipples), kBody).parts[0].amplitude_m;
  const WaterSurface grid = prepare_surface(s, 1.0, kBody);
  const float step_x = (kBody.max_x_m - kBody.min_x_m) / 63, step_z = (kBody.max_z_m - kBody.min_z_m) / 63;
  for (int i = 0; i < 63; i += 7) {
    const float x = kBody.min_x_m + step_x * static_cast<float>(i), z = kBody.min_z_m + step_z * static_cast<float>(i);
    const SurfacePoint<float> a = surface_at(exact, x, z), b = surface_at(grid, x, z);
    REQUIRE(b.height_m == Approx(a.height_m).margin(1e-4 * static_cast<double>(exact.height_bound_m)));
    REQUIRE(b.slope_x == Approx(a.slope_x).margin(1e-3 * static_cast<double>(exact.slope_bound)));
    // Half way the normal is the mean of the four about it.
    const SurfacePoint<float> mid = surface_at(grid, x + 0.5f * step_x, z + 0.5f * step_z);
    double nx = 0, ny = 0;
    for (int k = 0; k < 4; ++k) {
      const SurfacePoint<float> p =
          surface_at(grid, x + static_cast<float>(k & 1) * step_x, z + static_cast<float>(k >> 1) * step_z);
      const double scale = 1 / std::sqrt(1 + std::pow(length(p), 2));
      nx -= static_cast<double>(p.slope_x) * scale;
      ny += scale;
    }
    REQUIRE(static_cast<double>(mid.slope_x) == Approx(-nx / ny).margin(2e-3 * static_cast<double>(exact.slope_bound)));
  }
}

TEST_CASE("a surface's normal is square to its tangents", "[water]") {
  const Vec3f ax = {0.6f, 0.0f, 0.8f}, n = {0, 1, 0}, az = {-0.8f, 0.0f, 0.6f};
  const Vec3f got = surface_normal(ax, n, az, 0.3f, -0.7f);
  CHECK(dot(got, got) == Approx(1).epsilon(1e-6));
  CHECK(dot(got, ax + n * 0.3f) == Approx(0).margin(1e-6));
  CHECK(dot(got, az + n * -0.7f) == Approx(0).margin(1e-6));
  CHECK(got.y > 0);
}
