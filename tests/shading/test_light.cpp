// Light on surfaces against an independent double-precision BRDF, energy by integration, and what must be exact.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "furnace.h"
#include "shading/light.h"

using namespace shoal;
using furnace::surface;
using furnace::to_float3;
using furnace::unit;

namespace {

constexpr double kPiD = 3.14159265358979323846;

struct Random {
  std::mt19937 engine{4711};
  double unit() { return static_cast<double>(engine()) / 4294967296.0; }
  double between(double a, double b) { return a + (b - a) * unit(); }
};

Vec3d to_double(Vec3f v) { return {v.x, v.y, v.z}; }

Vec3d random_direction(Random& random) {
  for (;;) {
    const Vec3d v{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    const double l2 = dot(v, v);
    if (l2 > 0.01 && l2 < 1) return unit(v);
  }
}

// glTF 2.0, appendix B, as it is written there: dielectric and metal mixed, each term on its own, half vector by angle.
double brdf_times_cosine(double color, double metallic, double roughness, Vec3d n, Vec3d v, Vec3d l) {
  const Vec3d h = unit(l + v);
  const double nl = dot(n, l), nv = dot(n, v), vh = dot(v, h), a = roughness * roughness;
  if (nl <= 0) return 0;
  const double sine2 = dot(cross(n, h), cross(n, h)), cosine2 = 1 - sine2;
  // Trowbridge-Reitz as in Walter 2007: a^2 / (pi cos^4 (a^2 + tan^2)^2).
  const double tan2 = sine2 / cosine2;
  const double d = a * a / (kPiD * cosine2 * cosine2 * (a * a + tan2) * (a * a + tan2));
  // Height-correlated Smith by its Lambda functions (Heitz 2014).
  const auto lambda = [a](double c) { return 0.5 * (std::sqrt(1 + a * a * (1 / (c * c) - 1)) - 1); };
  const double g = 1 / (1 + lambda(nl) + lambda(nv));
  const double specular = d * g / (4 * nl * nv);
  const auto schlick = [vh](double f0) { return f0 + (1 - f0) * std::pow(1 - vh, 5.0); };
  const double f_dielectric = schlick(0.04);
  const double dielectric = (1 - f_dielectric) * color / kPiD + f_dielectric * specular;
  const double metal = schlick(color) * specular;
  return nl * (dielectric * (1 - metallic) + metal * metallic);
}

}  // namespace

TEST_CASE("light reflected is the BRDF of glTF's appendix B") {
  Random random;
  double worst = 0;
  int compared = 0;
  for (int i = 0; i < 200000; ++i) {
    const Vec3d n = random_direction(random), v = random_direction(random), l = random_direction(random);
    if (dot(n, v) < 0.01 || dot(n, l) < 0.001 || dot(l + v, l + v) < 1e-4) continue;
    const Vec3f nf = to_float3(n), vf = to_float3(v), lf = to_float3(l);
    const float roughness = static_cast<float>(random.between(kMinRoughness, 1)),
                color = static_cast<float>(random.unit());
    // Pure dielectrics and metals: between them glTF's two forms differ (next case).
    const float metallic = i % 2 ? 1.0f : 0.0f;
    const auto s = surface(nf, {color, 0, 1}, metallic, roughness);
    const float got = reflect_light<float>(make_reflectance<float>(s, vf), lf, dot(nf, lf)).x;
    const double exact =
        brdf_times_cosine(color, metallic, roughness, unit(to_double(nf)), unit(to_double(vf)), unit(to_double(lf)));
    worst = std::max(worst, std::abs(got - exact) / (1e-6 + 2e-5 * exact));
    ++compared;
  }
  CAPTURE(worst);
  CHECK(compared > 20000);
  CHECK(worst < 1.0);
}

TEST_CASE("a smooth surface's highlight is the BRDF's at its peak and beside it") {
  const Vec3d n{0, 1, 0}, v = unit({0.6, 0.8, 0});
  for (const double roughness : {0.045, 0.1, 0.3}) {
    for (const double off : {0.0, 1e-4, 1e-3, 5e-3, 0.02}) {
      const double angle = std::atan2(0.8, -0.6) + off;
      const Vec3d l{std::cos(angle), std::sin(angle), 0};
      const auto s = surface(to_float3(n), {0.9f, 0.9f, 0.9f}, 1, static_cast<float>(roughness));
      const Vec3f lf = to_float3(l), vf = to_float3(v);
      const float got = reflect_light<float>(make_reflectance<float>(s, vf), lf, dot(to_float3(n), lf)).x;
      const double exact =
          brdf_times_cosine(double(0.9f), 1, double(float(roughness)), n, unit(to_double(vf)), unit(to_double(lf)));
      CHECK(got == Approx(exact).epsilon(1e-3));
    }
  }
}

TEST_CASE("a white metal sends back no more than it gets, and as much as GGX says: integral over the hemisphere") {
  const Vec3f n{0, 1, 0};
  for (const float roughness : {0.3f, 0.5f, 0.8f, 1.0f}) {
    for (const double cosine : {0.05, 0.3, 0.7, 1.0}) {
      const Vec3f v = to_float3(unit({std::sqrt(1 - cosine * cosine), cosine, 0}));
      const auto r = make_reflectance<float>(surface(n, {1, 1, 1}, 1, roughness), v);
      constexpr int kRings = 300, kSpokes = 300;
      double sum = 0;
      for (int i = 0; i < kRings; ++i) {
        for (int j = 0; j < kSpokes; ++j) {
          // Equal areas of the hemisphere.
          const double y = (i + 0.5) / kRings, phi = 2 * kPiD * (j + 0.5) / kSpokes, ring = std::sqrt(1 - y * y);
          const Vec3f l = to_float3({ring * std::cos(phi), y, ring * std::sin(phi)});
          sum += reflect_light<float>(r, l, l.y).x;
        }
      }
      const double albedo = sum * 2 * kPiD / (kRings * kSpokes);
      CAPTURE(roughness, cosine, albedo);
      CHECK(albedo < 1.002);
      // At roughness 1 and normal view the integral is 1 - ln 2.
      if (roughness == 1.0f && cosine == 1.0) CHECK(albedo == Approx(1 - std::log(2.0)).epsilon(1e-3));
    }
  }
}

TEST_CASE("the environment's lobe is Karis' published fit") {
  for (int i = 0; i <= 20; ++i) {
    for (int j = 1; j <= 20; ++j) {
      const double r = i / 20.0, nv = j / 20.0;
      const double x = 1 - r, y = 0.0425 - 0.0275 * r, z = 1.04 - 0.572 * r, w = 0.022 * r - 0.04;
      const double a004 = std::min(x * x, std::exp2(-9.28 * nv)) * x + y;
      const Vec2f got = environment_brdf<float>(static_cast<float>(r), static_cast<float>(nv));
      CHECK(std::abs(double(got.x) - (z - 1.04 * a004)) < 3e-4);
      CHECK(std::abs(double(got.y) - std::max(0.0, 1.04 * a004 + w)) < 3e-4);
    }
  }
}

TEST_CASE("unlit lanes are their base colour, bit for bit, and lit ones beside them are not touched") {
  Lighting lighting;
  lighting.directional.push_back({{0, -1, 0}, {2, 2, 2}});
  lighting.ambient_up = {0.3f, 0.3f, 0.3f};
  SurfaceSample<WideF> s;
  s.normal_world = {WideF(0.0f), WideF(1.0f), WideF(0.0f)};
  float color[16], out[16];
  for (int i = 0; i < 16; ++i) color[i] = static_cast<float>(i) / 16.0f + 0.01f;
  s.base_color = {WideF::load(color), WideF(0.5f), WideF(0.25f)};
  s.metallic = WideF(0.0f);
  s.roughness = WideF(0.5f);
  s.emissive = {WideF(0.125f), WideF(0.0f), WideF(0.0f)};
  const Vec3<WideF> up{WideF(0.0f), WideF(1.0f), WideF(0.0f)}, one{WideF(1.0f), WideF(1.0f), WideF(1.0f)};
  shade<WideF>(s, mask_from_bits(0x5555), up, lighting, one).x.store(out);
  for (int i = 0; i < 16; ++i) {
    const auto lit = surface({0, 1, 0}, {color[i], 0.5f, 0.25f}, 0, 0.5f);
    auto glowing = lit;
    glowing.emissive = {0.125f, 0, 0};
    const float expected = i % 2 ? shade<float>(glowing, false, {0, 1, 0}, lighting, {1, 1, 1}).x : color[i];
    CHECK(out[i] == expected);
  }
}

TEST_CASE("a white furnace, light from behind, light scaled by water") {
  Lighting lighting;
  lighting.ambient_up = {1, 1, 1};
  lighting.ambient_down = {1, 1, 1};
  lighting.background.color = {1, 1, 1};
  // A white furnace: everything that comes in is 1, so nothing can leave above 1, and a white surface loses little.
  furnace::each_surface(lighting, {0, 1, 0}, 1, {0.0, 0.2, 0.6, 1.0}, {0.02, 0.3, 1.0}, [](float metallic, Vec3f out) {
    CHECK(out.x <= 1.01f);
    CHECK(out.x > (metallic == 0.0f ? 0.9f : 0.45f));
  });
  Lighting below;
  below.directional.push_back({{0, 1, 0}, {5, 5, 5}});
  const auto s = surface({0, 1, 0}, {0.5f, 0.5f, 0.5f}, 0, 0.5f);
  CHECK(shade<float>(s, false, {0, 1, 0}, below, {1, 1, 1}).x == 0.0f);

  Lighting above;
  above.directional.push_back({{0, -1, 0}, {5, 5, 5}});
  const Vec3f full = shade<float>(s, false, {0, 1, 0}, above, {1, 1, 1});
  const Vec3f dimmed = shade<float>(s, false, {0, 1, 0}, above, {0.5f, 0.25f, 0});
  CHECK(dimmed.x == full.x * 0.5f);
  CHECK(dimmed.y == full.y * 0.25f);
  CHECK(dimmed.z == 0.0f);
}

TEST_CASE("no direction gives NaN or a negative colour") {
  Lighting lighting;
  lighting.directional.push_back({{0, -1, 0}, {3, 3, 3}});
  lighting.background.kind = Background::Kind::kSky;
  Random random;
  int bad = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3f n = i % 50 == 0 ? Vec3f{0, 0, 0} : i % 50 == 1 ? Vec3f{0, 1, 0} : to_float3(random_direction(random));
    const Vec3f v = i % 50 == 2 ? Vec3f{0, -1, 0} : to_float3(random_direction(random));
    const auto s = surface(n, {1, 0, 0.5f}, i % 3 == 0 ? 1.0f : 0.0f, static_cast<float>(i % 5) * 0.25f);
    const Vec3f out = shade<float>(s, false, v, lighting, {1, 1, 1});
    bad += !(out.x >= 0 && out.y >= 0 && out.z >= 0 && out.x < 1e9f && out.y < 1e9f && out.z < 1e9f);
  }
  CHECK(bad == 0);
}

TEST_CASE("a surface from its material: factors multiply, double-sided normals turn, opaque ignores alpha") {
  const std::uint8_t half[4] = {188, 0, 255, 51};
  const Texture texture = make_texture_rgba8(1, 1, half, true), *textures = &texture;
  Material m;
  m.base_color = {0.5f, 1, 0.25f, 0.5f};
  m.base_color_texture = 0;
  m.metallic = 0.25f;
  m.roughness = 0.75f;
  m.emissive = {1, 2, 3};
  const auto make = [&] {
    return make_surface<float>(m, textures, {1, 2, 3}, {0, 2, 0}, {0, 0}, {0, 0}, {0, 0}, {0.5f, 1, 1, 0.5f},
                               {0, -1, 0}, true);
  };
  SurfaceSample<float> s = make();
  CHECK(s.base_color.x == Approx(0.25 * std::pow((188 / 255.0 + 0.055) / 1.055, 2.4)).epsilon(1e-4));
  CHECK(s.base_color.z == 0.25f);
  CHECK(s.alpha == 1.0f);
  CHECK(s.normal_world.y == 1.0f);
  CHECK(s.metallic == 0.25f);
  CHECK(s.roughness == 0.75f);
  CHECK(s.emissive.z == 3.0f);
  m.double_sided = true;
  m.alpha_mode = AlphaMode::kMask;
  s = make();
  CHECK(s.normal_world.y == -1.0f);
  CHECK(s.alpha == Approx(0.25 * 0.2).epsilon(1e-4));
  CHECK(surface_alpha<float>(m, textures, {0, 0}, {0, 0}, {0, 0}, 0.5f, true) == s.alpha);
}
