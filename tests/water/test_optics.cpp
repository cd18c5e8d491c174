// Snell and Fresnel against double precision, by angles instead of the code's algebra.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "water/optics.h"

namespace {

using namespace shoal;

constexpr double kPiExact = 3.14159265358979323846;

// Angles of incidence in degrees: a sweep, grazing, and both sides of the critical angle if there is one.
std::vector<double> angles(double eta) {
  std::vector<double> degrees = {0.0, 1e-4, 1e-2};
  for (int i = 1; i < 180; ++i) degrees.push_back(0.5 * i);
  for (const double off : {0.4, 0.1, 1e-2, 1e-3, 1e-4}) degrees.push_back(90.0 - off);
  if (eta > 1.0) {
    const double critical = std::asin(1.0 / eta) * 180.0 / kPiExact;
    for (const double off : {1.0, 0.1, 1e-2, 1e-3, 1e-4, 1e-5}) {
      degrees.push_back(critical - off);
      degrees.push_back(critical + off);
    }
  }
  return degrees;
}

// Fresnel by angles: sin(i - t) / sin(i + t) and tan(i - t) / tan(i + t).
double oracle_fresnel(double cos_i, double eta) {
  if (eta == 1.0) return 0.0;
  const double i = std::acos(cos_i), sine = eta * std::sin(i);
  if (sine >= 1.0) return 1.0;
  if (i < 1e-6) return std::pow((eta - 1.0) / (eta + 1.0), 2);
  const double t = std::asin(sine);
  const double s = std::sin(i - t) / std::sin(i + t), p = std::tan(i - t) / std::tan(i + t);
  return 0.5 * (s * s + p * p);
}

Vec3d to_double(Vec3f v) { return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)}; }

const float kEtas[] = {1.0f / 3.0f, 0.5f, 0.75f, 1.0f / 1.333f, 0.999f, 1.0f, 1.001f, 1.333f, 1.5f, 3.0f};

}  // namespace

TEST_CASE("refract bends by Snell's law in the plane of incidence", "[water]") {
  double worst = 0.0, worst_steep = 0.0;
  for (const float eta : kEtas) {
    for (const double degrees : angles(static_cast<double>(eta))) {
      for (int turn = 0; turn < 7; ++turn) {
        // A tilted frame: tangent, normal.
        const double a = 0.9 * turn, b = 0.3 + 0.4 * turn;
        const Vec3d n = {std::sin(b) * std::cos(a), std::cos(b), std::sin(b) * std::sin(a)};
        const Vec3d u = {std::cos(b) * std::cos(a), -std::sin(b), std::cos(b) * std::sin(a)};
        const double angle = degrees * kPiExact / 180.0;
        const Vec3d d = u * std::sin(angle) - n * std::cos(angle);
        const Vec3f df = {static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)};
        const Vec3f nf = {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)};
        const Refraction<float> got = refract(df, nf, eta);
        const double sine = static_cast<double>(eta) * std::sin(angle);
        CAPTURE(eta, degrees, turn);
        if (std::fabs(sine - 1.0) > 1e-6) REQUIRE(got.valid == (sine < 1.0));
        const Vec3d r = to_double(got.direction);
        REQUIRE(std::fabs(dot(r, r) - 1.0) < 5e-7);
        if (!got.valid || sine >= 1.0) {
          REQUIRE(got.cos_transmitted < 2e-3f);
          REQUIRE(dot(r, u) > 1.0 - 4e-6);
          continue;
        }
        const double cos_t = std::sqrt((1.0 - sine) * (1.0 + sine));
        const Vec3d off = r - (u * sine - n * cos_t);
        const double error = std::sqrt(dot(off, off));
        if (cos_t > 0.5) worst = std::max(worst, error);
        worst_steep = std::max(worst_steep, error * std::max(cos_t, 1e-3));
      }
    }
  }
  CAPTURE(worst, worst_steep);
  CHECK(worst < 1.6e-6);
  CHECK(worst_steep < 1.6e-6);
}

TEST_CASE("reflect mirrors, and keeps the length", "[water]") {
  const Vec3f n = {0.6f, 0.8f, 0.0f}, d = {3.0f, -1.0f, 2.0f};
  const Vec3f r = reflect(d, n);
  CHECK(dot(r, n) == Approx(-dot(d, n)).epsilon(1e-6));
  CHECK(dot(r, r) == Approx(14.0f).epsilon(1e-6));
  CHECK(r.z == 2.0f);
}

TEST_CASE("Fresnel reflectance is exact", "[water]") {
  double worst_relative = 0.0, worst_dense = 0.0;
  for (const float eta : kEtas) {
    for (const double degrees : angles(static_cast<double>(eta))) {
      const float cosine = static_cast<float>(std::cos(degrees * kPiExact / 180.0));
      const double c = static_cast<double>(cosine), e = static_cast<double>(eta);
      const double want = oracle_fresnel(c, e), got = static_cast<double>(fresnel_dielectric(cosine, eta));
      CAPTURE(eta, degrees, want, got);
      REQUIRE(got >= 0.0);
      REQUIRE(got <= 1.0);
      if (eta == 1.0f) REQUIRE(got == 0.0);
      if (eta < 1.0f) worst_relative = std::max(worst_relative, std::fabs(got - want) / want);
      if (eta > 1.0f) {
        const double cos2_t = 1.0 - e * e * (1.0 - c * c);
        worst_dense = std::max(worst_dense, std::fabs(got - want) * std::sqrt(std::max(cos2_t, 1e-7)));
        if (cos2_t < -1e-6) REQUIRE(got == 1.0);
      }
    }
  }
  CAPTURE(worst_relative, worst_dense);
  CHECK(worst_relative < 6e-7);
  CHECK(worst_dense < 1.3e-6);
}

TEST_CASE("Fresnel at published and reciprocal angles", "[water]") {
  // Air to water at normal incidence 2.04 %; at Brewster's angle only s is reflected; the two sides agree (Stokes).
  CHECK(fresnel_dielectric(1.0f, 1.0f / 1.333f) == Approx(0.020372).epsilon(1e-4));
  const double n = static_cast<double>(1.333f), brewster = std::atan(n);
  const double s = std::sin(2.0 * brewster - 0.5 * kPiExact);
  CHECK(fresnel_dielectric(static_cast<float>(std::cos(brewster)), 1.0f / 1.333f) == Approx(0.5 * s * s).epsilon(1e-5));
  for (const float cosine : {0.05f, 0.3f, 0.7f, 1.0f}) {
    const float inside = std::sqrt(cos2_transmitted(cosine, 1.0f / 1.333f));
    CHECK(fresnel_dielectric(inside, 1.333f) == Approx(fresnel_dielectric(cosine, 1.0f / 1.333f)).epsilon(2e-5));
  }
  CHECK(fresnel_dielectric(0.0f, 1.0f / 1.333f) == Approx(1.0f).epsilon(1e-6));
  CHECK(fresnel_dielectric(0.0f, 1.333f) == 1.0f);
  CHECK(fresnel_dielectric(0.0f, 1.0f) == 0.0f);
}

TEST_CASE("Schlick's approximation takes the thin side's cosine", "[water]") {
  // Within its known error of the exact curve from both sides: at 85 degrees it is 0.06 high for water.
  for (const float eta : {1.333f, 1.0f / 1.333f}) {
    for (int i = 0; i <= 100; ++i) {
      const float c = 0.01f * static_cast<float>(i);
      CHECK(fresnel_schlick(c, eta) == Approx(fresnel_dielectric(c, eta)).margin(0.07));
    }
  }
  CHECK(fresnel_schlick(1.0f, 1.333f) == Approx(0.020372).epsilon(1e-4));
  CHECK(fresnel_schlick(0.3f, 1.333f) == 1.0f);
}

TEST_CASE("lanes give the bits of scalars", "[water]") {
  for (const float eta : kEtas) {
    float cosines[16], wide[16], schlick[16];
    for (int i = 0; i < 16; ++i) cosines[i] = static_cast<float>(i) / 15.0f;
    fresnel_dielectric(WideF::load(cosines), WideF(eta)).store(wide);
    fresnel_schlick(WideF::load(cosines), WideF(eta)).store(schlick);
    for (int i = 0; i < 16; ++i) {
      CHECK(as_int(wide[i]) == as_int(fresnel_dielectric(cosines[i], eta)));
      CHECK(as_int(schlick[i]) == as_int(fresnel_schlick(cosines[i], eta)));
    }
  }
}
