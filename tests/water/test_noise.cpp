// Gradient noise against its definition in double, and its hash against chance.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "surface_oracle.h"
#include "water/surface.h"

namespace {

using namespace shoal;

float unit(std::mt19937& random) { return static_cast<float>(random() >> 8) * 0x1p-24f; }

}  // namespace

TEST_CASE("gradient noise is its definition, with its own derivative", "[water]") {
  std::mt19937 random(3);
  for (const bool cubic : {false, true}) {
    double value = 0, slope = 0;
    for (int i = 0; i < 20000; ++i) {
      const float x = unit(random), z = unit(random);
      const std::int32_t cx = static_cast<std::int32_t>(random()), cz = static_cast<std::int32_t>(random());
      const Noise<float> got = gradient_noise(x, z, cx, cz, 99, cubic);
      surface_oracle::LatticeCache cache;
      const double dx = static_cast<double>(x), dz = static_cast<double>(z), h = 1e-6;
      const auto at = [&](double a, double b) {
        // Within the cell: the corners stay those of (x, z).
        double sum = 0;
        surface_oracle::noise(0.5, 0.5, cx, cz, 99, cubic, cache);
        for (int c = 0; c < 4; ++c) {
          const double ox = a - (c & 1), oz = b - (c >> 1);
          sum += surface_oracle::fade(1 - std::fabs(ox), cubic) * surface_oracle::fade(1 - std::fabs(oz), cubic) *
                 (cache.gx[c] * ox + cache.gz[c] * oz);
        }
        return sum;
      };
      value = std::max(value, std::fabs(static_cast<double>(got.value) - at(dx, dz)));
      slope = std::max({slope, std::fabs(static_cast<double>(got.dx) - (at(dx + h, dz) - at(dx - h, dz)) / (2 * h)),
                        std::fabs(static_cast<double>(got.dz) - (at(dx, dz + h) - at(dx, dz - h)) / (2 * h))});
    }
    CAPTURE(cubic, value, slope);
    CHECK(value < 2e-6);
    CHECK(slope < 8e-6);
  }
}

TEST_CASE("lattice gradients are sixteen unit vectors, each as frequent, and neighbours independent", "[water]") {
  constexpr int kSide = 512;
  const auto turn_at = [](int x, int z, std::int32_t seed) {
    const Noise<float> n = gradient_noise(0.0f, 0.0f, x, z, seed, false);
    const double angle = std::atan2(static_cast<double>(n.dz), static_cast<double>(n.dx)) / surface_oracle::kTurn * 16;
    REQUIRE(std::fabs(angle - std::round(angle)) < 1e-5);
    REQUIRE(n.dx * n.dx + n.dz * n.dz == Approx(1).epsilon(1e-6));
    return static_cast<int>(std::lround(angle) + 16) & 15;
  };
  for (const std::int32_t seed : {0, 1, -559038737}) {
    std::vector<int> turns(static_cast<std::size_t>(kSide * kSide));
    for (int z = 0; z < kSide; ++z)
      for (int x = 0; x < kSide; ++x) turns[static_cast<std::size_t>(z * kSide + x)] = turn_at(x - 100, z - 300, seed);
    // Pairs a step apart: 256 classes, chi-squared with 255 degrees of freedom is below 355 in 99.997 % of cases.
    for (const auto& [dx, dz] : {std::pair{1, 0}, std::pair{0, 1}, std::pair{1, 1}, std::pair{1, -1}, std::pair{2, 0},
                                 std::pair{0, 2}, std::pair{4, 4}, std::pair{8, 0}, std::pair{0, 16}}) {
      double count[256] = {}, total = 0;
      for (int z = 16; z < kSide - 16; ++z)
        for (int x = 0; x < kSide - 16; ++x) {
          const int a = turns[static_cast<std::size_t>(z * kSide + x)];
          const int b = turns[static_cast<std::size_t>((z + dz) * kSide + x + dx)];
          count[a * 16 + b] += 1;
          total += 1;
        }
      double chi2 = 0;
      for (const double n : count) chi2 += std::pow(n - total / 256, 2) / (total / 256);
      CAPTURE(seed, dx, dz, chi2);
      CHECK(chi2 < 355);
      CHECK(chi2 > 170);
    }
  }
}

TEST_CASE("noise reaches but never passes its bounds, and has the RMS that is stated", "[water]") {
  std::mt19937 random(4);
  for (const bool cubic : {false, true}) {
    double value = 0, slope = 0, value2 = 0, slope2 = 0;
    constexpr int kSamples = 2'000'000;
    for (int i = 0; i < kSamples; ++i) {
      const float x = unit(random), z = unit(random);
      const Noise<float> n = gradient_noise(x, z, static_cast<std::int32_t>(random()), i, 5, cubic);
      const double v = static_cast<double>(n.value),
                   s = std::hypot(static_cast<double>(n.dx), static_cast<double>(n.dz));
      value = std::max(value, std::fabs(v)), slope = std::max(slope, s);
      value2 += v * v, slope2 += s * s;
    }
    CAPTURE(cubic, value, slope);
    const double bound = static_cast<double>(cubic ? kNoiseSlopeBoundCubic : kNoiseSlopeBoundQuintic);
    CHECK(value <= static_cast<double>(kNoiseBound));
    CHECK(value > 0.9 * static_cast<double>(kNoiseBound));
    CHECK(slope <= bound);
    CHECK(slope > 0.9 * bound);
    CHECK(std::sqrt(value2 / kSamples) == Approx(cubic ? 0.212 : 0.216).epsilon(0.01));
    CHECK(std::sqrt(slope2 / kSamples) == Approx(cubic ? 0.809 : 0.883).epsilon(0.01));
  }
}
