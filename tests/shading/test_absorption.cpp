// Absorption against the exponential in double precision.
#include "shading/absorption.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace shoal;

TEST_CASE("transmittance is the exponential") {
  CHECK(transmittance(0.35f, 0.0f) == 1.0f);
  for (const float absorption : {0.0f, 0.03f, 0.07f, 0.35f, 4.0f}) {
    for (const float path : {1e-4f, 0.5f, 2.0f, 17.0f}) {
      const double exponent = static_cast<double>(absorption) * static_cast<double>(path);
      const double error = std::fabs(static_cast<double>(transmittance(absorption, path)) / std::exp(-exponent) - 1.0);
      CAPTURE(absorption, path, error);
      CHECK(error < 2e-7 * (1.0 + exponent));
    }
  }
  const Vec3f clear = transmittance(Vec3f{0.35f, 0.07f, 0.03f}, 10.0f);
  CHECK(clear.x == Approx(std::exp(-3.5)));
  CHECK(clear.y == Approx(std::exp(-0.7)));
  CHECK(clear.z == Approx(std::exp(-0.3)));
}

TEST_CASE("transmittance: lanes give the bits of scalars") {
  float paths[16], wide[16];
  for (int i = 0; i < 16; ++i) paths[i] = 0.37f * static_cast<float>(i);
  transmittance(WideF(0.35f), WideF::load(paths)).store(wide);
  for (int i = 0; i < 16; ++i) CHECK(as_int(wide[i]) == as_int(transmittance(0.35f, paths[i])));
}
