// Waves filtered over a pixel's footprint, against means over the footprint of thousands of points, summed in double.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <string>

#include "surface_cases.h"
#include "water/filter_surface.h"

namespace {

using namespace shoal;
using surface_cases::kBody;

constexpr double kTurn = 6.283185307179586;

struct Random {
  std::mt19937 bits{31};
  double unit() { return static_cast<double>(bits()) * 0x1p-32; }
  double within(double lo, double hi) { return lo + (hi - lo) * unit(); }
};

// Sides of so many metres, at right angles, turned.
Footprint<float> footprint(double a_m, double b_m, double turn) {
  const double c = std::cos(turn), s = std::sin(turn);
  return {static_cast<float>(a_m * c), static_cast<float>(a_m * s), static_cast<float>(-b_m * s),
          static_cast<float>(b_m * c)};
}

struct Slope {
  double x = 0, z = 0;
  double square() const { return x * x + z * z; }
};

Slope slope_of(const SurfacePoint<float>& p) {
  return {static_cast<double>(p.slope_x), static_cast<double>(p.slope_z)};
}

// The unfiltered slopes at many points, sixteen at a time.
class SlopeSum {
 public:
  explicit SlopeSum(const WaterSurface& of) : surface_(of) {}
  void add(float x, float z) {
    x_[count_] = x, z_[count_] = z;
    if (++count_ == 16) flush();
  }
  // The sums of the slopes and of their squares over all points.
  Slope sum() {
    flush();
    return sum_;
  }
  double sum_of_squares() {
    flush();
    return squares_;
  }

 private:
  void flush() {
    const SurfacePoint<WideF> p = surface_at(surface_, WideF::load(x_), WideF::load(z_));
    alignas(64) float sx[16], sz[16];
    p.slope_x.store(sx), p.slope_z.store(sz);
    for (int i = 0; i < count_; ++i) {
      const Slope s{static_cast<double>(sx[i]), static_cast<double>(sz[i])};
      sum_.x += s.x, sum_.z += s.z, squares_ += s.square();
    }
    count_ = 0;
  }

  const WaterSurface& surface_;
  alignas(64) float x_[16] = {}, z_[16] = {};
  int count_ = 0;
  Slope sum_;
  double squares_ = 0;
};

// Mean of the unfiltered slopes over a parallelogram: across x along points.
Slope mean_slope(const WaterSurface& surface, double x, double z, const Footprint<float>& p, int along, int across) {
  SlopeSum sum(surface);
  for (int i = 0; i < along; ++i) {
    for (int j = 0; j < across; ++j) {
      const double u = (i + 0.5) / along - 0.5, v = (j + 0.5) / across - 0.5;
      sum.add(static_cast<float>(x + u * static_cast<double>(p.ax) + v * static_cast<double>(p.bx)),
              static_cast<float>(z + u * static_cast<double>(p.az) + v * static_cast<double>(p.bz)));
    }
  }
  const Slope all = sum.sum();
  return {all.x / (along * across), all.z / (along * across)};
}

double sinc(double cycles) { return cycles == 0 ? 1 : std::sin(0.5 * kTurn * cycles) / (0.5 * kTurn * cycles); }

// Surfaces whose waves are well told apart from the body's edge: within it, but for ripples, whose drops are there.
std::vector<surface_cases::Case> cases() {
  std::vector<surface_cases::Case> all = surface_cases::all();
  SurfaceSettings grid = surface_cases::of_kind(SurfaceKind::kRipples);
  grid.grid = 256;
  grid.wavelength_m = 1.0f;
  grid.sources = 24;
  all.push_back({"ripples on a grid", grid});
  return all;
}

}  // namespace

TEST_CASE("a side's weight is sinc's main lobe", "[water]") {
  double worst = 0, beyond = 0;
  for (int i = 0; i <= 4000; ++i) {
    const double cycles = i * 1e-3;
    const double got = static_cast<double>(side_weight(static_cast<float>(cycles * cycles)));
    if (cycles < 1)
      worst = std::max(worst, std::fabs(got - sinc(cycles)));
    else
      beyond = std::max(beyond, std::fabs(got - sinc(cycles)));
    if (cycles > 1.1027) REQUIRE(got == 0);
  }
  CHECK(worst < 0.033);
  CHECK(beyond < 0.218);
}

TEST_CASE("the mean of a wave over a parallelogram is the weight times the wave", "[water]") {
  Random random;
  for (int i = 0; i < 400; ++i) {
    const double kx = random.within(-3, 3), kz = random.within(-3, 3);
    const Footprint<float> p = footprint(random.within(0, 0.3), random.within(0, 0.3), random.within(0, 7));
    const double exact = sinc(kx * static_cast<double>(p.ax) + kz * static_cast<double>(p.az)) *
                         sinc(kx * static_cast<double>(p.bx) + kz * static_cast<double>(p.bz));
    const double got = static_cast<double>(wave_weight(static_cast<float>(kx), static_cast<float>(kz), p));
    REQUIRE(std::fabs(got - exact) < 0.05 + (std::fabs(exact) < 0.22 ? 0.17 : 0));
  }
}

TEST_CASE("noise's constants are those of millions of points", "[water]") {
  for (const bool cubic : {false, true}) {
    std::mt19937 bits(3);
    const auto coordinate = [&] { return static_cast<float>(bits() >> 8) * 0x1p-14f; };
    double sum = 0;
    const int count = 4'000'000;
    for (int i = 0; i < count; ++i) {
      const float x = coordinate(), z = coordinate();
      const Noise<float> n = gradient_noise(x, z, 0, 0, 9, cubic);
      sum += std::pow(static_cast<double>(n.dx), 2) + std::pow(static_cast<double>(n.dz), 2);
    }
    CHECK(sum / count == Approx(static_cast<double>(cubic ? kNoiseSlope2Cubic : kNoiseSlope2Quintic)).epsilon(0.005));
  }
}

// The factor that brings noise nearest to its mean over a footprint is E[s mean] / E[s^2].
TEST_CASE("noise's weight is the best factor", "[water]") {
  for (const bool cubic : {false, true}) {
    for (const bool line : {false, true}) {
      for (const double side : {0.3, 0.6, 0.9, 1.2, 1.6, 2.4}) {
        Random random;
        double product = 0, square = 0;
        for (int i = 0; i < 6000; ++i) {
          const double x = random.within(0, 900), z = random.within(0, 900), turn = random.within(0, kTurn);
          const int along = line ? 64 : 10, across = line ? 1 : 10;
          Slope mean;
          const auto at = [&](double u, double v) {
            const Noise<float> n =
                gradient_noise(static_cast<float>(x + u * std::cos(turn) - v * std::sin(turn)),
                               static_cast<float>(z + u * std::sin(turn) + v * std::cos(turn)), 0, 0, 5, cubic);
            return Slope{static_cast<double>(n.dx), static_cast<double>(n.dz)};
          };
          for (int a = 0; a < along; ++a) {
            for (int b = 0; b < across; ++b) {
              const Slope s = at(side * ((a + 0.5) / along - 0.5), line ? 0 : side * ((b + 0.5) / across - 0.5));
              mean.x += s.x / (along * across), mean.z += s.z / (along * across);
            }
          }
          const Slope own = at(0, 0);
          product += own.x * mean.x + own.z * mean.z;
          square += own.square();
        }
        const double best = product / square;
        const Footprint<float> p = footprint(side, line ? 0 : side, 0.3);
        const double got = static_cast<double>(isotropic_weight(isotropic_square(p) * kNoiseCycles2));
        CAPTURE(cubic, line, side, best, got);
        CHECK(std::fabs(got - best) < (line ? 0.2 : 0.1));
      }
    }
  }
}

TEST_CASE("without a footprint the filtered surface is the surface, bit by bit", "[water]") {
  for (const auto& c : cases()) {
    CAPTURE(c.name);
    const WaterSurface surface = prepare_surface(c.settings, 2.25, kBody);
    Random random;
    for (int i = 0; i < 2000; ++i) {
      const float x = static_cast<float>(random.within(-14, 14)), z = static_cast<float>(random.within(-14, 14));
      const SurfacePoint<float> plain = surface_at(surface, x, z);
      const FilteredPoint<float> got = filtered_surface_at(surface, x, z, Footprint<float>{0, 0, 0, 0});
      REQUIRE(as_int(got.mean.height_m) == as_int(plain.height_m));
      REQUIRE(as_int(got.mean.slope_x) == as_int(plain.slope_x));
      REQUIRE(as_int(got.mean.slope_z) == as_int(plain.slope_z));
      REQUIRE(got.slope_variance == 0);
    }
  }
}

// Root mean squares over the body, as shares of the surface's RMS slope.
TEST_CASE("filtered slopes are near their mean over the footprint", "[water]") {
  for (const auto& c : cases()) {
    const WaterSurface surface = prepare_surface(c.settings, 2.25, kBody);
    for (const double side_m : {0.1, 0.3, 1.0, 3.0}) {
      for (const double longer : {1.0, 4.0}) {
        Random random;
        double off = 0, sampled = 0, whole = 0;
        const int count = 400, along = longer > 1 ? 128 : 48, across = 48;
        for (int i = 0; i < count; ++i) {
          const double x = random.within(-9, 9), z = random.within(-5, 7);
          const Footprint<float> p = footprint(side_m * longer, side_m, random.within(0, kTurn));
          const Slope mean = mean_slope(surface, x, z, p, along, across);
          const float fx = static_cast<float>(x), fz = static_cast<float>(z);
          const Slope got = slope_of(filtered_surface_at(surface, fx, fz, p).mean),
                      own = slope_of(surface_at(surface, fx, fz));
          off += Slope{got.x - mean.x, got.z - mean.z}.square();
          sampled += Slope{own.x - mean.x, own.z - mean.z}.square();
          whole += own.square();
        }
        CAPTURE(c.name, side_m, longer, std::sqrt(off / whole), std::sqrt(sampled / whole));
        // The waves of ripple-filter fade together.
        const double bound = std::string(c.name) == "ripple-filter" ? 0.45 : longer > 1 ? 0.37 : 0.25;
        CHECK(std::sqrt(off / whole) < bound);
        CHECK(off <= 1.02 * sampled + 1e-4 * whole);
      }
    }
  }
}

TEST_CASE("what is kept and what is hidden add up to the surface's slope variance", "[water]") {
  for (const auto& c : cases()) {
    const WaterSurface surface = prepare_surface(c.settings, 2.25, kBody);
    Random random;
    const int count = 1'000'000;
    SlopeSum all(surface);
    for (int i = 0; i < count; ++i) {
      const float x = static_cast<float>(random.within(-12, 12));
      all.add(x, static_cast<float>(random.within(-7, 9)));
    }
    const double whole = all.sum_of_squares() / count;
    for (const double side_m : {0.05, 0.2, 0.5, 2.0, 40.0}) {
      double kept = 0, hidden = 0;
      for (int i = 0; i < count / 5; ++i) {
        const Footprint<float> p = footprint(side_m * 3, side_m, random.within(0, kTurn));
        const FilteredPoint<float> got = filtered_surface_at(surface, static_cast<float>(random.within(-12, 12)),
                                                             static_cast<float>(random.within(-7, 9)), p);
        kept += slope_of(got.mean).square();
        hidden += static_cast<double>(got.slope_variance);
      }
      kept /= count / 5, hidden /= count / 5;
      CAPTURE(c.name, side_m, whole, kept, hidden);
      CHECK(kept + hidden == Approx(whole).epsilon(0.1));
      if (side_m == 40.0) CHECK(kept < 1e-6 * whole);
    }
  }
}
