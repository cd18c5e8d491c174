// The blur-sharpen filter against its standing waves and its energy in double, a drop against the wave equation's
// integral, and that a state does not depend on how it is reached.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/digest.h"
#include "core/error.h"
#include "surface_cases.h"
#include "water/surface.h"

namespace {

using namespace shoal;

constexpr double kTurn = 6.283185307179586;

double value(const std::vector<float>& buffer, const FilterBuffers& b, int i, int j) {
  return static_cast<double>(buffer[b.index(i, j)]);
}

SurfaceSettings filter_settings() {
  SurfaceSettings s = surface_cases::of_kind(SurfaceKind::kRippleFilter);
  s.wavelength_m = 1.0f;
  return s;
}

std::string digest_of(const WaterSurface& surface) {
  Digest digest;
  digest.add(surface.grid_values.data(), surface.grid_values.size() * sizeof(float));
  digest.add(&surface.height_bound_m, sizeof(float));
  digest.add(&surface.slope_bound, sizeof(float));
  return digest.hex();
}

// A drop in open water by the Hankel integral of u_tt + 2 a u_t + m u = c^2 (u_xx + u_zz) + F(t) patch(r):
//   u(r, t) = integral over k of k J0(k r) patch(k) (integral over t' of F(t') e^(-a (t - t')) sin(w (t - t')) / w),
//   w^2 = c^2 k^2 + m - a^2.
// Patch (1 - r^2/R^2)^2 with R = 1/2, strokes sin(2 pi t) sin^2(pi t / 2) over two periods; wavelength, period and
// speed 1.
double drop_height(double r, double t, double a, double m) {
  constexpr int kSteps = 300, kTimes = 160, kRadii = 60;
  constexpr double kMost = 12 * kTurn;
  double sum = 0;
  for (int n = 0; n < kSteps; ++n) {
    const double k = kMost * (n + 0.5) / kSteps;
    const double omega = std::sqrt(k * k + m - a * a);
    double patch = 0, drive = 0;
    for (int i = 0; i < kRadii; ++i) {
      const double q = 0.5 * (i + 0.5) / kRadii;
      patch += std::pow(1 - 4 * q * q, 2) * std::cyl_bessel_j(0.0, k * q) * q * 0.5 / kRadii;
    }
    const double until = std::min(t, 2.0);
    for (int i = 0; i < kTimes; ++i) {
      const double at = until * (i + 0.5) / kTimes;
      drive += std::sin(kTurn * at) * std::pow(std::sin(0.25 * kTurn * at), 2) * std::exp(-a * (t - at)) *
               std::sin(omega * (t - at)) / omega * until / kTimes;
    }
    sum += k * std::cyl_bessel_j(0.0, k * r) * patch * drive * kMost / kSteps;
  }
  return sum;
}

}  // namespace

TEST_CASE("the filter's standing waves turn and die as its recurrence says", "[water]") {
  constexpr int kX = 33, kZ = 20, kSteps = 200;
  for (const double kept : {1.0, 0.99, 0.5}) {
    for (const auto& [m, n] : {std::pair{0, 0}, std::pair{3, 2}, std::pair{0, 7}, std::pair{32, 19}}) {
      if (kept == 1.0 && m == n) continue;  // no oscillation: a level that drifts
      const double p = 0.5 * kTurn * m / kX, q = 0.5 * kTurn * n / kZ, stays = std::sqrt(kept);
      const double turn = std::acos(stays * (std::cos(p) + std::cos(q)) / 2);
      FilterBuffers b(kX, kZ);
      const auto shape = [&](int i, int j) { return std::cos(p * (i + 0.5)) * std::cos(q * (j + 0.5)); };
      for (int j = 0; j < kZ; ++j)
        for (int i = 0; i < kX; ++i) {
          b.now[b.index(i, j)] = static_cast<float>(shape(i, j));
          b.before[b.index(i, j)] = static_cast<float>(shape(i, j) * std::cos(turn) / stays);
        }
      double worst = 0;
      for (int step = 1; step <= kSteps; ++step) {
        step_filter(b, static_cast<float>(kept));
        const double height = std::pow(stays, step) * std::cos(step * turn);
        for (int j = 0; j < kZ; ++j)
          for (int i = 0; i < kX; ++i) worst = std::max(worst, std::fabs(value(b.now, b, i, j) - height * shape(i, j)));
      }
      CAPTURE(kept, m, n, worst);
      CHECK(worst < 5e-6);
    }
  }
}

TEST_CASE("the filter's energy is what damping leaves of it, of whatever is in the basin", "[water]") {
  constexpr int kX = 24, kZ = 41;
  FilterBuffers b(kX, kZ);
  std::mt19937 random(3);
  for (auto* buffer : {&b.before, &b.now})
    for (int j = 0; j < kZ; ++j)
      for (int i = 0; i < kX; ++i)
        (*buffer)[b.index(i, j)] = static_cast<float>(static_cast<std::int32_t>(random())) * 0x1p-31f;
  const float kept = 0.98f;
  // u(n+1) + kept u(n-1) = kept B u(n) keeps |u(n+1)|^2 + kept |u(n)|^2 - kept u(n+1).B u(n), times kept a step.
  const auto energy = [&] {
    const auto at = [&](int i, int j) {
      return value(b.before, b, std::clamp(i, 0, kX - 1), std::clamp(j, 0, kZ - 1));
    };
    const double d = static_cast<double>(kept);
    double sum = 0;
    for (int j = 0; j < kZ; ++j)
      for (int i = 0; i < kX; ++i) {
        const double after = value(b.now, b, i, j);
        const double about = 0.5 * (at(i - 1, j) + at(i + 1, j) + at(i, j - 1) + at(i, j + 1));
        sum += after * after + d * at(i, j) * at(i, j) - d * after * about;
      }
    return sum;
  };
  const double first = energy();
  for (int step = 1; step <= 300; ++step) {
    step_filter(b, kept);
    if (step % 50 == 0) CHECK(energy() == Approx(first * std::pow(static_cast<double>(kept), step)).epsilon(1e-4));
  }
}

TEST_CASE("a drop spreads as the wave equation says", "[water]") {
  SurfaceSettings s = filter_settings();
  s.drops = {{0.3f, -0.2f, 5.0f}};
  s.amplitude_m = 0.02f;
  s.lifetime_s = 12.0f;
  s.grid = 240;  // 24 cells a wave
  const PlaneExtent basin = {-5.0f, -5.0f, 5.0f, 5.0f};
  const SurfaceModel model = make_surface_model(s, basin);
  const double period = std::sqrt(kTurn / 9.81);  // speed sqrt(g / k) at a wave of 1 m
  // In periods: a is 1 / lifetime, m 2 / (lifetime step).
  const double lifetime = 12.0 / period, step = 1.0 / (24 * std::sqrt(2.0));
  double greatest = 0;
  for (int i = 1; i <= 60; ++i) greatest = std::max(greatest, std::fabs(drop_height(0, 0.05 * i, 0, 0)));
  CHECK(prepare_surface(model, 5.0).height_bound_m == 0);
  for (const double t : {0.4, 0.9, 1.3, 2.2, 3.4}) {
    const WaterSurface surface = prepare_surface(model, 5.0 + t * period);
    double worst = 0;
    for (const double r : {0.0, 0.2, 0.5, 0.9, 1.4, 1.9, 2.6, 3.3}) {
      const double wanted = 0.02 * drop_height(r, t, 1 / lifetime, 2 / (lifetime * step)) / greatest;
      for (const double angle : {0.1, 0.785, 2.9, 4.4}) {
        const SurfacePoint<float> got = surface_at(surface, 0.3f + static_cast<float>(r * std::cos(angle)),
                                                   -0.2f + static_cast<float>(r * std::sin(angle)));
        worst = std::max(worst, std::fabs(static_cast<double>(got.height_m) - wanted) / 0.02);
      }
    }
    CAPTURE(t, worst);
    CHECK(worst < 0.01);
  }
}

TEST_CASE("a filter's state is the same however it is reached", "[water]") {
  const SurfaceSettings s = filter_settings();
  const PlaneExtent basin = {-3.0f, -2.0f, 3.0f, 2.5f};
  const SurfaceModel shared = make_surface_model(s, basin);
  std::vector<double> times = {-1e6, -40.0,    -24.5,    -23.9, -0.01, 0.0,  0.01,
                               0.3,  1.0 / 60, 2.0 / 60, 7.7,   23.9,  24.1, 500.0};
  std::vector<std::string> alone;
  for (const double time : times) alone.push_back(digest_of(prepare_surface(s, time, basin)));
  CHECK(std::adjacent_find(alone.begin(), alone.end()) == alone.end());
  std::mt19937 random(17);
  for (int round = 0; round < 4; ++round) {
    for (int n = 0; n < 30; ++n) {
      const std::size_t i = random() % times.size();
      REQUIRE(digest_of(prepare_surface(shared, times[i])) == alone[i]);
    }
  }
}

TEST_CASE("an era's last state goes on into the next one's first", "[water]") {
  SurfaceSettings s = filter_settings();
  s.amplitude_m = 0.05f;
  const PlaneExtent basin = {-3.0f, -2.0f, 3.0f, 2.5f};
  const FilterShape shape = RippleFilter(resolve_surface(s), basin).shape();
  const SurfaceModel model = make_surface_model(s, basin);
  const double seam = static_cast<double>(shape.run_steps - shape.run_steps / 2) * shape.step_s;
  const WaterSurface before = prepare_surface(model, seam - 1e-6), after = prepare_surface(model, seam + 1e-6);
  double moved = 0;
  for (std::size_t i = 0; i < before.grid_values.size(); ++i)
    moved = std::max(moved, std::fabs(static_cast<double>(before.grid_values[i] - after.grid_values[i])));
  CHECK(moved > 0);
  CHECK(moved < 5e-5 * static_cast<double>(before.height_bound_m));
}

TEST_CASE("walls mirror, drops may fall anywhere, and too long a run is refused", "[water]") {
  SurfaceSettings s = filter_settings();
  s.amplitude_m = 0.05f;
  const PlaneExtent basin = {-3.0f, -2.0f, 3.0f, 2.0f};
  const WaterSurface surface = prepare_surface(s, 3.3, basin);
  for (const float at : {-1.7f, 0.2f, 1.9f}) {
    CHECK(std::fabs(surface_at(surface, -3.0f, at).slope_x) < 1e-4f * surface.slope_bound);
    CHECK(std::fabs(surface_at(surface, 3.0f, at).slope_x) < 1e-4f * surface.slope_bound);
    CHECK(std::fabs(surface_at(surface, at, 2.0f).slope_z) < 1e-4f * surface.slope_bound);
  }
  s.drops = {{1e6f, -1e6f, 0.0f}, {4.0f, 0.0f, 0.0f}};
  CHECK(prepare_surface(s, 1.0, basin).height_bound_m == 0);
  s.drops = {{3.0f, 2.0f, 0.0f}};
  CHECK(prepare_surface(s, 1.0, basin).height_bound_m > 0);
  s.lifetime_s = 1e6f;
  CHECK_THROWS_AS(prepare_surface(s, 1.0, basin), UsageError);
  s = filter_settings();
  s.sources = 256;
  s.lifetime_s = 0.01f;
  s.wavelength_m = 1e5f;
  s.grid = 1024;
  CHECK_THROWS_AS(prepare_surface(s, 1.0, basin), UsageError);
}
