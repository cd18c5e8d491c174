// Environments against double precision: integrals over the sphere by brute force, functions that are known exactly,
// and the furnace.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "core/thread_pool.h"
#include "furnace.h"
#include "shading/environment/build.h"
#include "shading/light.h"

using namespace shoal;
using furnace::surface;
using furnace::to_float3;
using furnace::unit;

namespace {

constexpr double kPiD = 3.14159265358979323846;

// As shading/environment/build.h states it: the centre is +x, a quarter right of it +z, the top +y.
Vec3d direction_of_texel(double u, double v) {
  const double phi = (u - 0.5) * 2 * kPiD, theta = v * kPiD;
  return {std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
}

template <class Radiance>
EquirectImage picture(int width, int height, Radiance radiance) {
  EquirectImage image{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Vec3d v = radiance(direction_of_texel((x + 0.5) / width, (y + 0.5) / height));
      for (const double c : {v.x, v.y, v.z}) image.rgb.push_back(static_cast<float>(c));
    }
  }
  return image;
}

// Smooth, of every colour, nowhere dark.
Vec3d smooth(Vec3d d) { return {1 + 0.8 * d.x, 1.2 + d.y * d.z, 0.5 + d.y * d.y * (0.5 + 0.4 * d.z)}; }
// A sky with a small bright sun: what an outdoor picture is like.
const Vec3d kSun = unit({0.5, 0.6, -0.4});
Vec3d sunny(Vec3d d) {
  const double glow = std::exp(-(1 - dot(d, kSun)) * 200);
  return {0.4 + 0.2 * d.y + 50 * glow, 0.5 + 40 * glow, 0.8 + 0.3 * d.y + 30 * glow};
}

// Calls at(direction, solid angle) for a fine grid of the sphere.
template <class At>
void over_sphere(int rings, At at) {
  const int spokes = 2 * rings;
  for (int i = 0; i < rings; ++i) {
    const double y = 1 - 2 * (i + 0.5) / rings, ring = std::sqrt(1 - y * y);
    for (int j = 0; j < spokes; ++j) {
      const double phi = 2 * kPiD * (j + 0.5) / spokes;
      at(Vec3d{ring * std::cos(phi), y, ring * std::sin(phi)}, 4 * kPiD / rings / spokes);
    }
  }
}

Vec3d random_direction(std::mt19937& engine) {
  const auto next = [&] { return static_cast<double>(engine()) / 2147483648.0 - 1; };
  for (;;) {
    const Vec3d v{next(), next(), next()};
    if (dot(v, v) > 0.01 && dot(v, v) < 1) return unit(v);
  }
}

double difference(Vec3f got, Vec3d want) {
  return std::max({std::abs(got.x - want.x), std::abs(got.y - want.y), std::abs(got.z - want.z)});
}

Vec3f seen(const Environment& e, Vec3d d) {
  Vec3f out;
  environment_radiance<float>(e, to_float3(d), out);
  return out;
}

Lighting surrounded(const EquirectImage& image, ThreadPool& pool) {
  Lighting lighting;
  lighting.background.kind = Background::Kind::kEnvironment;
  lighting.background.environment = std::make_shared<const Environment>(make_environment(image, pool));
  return lighting;
}

}  // namespace

TEST_CASE("environment: points of the circle are cosine and sine") {
  for (const unsigned n : {1u, 3u, 7u, 64u, 1974u, 16384u}) {
    for (unsigned i = 0; i <= n; i += 1 + n / 97) {
      const auto p = environment_parts::circle_point(i, n);
      const double angle = 2 * kPiD * static_cast<double>(i) / static_cast<double>(n);
      CHECK(std::abs(p.cosine - std::cos(angle)) < 4e-15);
      CHECK(std::abs(p.sine - std::sin(angle)) < 4e-15);
    }
  }
}

TEST_CASE("environment: the picture stands where the documentation says, on every side and across every fold") {
  ThreadPool pool(2);
  // A number of its own in each of six places, round the corner of four texels or, at a pole, in all of its row.
  struct Place {
    int x, y;
    Vec3d direction;
    float value;
  };
  const Place places[] = {{32, 16, {1, 0, 0}, 1}, {48, 16, {0, 0, 1}, 2}, {16, 16, {0, 0, -1}, 3},
                          {0, 16, {-1, 0, 0}, 4}, {-1, 0, {0, 1, 0}, 5},  {-1, 31, {0, -1, 0}, 6}};
  const int width = 64, height = 32;
  EquirectImage marks{width, height, std::vector<float>(width * height * 3, 0.0f)};
  for (const Place& p : places) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const int off = (x - p.x + width) % width;
        const bool here = p.x < 0 ? y == p.y : (off == 0 || off == width - 1) && (y == p.y || y == p.y - 1);
        if (here) marks.rgb[static_cast<std::size_t>(y * width + x) * 3 + 1] = p.value;
      }
    }
  }
  const Environment marked = make_environment(marks, pool);
  for (const Place& p : places) {
    CAPTURE(p.value);
    CHECK(seen(marked, p.direction).y == Approx(p.value).epsilon(0.05));
    CHECK(seen(marked, p.direction).x == 0.0f);
  }
  CHECK(seen(marked, {1, 1, 1}).y == 0.0f);
  const EquirectImage image = picture(256, 128, smooth);
  const Environment e = make_environment(image, pool);
  std::mt19937 engine{5};
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    Vec3d d = random_direction(engine);
    if (i % 4 == 1) d = unit({d.x, d.y * 1e-4, d.z});             // the fold at the horizon
    if (i % 4 == 2) d = unit({d.x * 1e-4, -std::abs(d.y), d.z});  // the map's outer edges
    if (i % 4 == 3) d = unit({d.x * 1e-3, d.y, d.z * 1e-3});
    worst = std::max(worst, difference(seen(e, d * 3.0), smooth(d)));
  }
  CHECK(worst < 6e-3);  // half a texel of 1/256, where the octahedron has a crease
  CHECK(seen(e, {0, 0, 0}).x > 0);
}

TEST_CASE("environment: texels keep bright and dark beside each other, and lanes are one pixel's bits") {
  ThreadPool pool(1);
  const Environment e = make_environment(picture(32, 16,
                                                 [](Vec3d d) {
                                                   return Vec3d{d.x > 0 ? 20000.0 : 1e-3, 0.0, d.y > 0 ? 1.0 : 0.25};
                                                 }),
                                         pool);
  CHECK(seen(e, unit({1, 0.5, 0.2})).x == Approx(20000).epsilon(1.0 / 2048));
  CHECK(seen(e, unit({-1, 0.5, 0.2})).x == Approx(1e-3).margin(20000 * 0x1p-31).epsilon(1.0 / 2048));
  CHECK(seen(e, unit({-1, 0.5, 0.2})).y == 0.0f);
  CHECK(seen(e, unit({0.3, -0.9, 0.2})).z == Approx(0.25).epsilon(1.0 / 2048));
  std::mt19937 engine{9};
  alignas(64) float x[16], y[16], z[16], rough[16], out[2][16];
  for (int i = 0; i < 16; ++i) {
    const Vec3f d = to_float3(random_direction(engine));
    x[i] = d.x, y[i] = d.y, z[i] = d.z, rough[i] = static_cast<float>(i) / 15.0f;
  }
  const Vec3<WideF> d{WideF::load(x), WideF::load(y), WideF::load(z)};
  Vec3<WideF> wide;
  environment_radiance<WideF>(e, d, wide);
  wide.x.store(out[0]);
  environment_lobe<WideF>(e, d, WideF::load(rough)).x.store(out[1]);
  for (int i = 0; i < 16; ++i) {
    CHECK(out[0][i] == seen(e, {double(x[i]), double(y[i]), double(z[i])}).x);
    CHECK(out[1][i] == environment_lobe<float>(e, {x[i], y[i], z[i]}, rough[i]).x);
  }
}

TEST_CASE("environment: a black picture is black, a tiny one works, threads change no byte") {
  ThreadPool one(1), three(3);
  const Environment black = make_environment(EquirectImage{2, 1, std::vector<float>(6, 0.0f)}, one);
  CHECK(seen(black, {0.3, -0.5, 0.1}).x == 0.0f);
  const Environment dot = make_environment(EquirectImage{1, 1, {0.5f, 2.0f, 1e6f}}, one);
  CHECK(seen(dot, {0.3, -0.5, 0.1}).x == Approx(0.5).margin(1e6 * 0x1p-31));
  CHECK(seen(dot, {0, -1, 0}).z == Approx(1e6).epsilon(1.0 / 2048));
  const EquirectImage image = picture(40, 20, sunny);
  const Environment a = make_environment(image, one), b = make_environment(image, three);
  CHECK(a.texels == b.texels);
  CHECK(a.lobe == b.lobe);
  CHECK(std::memcmp(a.irradiance, b.irradiance, sizeof a.irradiance) == 0);
}

TEST_CASE("environment: diffuse light is the cosine integral, for light of order 0 to 2 exactly") {
  ThreadPool pool(2);
  // Orders 0, 1 and 2 in one: nine functions can hold it.
  const auto low = [](Vec3d d) {
    return Vec3d{2 + d.x, 1 + 0.5 * d.y * d.z, 1.5 + 0.3 * (3 * d.y * d.y - 1) - 0.4 * d.x * d.z + 0.2 * d.z};
  };
  const Environment e = make_environment(picture(512, 256, low), pool);
  const Environment sun = make_environment(picture(128, 64, sunny), pool);
  std::mt19937 engine{3};
  double worst = 0, worst_sunny = 0;
  for (int i = 0; i < 12; ++i) {
    const Vec3d n = random_direction(engine);
    Vec3d sum{0, 0, 0}, sum_sunny{0, 0, 0};
    over_sphere(200, [&](Vec3d l, double area) {
      const double weight = std::max(0.0, dot(n, l)) * area / kPiD;
      sum = sum + low(l) * weight;
      sum_sunny = sum_sunny + sunny(l) * weight;
    });
    worst = std::max(worst, difference(environment_irradiance<float>(e, to_float3(n)), sum));
    worst_sunny = std::max(worst_sunny, difference(environment_irradiance<float>(sun, to_float3(n)), sum_sunny));
  }
  CAPTURE(worst, worst_sunny);
  CHECK(worst < 2e-4);
  // Nine functions against a sun: a few percent of its light (0.5 here) are misplaced.
  CHECK(worst_sunny < 0.04);
}

TEST_CASE("environment: prefiltered light is the GGX lobe's mean, integrated by brute force") {
  ThreadPool pool(2);
  const Environment soft = make_environment(picture(256, 128, smooth), pool);
  const Environment sun = make_environment(picture(256, 128, sunny), pool);
  std::mt19937 engine{11};
  for (const int level : {1, 2, 3, 5, 8}) {
    const double roughness = level / 8.0, alpha2 = std::pow(roughness, 4.0);
    double worst = 0, worst_sunny = 0;
    for (int i = 0; i < 5; ++i) {
      // Some look into the sun.
      const Vec3d n = i < 2 ? unit(kSun + random_direction(engine) * (0.3 * i)) : random_direction(engine);
      Vec3d sum{0, 0, 0}, sum_sunny{0, 0, 0};
      double total = 0;
      over_sphere(level == 1 ? 1000 : 300, [&](Vec3d l, double area) {
        const double nl = dot(n, l);
        if (nl <= 0) return;
        // The half vector's angle is half of the light's.
        const double cosine2 = (1 + nl) / 2, spread = 1 + (alpha2 - 1) * cosine2;
        const double weight = nl / (spread * spread) * area;
        total += weight;
        sum = sum + smooth(l) * weight;
        sum_sunny = sum_sunny + sunny(l) * weight;
      });
      const auto r = static_cast<float>(roughness);
      worst = std::max(worst, difference(environment_lobe<float>(soft, to_float3(n), r), sum * (1 / total)));
      worst_sunny =
          std::max(worst_sunny, difference(environment_lobe<float>(sun, to_float3(n), r), sum_sunny * (1 / total)) /
                                    std::max(1.0, sum_sunny.x / total));
    }
    CAPTURE(roughness, worst, worst_sunny);
    CHECK(worst < 0.01);
    CHECK(worst_sunny < 0.06);
  }
}

TEST_CASE("environment: the lobe's share of a uniform environment is the BRDF's integral over the hemisphere") {
  ThreadPool pool(2);
  const Environment e = make_environment(EquirectImage{1, 1, {1, 1, 1}}, pool);
  for (const double roughness : {0.12, 0.25, 0.4, 0.55, 0.7, 0.85, 1.0}) {
    const double a2 = std::pow(roughness, 4.0);
    for (const double nv : {0.03, 0.1, 0.25, 0.5, 0.77, 1.0}) {
      const Vec3d v{std::sqrt(1 - nv * nv), nv, 0};
      // Over the half vectors, which follow the lobe however narrow it is.
      const int rings = 400, spokes = 200;
      double white = 0, grazing = 0;
      for (int i = 0; i < rings; ++i) {
        const double u = (i + 0.5) / rings, c2 = (1 - u) / (1 + (a2 - 1) * u), nh = std::sqrt(c2);
        for (int j = 0; j < spokes; ++j) {
          const double phi = 2 * kPiD * (j + 0.5) / spokes, s = std::sqrt(1 - c2);
          const Vec3d h{s * std::cos(phi), nh, s * std::sin(phi)};
          const double vh = dot(v, h), nl = 2 * vh * nh - nv;
          if (nl <= 0 || vh <= 0) continue;
          const double visible =
              0.5 / (nl * std::sqrt(nv * nv * (1 - a2) + a2) + nv * std::sqrt(nl * nl * (1 - a2) + a2));
          const double part = visible * 4 * nl * vh / nh / rings / spokes;
          white += part;
          grazing += part * std::pow(1 - vh, 5.0);
        }
      }
      const Vec2f got = environment_lobe_share<float>(e, static_cast<float>(roughness), static_cast<float>(nv));
      CAPTURE(roughness, nv, white, got.x, grazing, got.y);
      CHECK(std::abs(got.x - white) < (nv < 0.1 ? 0.012 : 0.005));
      CHECK(std::abs(got.y - grazing) < 0.005);
    }
  }
  // At roughness 1 and normal view the integral is 1 - ln 2, of a mirror at any view 1.
  CHECK(environment_lobe_share<float>(e, 1, 1).x == Approx(1 - std::log(2.0)).epsilon(1e-3));
  CHECK(environment_lobe_share<float>(e, 0, 0.3f).x == Approx(1).epsilon(1e-4));
}

TEST_CASE("environment: a white furnace, metal or not, gives back 1 at every roughness and angle") {
  ThreadPool pool(2);
  const Lighting lighting = surrounded(EquirectImage{16, 8, std::vector<float>(16 * 8 * 3, 1.0f)}, pool);
  const Vec3d n = unit({0.3, -0.8, 0.5});
  std::vector<double> roughnesses = {0}, cosines;
  for (int i = 1; i <= 40; ++i) roughnesses.push_back(i / 40.0), cosines.push_back(i / 40.0);
  double worst = 0, worst_grey = 0;
  furnace::each_surface(lighting, n, 1, roughnesses, cosines, [&](float, Vec3f out) {
    worst = std::max(worst, difference(out, {1, 1, 1}));
  });
  furnace::each_surface(lighting, n, 0.5f, roughnesses, cosines,
                        [&](float, Vec3f out) { worst_grey = std::max(worst_grey, double(out.x)); });
  CAPTURE(worst);
  CHECK(worst < 1e-4);
  CHECK(worst_grey < 1.0);
  // Light is dimmed by what it crosses, ambient or not, and by occlusion.
  auto white = surface(to_float3(n), {1, 1, 1}, 0, 0.5f);
  white.occlusion = 0.5f;
  const Vec3f out = shade<float>(white, false, to_float3(n), lighting, {1, 0.5f, 0});
  CHECK(out.x == Approx(0.5).margin(1e-4));
  CHECK(out.y == Approx(0.25).margin(1e-4));
  CHECK(out.z == 0.0f);
}

TEST_CASE("environment: no direction gives NaN or a negative colour") {
  ThreadPool pool(2);
  Lighting lighting = surrounded(picture(64, 32, sunny), pool);
  lighting.directional.push_back({{0, -1, 0}, {3, 3, 3}});
  std::mt19937 engine{17};
  int bad = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3f n = i % 50 == 0 ? Vec3f{0, 0, 0} : i % 50 == 1 ? Vec3f{0, 1, 0} : to_float3(random_direction(engine));
    const Vec3f v = i % 50 == 2 ? Vec3f{0, -1, 0} : to_float3(random_direction(engine));
    const auto s = surface(n, {1, 0, 0.5f}, i % 3 == 0 ? 1.0f : 0.0f, static_cast<float>(i % 5) * 0.25f);
    const Vec3f out = shade<float>(s, false, v, lighting, {1, 1, 1});
    bad += !(out.x >= 0 && out.y >= 0 && out.z >= 0 && out.x < 1e9f && out.y < 1e9f && out.z < 1e9f);
  }
  CHECK(bad == 0);
}
