// Anisotropic filtering against double precision: the ellipse's axes, integrals over the footprint, exact constants.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "shading/surface.h"
#include "shading/textures/sample.h"

using namespace shoal;

namespace {

struct Random {
  std::mt19937 engine{4711};
  double unit() { return static_cast<double>(engine()) / 4294967296.0; }
  double between(double a, double b) { return a + (b - a) * unit(); }
  int below(int n) { return static_cast<int>(unit() * n); }
};

Sampler with_anisotropy(int limit) {
  Sampler s;
  s.anisotropy = limit;
  return s;
}

// What uv changes by over a pixel, as an ellipse: long and short axis in texels, the long one's direction in the
// texture, and how far the screen is turned against it.
struct Pixel {
  Vec2f dx, dy;
};
Pixel ellipse(const Texture& t, double long_px, double short_px, double in_texture, double on_screen) {
  const double ct = std::cos(in_texture), st = std::sin(in_texture), cs = std::cos(on_screen), ss = std::sin(on_screen);
  const auto column = [&](double a, double b) {  // J = U(texture) diag(long, short) V(screen)^T
    return Vec2f{static_cast<float>((ct * long_px * a - st * short_px * b) / t.width[0]),
                 static_cast<float>((st * long_px * a + ct * short_px * b) / t.height[0])};
  };
  return {column(cs, -ss), column(ss, cs)};
}

Texture checker(int size, int square) {
  std::vector<std::uint8_t> bytes;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const auto v = static_cast<std::uint8_t>((x / square + y / square) % 2 == 0 ? 255 : 0);
      bytes.insert(bytes.end(), {v, static_cast<std::uint8_t>(255 - v), v, v});
    }
  return make_texture_rgba8(size, size, bytes.data(), false);
}
Texture noise(Random& random, int width, int height, bool srgb) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
  for (auto& b : bytes) b = static_cast<std::uint8_t>(random.below(256));
  return make_texture_rgba8(width, height, bytes.data(), srgb);
}
Texture float_noise(Random& random, int width, int height) {
  std::vector<float> floats(static_cast<std::size_t>(width * height) * 4);
  for (auto& f : floats) f = static_cast<float>(random.between(-5, 1000));
  return make_texture_float(width, height, floats.data());
}

// The checker's mean over the pixel: the box of one pixel by one, mapped to the texture, in double.
double checker_integral(const Texture& t, int square, Vec2f uv, const Pixel& p) {
  constexpr int kSteps = 96;
  double sum = 0;
  for (int j = 0; j < kSteps; ++j)
    for (int i = 0; i < kSteps; ++i) {
      const double a = (i + 0.5) / kSteps - 0.5, b = (j + 0.5) / kSteps - 0.5;
      const double x = (double(uv.x) + double(p.dx.x) * a + double(p.dy.x) * b) * t.width[0];
      const double y = (double(uv.y) + double(p.dx.y) * a + double(p.dy.y) * b) * t.height[0];
      const auto cell =
          static_cast<std::int64_t>(std::floor(x / square)) + static_cast<std::int64_t>(std::floor(y / square));
      sum += cell % 2 == 0 ? 1 : 0;
    }
  return sum / (kSteps * kSteps);
}

Vec4f lane_of(const Vec4<WideF>& v, int i) {
  return {extract(v.x, i), extract(v.y, i), extract(v.z, i), extract(v.w, i)};
}
bool same_bits(Vec4f a, Vec4f b) {
  return as_int(a.x) == as_int(b.x) && as_int(a.y) == as_int(b.y) && as_int(a.z) == as_int(b.z) &&
         as_int(a.w) == as_int(b.w);
}

}  // namespace

TEST_CASE("footprint: axes, ratio and probe count are the ellipse's") {
  Random random;
  const Texture t = noise(random, 256, 64, false);
  double worst_axis = 0, worst_level = 0;
  int whole = 0;
  for (int i = 0; i < 20000; ++i) {
    const int limit = 2 + random.below(15);
    const double shorter = std::exp2(random.between(-3, 5)), ratio = std::exp2(random.between(0.01, 5));
    const double longer = shorter * ratio, angle = random.between(0, 2 * std::numbers::pi);
    const Pixel p = ellipse(t, longer, shorter, angle, random.between(0, 2 * std::numbers::pi));
    const Probes<float> got = footprint_probes<float>(t, p.dx, p.dy, limit);
    // Level 0 is the sharpest: no axis counts as less than a texel.
    const double kept_long = std::max(longer, 1.0), kept_short = std::max(shorter, 1.0);
    const double eta = std::min(kept_long / kept_short, double(limit));
    worst_level = std::max(worst_level, std::abs(std::log2(kept_long / eta) - 0.5 * std::log2(double(got.rho2))));
    const double parts = eta - 0.125;
    if (std::abs(parts - std::nearbyint(parts)) < 1e-4) {
      ++whole;
    } else if (got.count != std::max(1, static_cast<int>(std::ceil(parts)))) {
      FAIL_CHECK("count " << got.count << " of ratio " << ratio << ", limit " << limit);
    }
    if (ratio > 1.2 && longer > 1.0) {
      const double x = double(got.axis_uv.x) * t.width[0], y = double(got.axis_uv.y) * t.height[0];
      // Either end may come first.
      const double side = x * std::cos(angle) + y * std::sin(angle) < 0 ? -1 : 1;
      worst_axis = std::max(
          worst_axis, std::hypot(side * x - longer * std::cos(angle), side * y - longer * std::sin(angle)) / longer);
    }
  }
  CAPTURE(worst_axis, worst_level);
  CHECK(worst_level < 1e-5);
  CHECK(worst_axis < 1e-5);
  CHECK(whole < 100);
}

TEST_CASE("footprint: a limit of 16 is sixteen probes, a circle one, whatever the camera's roll") {
  const Texture t = checker(128, 4);
  for (int i = 0; i < 360; ++i) {
    const double roll = i * std::numbers::pi / 180;
    const Pixel circle = ellipse(t, 7.3, 7.3, 0.4, roll), thin = ellipse(t, 500, 1.5, 0.4, roll),
                line = ellipse(t, 90, 0, 1.0, roll);
    CHECK(footprint_probes<float>(t, circle.dx, circle.dy, 16).count == 1);
    CHECK(footprint_probes<float>(t, thin.dx, thin.dy, 16).count == 16);
    CHECK(footprint_probes<float>(t, thin.dx, thin.dy, 3).count == 3);
    CHECK(footprint_probes<float>(t, line.dx, line.dy, 16).count == 16);
  }
}

TEST_CASE("anisotropic: nearer to the integral over the pixel, the more probes there are") {
  Random random;
  constexpr int kSquare = 4;
  const Texture t = checker(256, kSquare);
  // A plane at a grazing angle: a pixel is 2 texels by 4 to 32, seen from any side.
  double error[17] = {};
  constexpr int kPixels = 1500;
  for (int i = 0; i < kPixels; ++i) {
    const Pixel p = ellipse(t, random.between(8, 32), 2, random.between(0, 3.2), random.between(-0.05, 0.05));
    const Vec2f uv = {static_cast<float>(random.unit()), static_cast<float>(random.unit())};
    const double exact = checker_integral(t, kSquare, uv, p);
    for (const int limit : {1, 2, 4, 8, 16}) {
      const double d = sample<float>(t, with_anisotropy(limit), uv, p.dx, p.dy, true).x - exact;
      error[limit] += d * d;
    }
  }
  for (double& e : error) e = std::sqrt(e / kPixels);
  CAPTURE(error[1], error[2], error[4], error[8], error[16]);
  CHECK(error[1] > 0.1);  // the level is as blurred as the long axis is long: all grey
  CHECK(error[2] < error[1]);
  CHECK(error[4] < error[2]);
  CHECK(error[8] < error[4]);
  CHECK(error[16] <= error[8]);
  CHECK(error[16] < error[1] / 10);
}

TEST_CASE("anisotropic: stripes along the long axis stay, stripes across it go") {
  std::vector<std::uint8_t> bytes;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) bytes.insert(bytes.end(), 4, static_cast<std::uint8_t>(x / 4 % 2 == 0 ? 255 : 0));
  const Texture t = make_texture_rgba8(64, 64, bytes.data(), false);
  const Pixel along = ellipse(t, 16, 1, std::numbers::pi / 2, 0), across = ellipse(t, 16, 1, 0, 0);
  const Vec2f middle_of_white = {2.0f / 64, 0.3f};
  CHECK(sample<float>(t, with_anisotropy(16), middle_of_white, along.dx, along.dy, true).x > 0.99f);
  CHECK(sample<float>(t, with_anisotropy(1), middle_of_white, along.dx, along.dy, true).x < 0.6f);
  // Two whole periods: half white, wherever the pixel is.
  for (int i = 0; i < 64; ++i) {
    const Vec2f uv = {static_cast<float>(i) / 64.0f, 0.3f};
    CHECK(sample<float>(t, with_anisotropy(16), uv, across.dx, across.dy, true).x == Approx(0.5).margin(2e-4));
  }
}

TEST_CASE("anisotropic: a constant texture is exactly constant, in every format") {
  Random random;
  for (const int byte : {1, 77, 128, 254, 255}) {
    const std::vector<std::uint8_t> bytes(32 * 32 * 4, static_cast<std::uint8_t>(byte));
    const std::vector<float> floats(32 * 32 * 4, static_cast<float>(byte) / 3.0f);
    const Texture textures[] = {make_texture_rgba8(32, 32, bytes.data(), true),
                                make_texture_rgba8(32, 32, bytes.data(), false),
                                make_texture_float(32, 32, floats.data())};
    for (const Texture& t : textures) {
      const Vec4f expected = sample<float>(t, Sampler{}, {0.5f, 0.5f}, {0, 0}, {0, 0}, true);
      for (int i = 0; i < 400; ++i) {
        const Pixel p = ellipse(t, std::exp2(random.between(0, 7)), random.between(0, 3), random.between(0, 7), 1.0);
        const Vec2f uv = {static_cast<float>(random.between(-3, 3)), static_cast<float>(random.between(-3, 3))};
        if (!same_bits(expected, sample<float>(t, with_anisotropy(2 + random.below(15)), uv, p.dx, p.dy, true)))
          FAIL_CHECK("byte " << byte << " changed");
      }
    }
  }
}

TEST_CASE("anisotropic: light is kept: over all positions the mean is the texture's") {
  Random random;
  const Texture t = noise(random, 32, 32, false);
  double texels = 0;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x)
      texels += static_cast<double>(t.rgba15[static_cast<std::size_t>(y * 33 + x)] & 0xFFFFu) / 32767.0;
  for (const double angle : {0.0, 0.3, 1.1, 2.5}) {
    const Pixel p = ellipse(t, 11, 1.7, angle, 0.2);
    double sum = 0;
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x) {
        const Vec2f uv = {(static_cast<float>(x) + 0.25f) / 32, (static_cast<float>(y) + 0.25f) / 32};
        sum += sample<float>(t, with_anisotropy(16), uv, p.dx, p.dy, true).x;
      }
    CHECK(sum / 1024 == Approx(texels / 1024).margin(2e-4));
  }
}

TEST_CASE("anisotropic: a magnified pixel and a limit of 1 have the bits of plain filtering") {
  Random random;
  const Texture t = noise(random, 64, 32, true);
  for (int i = 0; i < 4000; ++i) {
    const Vec2f uv = {static_cast<float>(random.between(-2, 2)), static_cast<float>(random.between(-2, 2))};
    const Pixel magnified = ellipse(t, random.between(0, 0.99), random.between(0, 0.5), random.between(0, 7), 2.0);
    const Vec4f plain = sample<float>(t, Sampler{}, uv, magnified.dx, magnified.dy, true);
    if (!same_bits(plain, sample<float>(t, with_anisotropy(16), uv, magnified.dx, magnified.dy, true)))
      FAIL_CHECK("magnified differs at " << uv.x << ", " << uv.y);
    const Pixel p = ellipse(t, random.between(1, 30), random.between(0, 3), random.between(0, 7), 1.0);
    if (!same_bits(sample<float>(t, Sampler{}, uv, p.dx, p.dy, true),
                   sample<float>(t, with_anisotropy(1), uv, p.dx, p.dy, true)))
      FAIL_CHECK("a limit of 1 differs at " << uv.x << ", " << uv.y);
  }
}

TEST_CASE("anisotropic: sixteen lanes give the bits of one, whatever the other lanes do") {
  Random random;
  const Texture textures[] = {noise(random, 33, 20, true), float_noise(random, 33, 20)};
  const Wrap wraps[] = {Wrap::kRepeat, Wrap::kMirror, Wrap::kClamp};
  int different = 0, compared = 0;
  for (int i = 0; i < 3000; ++i) {
    const Texture& t = textures[i % 2];
    Sampler s = with_anisotropy(2 + random.below(15));
    s.wrap_u = wraps[random.below(3)], s.wrap_v = wraps[random.below(3)];
    s.magnify = random.below(2) ? Filter::kLinear : Filter::kNearest;
    s.minify = random.below(2) ? Filter::kLinear : Filter::kNearest;
    s.mip = static_cast<MipFilter>(random.below(3));
    alignas(64) float in[6][16];
    for (int lane = 0; lane < 16; ++lane) {
      const Pixel p = ellipse(t, std::exp2(random.between(-2, 6)), std::exp2(random.between(-4, 2)),
                              random.between(0, 7), random.between(0, 7));
      in[0][lane] = static_cast<float>(random.between(-4, 4)), in[1][lane] = static_cast<float>(random.between(-4, 4));
      in[2][lane] = p.dx.x, in[3][lane] = p.dx.y, in[4][lane] = p.dy.x, in[5][lane] = p.dy.y;
    }
    const auto mask = static_cast<std::uint32_t>(random.below(65536));
    const auto wide = [&](int k) { return WideF::load(in[k]); };
    const Vec4<WideF> got =
        sample<WideF>(t, s, {wide(0), wide(1)}, {wide(2), wide(3)}, {wide(4), wide(5)}, mask_from_bits(mask));
    for (int lane = 0; lane < 16; ++lane) {
      if (((mask >> lane) & 1u) == 0) continue;
      const Vec4f one =
          sample<float>(t, s, {in[0][lane], in[1][lane]}, {in[2][lane], in[3][lane]}, {in[4][lane], in[5][lane]}, true);
      ++compared;
      different += !same_bits(one, lane_of(got, lane));
    }
  }
  CHECK(different == 0);
  CHECK(compared > 20000);
}

TEST_CASE("anisotropic: any coordinate and derivative is safe") {
  Random random;
  const float inf = std::numeric_limits<float>::infinity(), nan = std::nanf("");
  const float values[] = {nan, inf, -inf, 3e38f, -3e38f, 1e-38f, 1e-45f, 0.0f, -0.0f, 1.0f, 0.3f, 16777217.0f};
  constexpr int kValues = static_cast<int>(std::size(values));
  const Texture t = noise(random, 64, 16, true);
  for (int i = 0; i < 40000; ++i) {
    float v[6];
    for (float& x : v) x = values[random.below(kValues)];
    const Probes<float> p = footprint_probes<float>(t, {v[2], v[3]}, {v[4], v[5]}, 16);
    if (!(p.count >= 1 && p.count <= 16 && p.rho2 >= 1 && std::isfinite(p.rho2) && std::isfinite(p.axis_uv.x) &&
          std::isfinite(p.axis_uv.y)))
      FAIL("probes of " << v[2] << " " << v[3] << " " << v[4] << " " << v[5]);
    const Vec4f got = sample<float>(t, with_anisotropy(16), {v[0], v[1]}, {v[2], v[3]}, {v[4], v[5]}, true);
    for (const float c : {got.x, got.y, got.z, got.w})
      if (!(c >= 0.0f && c <= 1.0f)) FAIL("out of range at " << v[0] << ", " << v[1]);
  }
}

TEST_CASE("anisotropic: alpha cut-outs and every map of a material read it") {
  const Texture t = checker(64, 4);
  Material m;
  m.base_color_texture = m.normal.texture = m.occlusion.texture = m.emission.texture = m.metallic_roughness.texture = 0;
  m.set_anisotropy(16);
  for (const Sampler* s : {&m.base_color_sampler, &m.normal.sampler, &m.occlusion.sampler, &m.emission.sampler,
                           &m.metallic_roughness.sampler})
    CHECK(s->anisotropy == 16);
  // Along one row of squares, thin: the square's alpha is kept only by the anisotropic sampler.
  const Pixel p = ellipse(t, 12, 1, std::numbers::pi / 4, 0);
  const Vec2f uv = {2.0f / 64, 2.0f / 64};
  const float kept = surface_alpha<float>(m, &t, uv, p.dx, p.dy, 1.0f, true);
  m.set_anisotropy(1);
  CHECK(kept > surface_alpha<float>(m, &t, uv, p.dx, p.dy, 1.0f, true) + 0.2f);
}
