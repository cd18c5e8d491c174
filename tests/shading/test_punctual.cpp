// Point and spot lights against KHR_lights_punctual's formula in double.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "shading/light.h"

using namespace shoal;

namespace {

// As the extension's text has it, from its own quantities: intensity 1, range and cone angles in radians.
double formula(Vec3d light, Vec3d axis, Vec3d point, double range, double inner, double outer) {
  const Vec3d way = light - point;
  const double distance = std::sqrt(dot(way, way));
  double attenuation = 1 / (distance * distance);
  if (range > 0) attenuation *= std::max(std::min(1 - std::pow(distance / range, 4), 1.0), 0.0);
  if (outer > 0) {
    const double off_axis = -dot(axis, way) / distance;
    const double scale = 1 / std::max(0.001, std::cos(inner) - std::cos(outer)), offset = -std::cos(outer) * scale;
    const double angular = std::min(std::max(off_axis * scale + offset, 0.0), 1.0);
    attenuation *= angular * angular;
  }
  return attenuation;
}

PunctualLight lamp(Vec3f position, Vec3f axis, double range, double inner, double outer) {
  PunctualLight light;
  light.position_world = position;
  light.direction_world = axis;
  if (range > 0) light.inverse_range2 = static_cast<float>(1 / (range * range));
  if (outer > 0) {
    const double scale = 1 / std::max(0.001, std::cos(inner) - std::cos(outer));
    light.cone_scale = static_cast<float>(scale);
    light.cone_offset = static_cast<float>(-std::cos(outer) * scale);
  }
  return light;
}

Vec3d to_double(Vec3f v) { return {v.x, v.y, v.z}; }

}  // namespace

TEST_CASE("falloff of point and spot lights is the extension's formula") {
  std::mt19937 engine{2718};
  const auto between = [&](double a, double b) { return a + (b - a) * (static_cast<double>(engine()) / 4294967296.0); };
  const Vec3f position{1, 2, -3}, axis{0.6f, -0.8f, 0};
  struct Case {
    double range, inner, outer;
  };
  for (const Case c : {Case{0, 0, 0}, Case{4, 0, 0}, Case{0, 0.2, 0.7}, Case{5, 0, 1.5}, Case{3, 0.5, 0.6}}) {
    const PunctualLight light = lamp(position, axis, c.range, c.inner, c.outer);
    int lit = 0, dark = 0;
    double worst = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vec3f point{static_cast<float>(between(-5, 7)), static_cast<float>(between(-4, 4)),
                        static_cast<float>(between(-6, 0))};
      Vec3f to_light;
      const float got = punctual_falloff<float>(light, point, to_light);
      const double expected =
          formula(to_double(position), to_double(axis), to_double(point), c.range, c.inner, c.outer);
      const Vec3d way = to_double(position) - to_double(point);
      const double brightest = 1 / dot(way, way);
      // A narrow cone's slope magnifies the cosine's rounding.
      worst = std::max(worst, std::abs(double(got) - expected) / (brightest * (1 + double(light.cone_scale) * 0.1)));
      CHECK(got >= 0);
      (expected > 0 ? lit : dark) += 1;
    }
    CAPTURE(c.range, c.inner, c.outer);
    CHECK(worst < 2e-6);
    CHECK(lit > 30);
    if (c.range > 0 || c.outer > 0) CHECK(dark > 500);
  }
}

TEST_CASE("a surface under a lamp: one candela at two metres is a quarter of a lux") {
  SurfaceSample<float> s{};
  s.position_world = {3, 0, 0};
  s.normal_world = {0, 1, 0};
  s.base_color = {0.5f, 0.5f, 0.5f};
  s.roughness = 1;
  const Vec3f eye{0, 1, 0}, one{1, 1, 1};
  Lighting sun, lamp_above, lamp_below;
  sun.directional.push_back({{0, -1, 0}, {2, 4, 8}});
  PunctualLight light;
  light.position_world = {3, 2, 0};
  light.intensity = {8, 16, 32};
  lamp_above.punctual.push_back(light);
  light.position_world = {3, -2, 0};
  lamp_below.punctual.push_back(light);
  const Vec3f by_sun = shade<float>(s, false, eye, sun, one), by_lamp = shade<float>(s, false, eye, lamp_above, one);
  CHECK(double(by_lamp.x) == Approx(double(by_sun.x)).epsilon(1e-6));
  CHECK(double(by_lamp.z) == Approx(4 * double(by_sun.x)).epsilon(1e-6));
  CHECK(shade<float>(s, false, eye, lamp_below, one).x == 0.0f);
}

TEST_CASE("no place of a lamp gives NaN or a negative light") {
  SurfaceSample<WideF> s{};
  const WideF zero(0.0f), one(1.0f);
  float x[16], out[16];
  for (int i = 0; i < 16; ++i) x[i] = i == 0 ? 0.0f : std::ldexp(1.0f, 3 * i - 24);
  s.position_world = {WideF::load(x), zero, zero};
  s.normal_world = {zero, one, zero};
  s.base_color = {one, one, one};
  s.emissive = {zero, zero, zero};
  s.metallic = zero;
  s.roughness = WideF(0.5f);
  for (const float inverse_range2 : {0.0f, 1.0f, 1e12f}) {
    Lighting lighting;
    PunctualLight light;
    light.inverse_range2 = inverse_range2;
    light.intensity = {1000, 1000, 1000};
    for (const float height : {0.0f, 1e-20f, 1.0f, 1e6f}) {
      light.position_world = {0, height, 0};
      lighting.punctual.push_back(light);
    }
    shade<WideF>(s, mask_from_bits(0), {zero, one, zero}, lighting, {one, one, one}).x.store(out);
    for (const float v : out) CHECK((v >= 0 && v <= std::numeric_limits<float>::max()));
  }
}
