// The path solver against bisection of Snell's law in double.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "path_oracle.h"
#include "refraction/broad/path_solver.h"

namespace {

using namespace shoal;
using namespace shoal_test;

struct Worst {
  double relative = 0, px = 0;
};

Worst scan(float ior, bool eye_above, bool log_spaced) {
  const PathConstants constants = path_constants(ior);
  const bool eye_is_thin = eye_above != constants.water_is_thin;
  Worst worst;
  for_each_path(log_spaced, [&](float far_m, float d_m) {
    const double got = static_cast<double>(virtual_distance(constants, eye_is_thin, 2.0f, far_m, d_m));
    const double want =
        oracle_distance(static_cast<double>(ior), eye_above, 2.0, static_cast<double>(far_m), static_cast<double>(d_m));
    worst.relative = std::max(worst.relative, std::fabs(got - want) / want);
    worst.px = std::max(worst.px, pixels_between(got, want, static_cast<double>(d_m)));
  });
  return worst;
}

}  // namespace

TEST_CASE("virtual distance is right on the whole grid, from both sides", "[refraction]") {
  for (const float ior : {1.0f / 3.0f, 0.75f, 0.99f, 1.0f, 1.01f, 1.333f, 2.0f, 3.0f}) {
    for (const bool eye_above : {true, false}) {
      for (const bool log_spaced : {true, false}) {
        const Worst worst = scan(ior, eye_above, log_spaced);
        CAPTURE(ior, eye_above, log_spaced, worst.relative, worst.px);
        const bool eye_is_thin = eye_above == (ior >= 1.0f);
        CHECK(worst.relative < (eye_is_thin ? 1.2e-6 : 6e-6));
        CHECK(worst.px < 2.5e-4);
      }
    }
  }
}

TEST_CASE("paths obey Snell's law and close", "[refraction]") {
  const PathConstants water = path_constants(1.333f);
  for (const float thin : {0.0f, 1e-6f, 0.01f, 1.0f, 300.0f}) {
    for (const float dense : {0.0f, 1e-6f, 0.01f, 1.0f, 300.0f}) {
      for (const float d : {0.0f, 1e-6f, 0.3f, 1.0f, 2000.0f}) {
        const PathSolution<float> path = solve_path(water, thin, dense, d);
        CAPTURE(thin, dense, d, path.tan_thin, path.q);
        const double s = static_cast<double>(path.tan_thin), t = s / static_cast<double>(path.q);
        CHECK(s / std::sqrt(1 + s * s) == Approx(1.333 * t / std::sqrt(1 + t * t)).epsilon(1e-6).margin(1e-12));
        const double length = static_cast<double>(path.thin_m) * s + static_cast<double>(dense) * t;
        // An eye in the plane and a point on it are joined by no refracted path: there the guard's is taken.
        if (thin > 0 || dense > d) CHECK(length == Approx(static_cast<double>(d)).epsilon(3e-6).margin(1e-12));
      }
    }
  }
}

TEST_CASE("the limits of the path", "[refraction]") {
  const PathConstants water = path_constants(1.333f);
  const double n = static_cast<double>(1.333f), root_m = std::sqrt(n * n - 1.0);
  SECTION("straight down") {
    CHECK(virtual_distance(water, true, 2.0f, 3.0f, 0.0f) == Approx(3.0 / n).epsilon(1e-6));
    CHECK(virtual_distance(water, false, 2.0f, 3.0f, 0.0f) == Approx(3.0 * n).epsilon(1e-6));
  }
  SECTION("the plane itself, from the dense side, is lifted to the window's edge") {
    for (const float d : {0.5f, 2.0f, 2.5f, 10.0f, 1000.0f}) {
      const double want = std::max(0.0, root_m * static_cast<double>(d) - 2.0);
      CHECK(virtual_distance(water, false, 2.0f, 0.0f, d) == Approx(want).epsilon(3e-6).margin(1e-5));
    }
  }
  SECTION("an eye in the plane sees nothing under it beyond the critical angle") {
    CHECK(virtual_distance(water, true, 0.0f, 1.0f, 10.0f) < 1e-8f);
    const double d = 0.5;  // within: v by the dense side's own tangent
    const double t = d, s = n * d / std::sqrt(1.0 - root_m * root_m * d * d);
    CHECK(virtual_distance(water, true, 0.0f, 1.0f, 0.5f) == Approx(t / s).epsilon(3e-6));
  }
  SECTION("ior 1 is the identity, to the bit") {
    const PathConstants same = path_constants(1.0f);
    for (const float b : {0.0f, 1e-20f, 0.1f, 7.0f, 1e30f}) CHECK(virtual_distance(same, true, 2.0f, b, 5.0f) == b);
  }
  SECTION("an ior below 1 exchanges the sides: the thin one is under the plane") {
    const PathConstants inverse = path_constants(1.0f / 1.333f);
    for (const float d : {0.0f, 0.7f, 3.0f, 40.0f}) {
      CHECK(virtual_distance(inverse, true, 2.0f, 3.0f, d) ==
            Approx(virtual_distance(water, true, 2.0f, 3.0f, d)).epsilon(2e-6));
    }
  }
}

TEST_CASE("the solver is monotone where the broad phase needs it", "[refraction]") {
  const PathConstants water = path_constants(1.333f);
  for (const bool eye_is_thin : {true, false}) {
    for (const float d : {0.1f, 1.0f, 2.28f, 5.0f, 60.0f}) {
      float before = virtual_distance(water, eye_is_thin, 2.0f, 0.0f, d);
      for (int i = 1; i <= 400; ++i) {
        const float v = virtual_distance(water, eye_is_thin, 2.0f, 0.02f * static_cast<float>(i), d);
        CAPTURE(eye_is_thin, d, i, v, before);
        // Seen flat from under water, v leaves its limit at the plane more slowly than one rounding.
        REQUIRE(v >= before * (1.0f - 2e-6f));
        before = v;
      }
    }
  }
}

TEST_CASE("no finite input gives a NaN, and lanes give the bits of scalars", "[refraction]") {
  const std::vector<float> lengths = {0.0f,   1e-45f, 1e-38f, 1e-30f, 1e-20f,
                                      1e-10f, 1e-3f,  1.0f,   2.28f,  1e3f,
                                      1e10f,  1e20f,  1e30f,  3e38f,  std::numeric_limits<float>::max()};
  for (const float ior : {1.0f / 3.0f, 0.9999999f, 1.0f, 1.0000001f, 1.333f, 3.0f}) {
    const PathConstants constants = path_constants(ior);
    for (const bool eye_is_thin : {true, false}) {
      for (const float eye : lengths) {
        for (const float far_m : lengths) {
          float lanes[16] = {};
          std::copy(lengths.begin(), lengths.end(), lanes);
          float wide[16];
          virtual_distance(constants, eye_is_thin, WideF(eye), WideF(far_m), WideF::load(lanes)).store(wide);
          for (std::size_t i = 0; i < 16; ++i) {
            const float v = virtual_distance(constants, eye_is_thin, eye, far_m, lanes[i]);
            CAPTURE(ior, eye_is_thin, eye, far_m, lanes[i], v);
            REQUIRE(v >= 0.0f);
            REQUIRE(as_int(v) == as_int(wide[i]));
          }
        }
      }
    }
  }
}
