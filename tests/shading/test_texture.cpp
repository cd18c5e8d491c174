// Textures against double precision: the sRGB tables, the mip chain as exact areas, level of detail, wrapping,
// filtering.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "core/error.h"
#include "shading/post.h"
#include "shading/srgb.h"
#include "shading/textures/sample.h"
#include "shading/textures/texture.h"

using namespace shoal;

namespace {

struct Random {
  std::mt19937 engine{12345};
  double unit() { return static_cast<double>(engine()) / 4294967296.0; }
  double between(double a, double b) { return a + (b - a) * unit(); }
  int below(int n) { return static_cast<int>(unit() * n); }
};

Texture random_texture(Random& random, int width, int height, bool srgb) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
  for (auto& b : bytes) b = static_cast<std::uint8_t>(random.below(256));
  return make_texture_rgba8(width, height, bytes.data(), srgb);
}

Texture constant_texture(int size, std::uint8_t byte, bool srgb) {
  const std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size * size) * 4, byte);
  return make_texture_rgba8(size, size, bytes.data(), srgb);
}

double stored(const Texture& t, int level, int x, int y, int c) {
  const std::int64_t at = t.first_texel[level] + static_cast<std::int64_t>(y) * (t.width[level] + 1) + x;
  if (t.format == TexelFormat::kRgba32Float)
    return static_cast<double>(t.rgba32f[static_cast<std::size_t>(at * 4 + c)]);
  return static_cast<double>((t.rgba15[static_cast<std::size_t>(at)] >> (16 * c)) & 0xFFFFu) / 32767.0;
}

int wrapped(std::int64_t i, int size, Wrap wrap) {
  if (wrap == Wrap::kClamp) return static_cast<int>(std::clamp<std::int64_t>(i, 0, size - 1));
  const std::int64_t period = wrap == Wrap::kRepeat ? size : 2 * static_cast<std::int64_t>(size);
  const std::int64_t m = ((i % period) + period) % period;
  return static_cast<int>(m < size ? m : period - 1 - m);
}

// The specification's filters in double, on the stored texels; no folding, no padding: texel by texel through
// `wrapped`.
double reference_level(const Texture& t, const Sampler& s, Filter filter, int level, double u, double v, int c) {
  const double x = u * t.width[level], y = v * t.height[level];
  const auto texel = [&](std::int64_t i, std::int64_t j) {
    return stored(t, level, wrapped(i, t.width[level], s.wrap_u), wrapped(j, t.height[level], s.wrap_v), c);
  };
  if (filter == Filter::kNearest)
    return texel(static_cast<std::int64_t>(std::floor(x)), static_cast<std::int64_t>(std::floor(y)));
  const double fx = std::floor(x - 0.5), fy = std::floor(y - 0.5), ax = x - 0.5 - fx, ay = y - 0.5 - fy;
  const auto i = static_cast<std::int64_t>(fx), j = static_cast<std::int64_t>(fy);
  return (texel(i, j) * (1 - ax) + texel(i + 1, j) * ax) * (1 - ay) +
         (texel(i, j + 1) * (1 - ax) + texel(i + 1, j + 1) * ax) * ay;
}

double reference_lod(const Texture& t, Vec2f dx, Vec2f dy) {
  const auto texels = [&](Vec2f d) { return std::hypot(double(d.x) * t.width[0], double(d.y) * t.height[0]); };
  return std::log2(std::max(texels(dx), texels(dy)));
}

double reference(const Texture& t, const Sampler& s, Vec2f uv, double lod, int c) {
  const Filter filter = lod > 0 ? s.minify : s.magnify;
  const double clamped = std::clamp(lod, 0.0, static_cast<double>(t.level_count - 1));
  if (s.mip == MipFilter::kNone) return reference_level(t, s, filter, 0, uv.x, uv.y, c);
  if (s.mip == MipFilter::kNearest)
    return reference_level(t, s, filter, std::min(static_cast<int>(clamped + 0.5), t.level_count - 1), uv.x, uv.y, c);
  const int lower = static_cast<int>(clamped), upper = std::min(lower + 1, t.level_count - 1);
  const double f = clamped - lower;
  return reference_level(t, s, filter, lower, uv.x, uv.y, c) * (1 - f) +
         reference_level(t, s, filter, upper, uv.x, uv.y, c) * f;
}

double lod_of(const Texture& t, Vec2f dx, Vec2f dy) {
  const auto lod = level_of_detail<float>(t, dx, dy);
  return lod.level + lod.fraction / 32768.0;
}

double channel(const Vec4f& v, int c) { return c == 0 ? v.x : c == 1 ? v.y : c == 2 ? v.z : v.w; }

bool near_whole(double v, double margin) { return std::abs(v - std::nearbyint(v)) < margin; }

}  // namespace

TEST_CASE("sRGB bytes to 15-bit linear light are the nearest integers") {
  for (int i = 0; i < 256; ++i) {
    const long double e = static_cast<long double>(i) / 255;
    const long double linear = e <= 0.04045L ? e / 12.92L : std::pow((e + 0.055L) / 1.055L, 2.4L);
    CHECK(kLinear15FromSrgb8.at[i] == static_cast<int>(std::floor(linear * 32767 + 0.5L)));
  }
}

TEST_CASE("texture sizes: halved and floored to 1 x 1, limits refused") {
  Random random;
  const Texture t = random_texture(random, 13, 5, true);
  REQUIRE(t.level_count == 4);
  const int widths[] = {13, 6, 3, 1}, heights[] = {5, 2, 1, 1};
  for (int k = 0; k < 4; ++k) {
    CHECK(t.width[k] == widths[k]);
    CHECK(t.height[k] == heights[k]);
  }
  CHECK(t.width[15] == 1);
  CHECK(t.first_texel[15] == t.first_texel[3]);
  CHECK(random_texture(random, 1, 1, true).level_count == 1);
  CHECK(random_texture(random, 16384, 1, true).level_count == kMaxTextureLevels);
  const std::uint8_t none[4] = {};
  const float no_floats[4] = {};
  CHECK_THROWS_AS(make_texture_rgba8(0, 1, none, true), Error);
  CHECK_THROWS_AS(make_texture_rgba8(1, 16385, none, true), Error);
  CHECK_THROWS_AS(make_texture_float(-1, 1, no_floats), Error);
}

TEST_CASE("mip texels are the exact area means of the level above") {
  Random random;
  const int sizes[][2] = {{8, 8}, {7, 5}, {13, 1}, {1, 9}, {37, 64}, {3, 3}};
  for (const auto& size : sizes) {
    const Texture t = random_texture(random, size[0], size[1], true);
    // The chain in double: source texel j lies under target i by the length of overlap of their intervals.
    std::vector<double> above;
    for (int y = 0; y < t.height[0]; ++y)
      for (int x = 0; x < t.width[0]; ++x) above.push_back(stored(t, 0, x, y, 1));
    for (int k = 1; k < t.level_count; ++k) {
      const int w0 = t.width[k - 1], h0 = t.height[k - 1], w = t.width[k], h = t.height[k];
      const auto overlap = [](int i, int n, int j, int n0) {
        const double scale = static_cast<double>(n0) / n;
        return std::max(0.0, std::min((i + 1) * scale, j + 1.0) - std::max(i * scale, static_cast<double>(j))) / scale;
      };
      std::vector<double> here;
      for (int y = 0; y < h; ++y) {
        for (int x = 0; x < w; ++x) {
          double sum = 0;
          for (int j = 0; j < h0; ++j)
            for (int i = 0; i < w0; ++i)
              sum += above[static_cast<std::size_t>(j * w0 + i)] * overlap(x, w, i, w0) * overlap(y, h, j, h0);
          here.push_back(sum);
          CHECK(std::abs(stored(t, k, x, y, 1) - sum) <= 0.51 / 32767);
        }
      }
      above = here;
    }
  }
}

TEST_CASE("float mips are area means; what is not finite becomes 0") {
  const float inf = std::numeric_limits<float>::infinity();
  std::vector<float> texels(5 * 3 * 4);
  for (std::size_t i = 0; i < texels.size(); ++i) texels[i] = static_cast<float>(i * i % 37) - 11.5f;
  double sum = 0;
  for (std::size_t i = 0; i < texels.size(); i += 4) sum += texels[i];
  const Texture t = make_texture_float(5, 3, texels.data());
  REQUIRE(t.level_count == 3);
  CHECK(stored(t, 2, 0, 0, 0) == Approx(sum / 15).epsilon(1e-6));
  texels[0] = inf;
  texels[1] = -inf;
  texels[2] = std::nanf("");
  const Texture scrubbed = make_texture_float(5, 3, texels.data());
  for (int c = 0; c < 3; ++c) CHECK(stored(scrubbed, 0, 0, 0, c) == 0.0);
}

TEST_CASE("every sRGB byte comes back from a texture, nearest, linear or trilinear, and from its bytes") {
  for (int byte = 0; byte < 256; ++byte) {
    const Texture t = constant_texture(4, static_cast<std::uint8_t>(byte), true);
    for (const Filter filter : {Filter::kNearest, Filter::kLinear}) {
      for (const float d : {0.01f, 0.37f}) {
        Sampler s;
        s.magnify = s.minify = filter;
        const Vec4f texel = sample<float>(t, s, {0.3f, 0.77f}, {d, 0}, {0, d}, true);
        CHECK(encode_srgb8(texel.x) == byte);
        CHECK(encode_srgb8(texel.z) == byte);
        CHECK(std::abs(double(texel.w) - byte / 255.0) <= 0.51 / 32767);
        if (byte == 255) CHECK(texel.w == 1.0f);
      }
    }
    CHECK(texture_bytes(t) == std::vector<std::uint8_t>(64, static_cast<std::uint8_t>(byte)));
    CHECK(texture_bytes(constant_texture(4, static_cast<std::uint8_t>(byte), false))[0] == byte);
  }
}

TEST_CASE("level of detail is log2 of the longer derivative in texels") {
  Random random;
  const Texture t = random_texture(random, 64, 16, true);
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const float scale = static_cast<float>(std::exp2(random.between(-9, 8)));
    const Vec2f dx = {static_cast<float>(random.between(-1, 1)) * scale,
                      static_cast<float>(random.between(-1, 1)) * scale};
    const Vec2f dy = {static_cast<float>(random.between(-1, 1)) * scale,
                      static_cast<float>(random.between(-1, 1)) * scale};
    const double exact = std::clamp(reference_lod(t, dx, dy), 0.0, 14.0);
    worst = std::max(worst, std::abs(lod_of(t, dx, dy) - exact));
  }
  CHECK(worst < 1e-4);
  CHECK(lod_of(t, {4.0f / 64, 0}, {0, 1.0f / 16}) == 2.0);
  const float nan = std::nanf(""), inf = std::numeric_limits<float>::infinity();
  CHECK(lod_of(t, {nan, nan}, {nan, nan}) == 0.0);
  CHECK(lod_of(t, {inf, 0}, {0, 0}) == 14.0);
  CHECK(lod_of(t, {0, 0}, {0, 0}) == 0.0);
}

TEST_CASE("filtering is within its bound of double precision, in every mode") {
  Random random;
  const int sizes[][2] = {{16, 16}, {7, 5}, {1, 1}, {3, 64}, {100, 1}};
  const Wrap wraps[] = {Wrap::kRepeat, Wrap::kMirror, Wrap::kClamp};
  double worst = 0;
  int compared = 0;
  for (const auto& size : sizes) {
    std::vector<float> floats(static_cast<std::size_t>(size[0] * size[1]) * 4);
    for (auto& f : floats) f = static_cast<float>(random.unit());
    const Texture textures[] = {random_texture(random, size[0], size[1], true),
                                random_texture(random, size[0], size[1], false),
                                make_texture_float(size[0], size[1], floats.data())};
    for (int i = 0; i < 12000; ++i) {
      const Texture& t = textures[i % 3];
      Sampler s;
      s.wrap_u = wraps[random.below(3)];
      s.wrap_v = wraps[random.below(3)];
      s.magnify = random.below(2) ? Filter::kLinear : Filter::kNearest;
      s.minify = random.below(2) ? Filter::kLinear : Filter::kNearest;
      s.mip = static_cast<MipFilter>(random.below(3));
      const double reach = random.below(10) == 0 ? 1000.0 : 3.0;
      const Vec2f uv = {static_cast<float>(random.between(-reach, reach)),
                        static_cast<float>(random.between(-reach, reach))};
      const float scale = static_cast<float>(std::exp2(random.between(-9, 2)));
      const Vec2f dx = {scale, 0.3f * scale}, dy = {-0.2f * scale, 0.7f * scale};
      // Where a choice of texel, filter or level lies within rounding, either is right: left out.
      const double lod = reference_lod(t, dx, dy);
      if (std::abs(lod) < 1e-3 || (s.mip == MipFilter::kNearest && near_whole(lod - 0.5, 1e-3))) continue;
      if ((lod > 0 ? s.minify : s.magnify) == Filter::kNearest) {
        bool on_border = false;
        for (int k = 0; k < t.level_count; ++k)
          on_border |= near_whole(double(uv.x) * t.width[k], 1e-4) || near_whole(double(uv.y) * t.height[k], 1e-4);
        if (on_border) continue;
      }
      const Vec4f got = sample<float>(t, s, uv, dx, dy, true);
      for (int c = 0; c < 4; ++c) {
        const double bound = 4.0 / 32767 + 1e-4 + std::max(size[0], size[1]) * 0x1p-23;
        const double error = std::abs(channel(got, c) - reference(t, s, uv, lod, c));
        worst = std::max(worst, error / bound);
        ++compared;
      }
    }
  }
  CAPTURE(worst);
  CHECK(worst <= 1.0);
  CHECK(compared > 100000);
}

TEST_CASE("magnified bilinear filtering is within 4 / 32767") {
  Random random;
  const Texture t = random_texture(random, 32, 32, true);
  double worst = 0;
  for (int i = 0; i < 40000; ++i) {
    const Vec2f uv = {static_cast<float>(random.unit()), static_cast<float>(random.unit())};
    const Vec4f got = sample<float>(t, Sampler{}, uv, {0.001f, 0}, {0, 0.001f}, true);
    for (int c = 0; c < 4; ++c)
      worst =
          std::max(worst, std::abs(channel(got, c) - reference_level(t, Sampler{}, Filter::kLinear, 0, uv.x, uv.y, c)));
  }
  CHECK(worst * 32767 < 4.0);
}

TEST_CASE("any texture coordinate is safe: not a number, infinite, huge, tiny negative") {
  Random random;
  const float inf = std::numeric_limits<float>::infinity(), nan = std::nanf("");
  const float values[] = {nan,    inf,  -inf,  3e38f, -3e38f,      16777217.0f, -1e-30f,
                          -1e-8f, 0.0f, -0.0f, 1.0f,  0.99999994f, -1.0f,       2.0f};
  for (const int size : {1, 3, 64, 16384}) {
    const Texture t = random_texture(random, size, size == 16384 ? 1 : size, true);
    for (const Wrap wrap : {Wrap::kRepeat, Wrap::kMirror, Wrap::kClamp}) {
      for (const Filter filter : {Filter::kNearest, Filter::kLinear}) {
        Sampler s;
        s.wrap_u = s.wrap_v = wrap;
        s.magnify = s.minify = filter;
        for (const float u : values) {
          for (const float v : values) {
            const Vec4f got = sample<float>(t, s, {u, v}, {u, v}, {v, u}, true);
            for (int c = 0; c < 4; ++c) {
              if (!(channel(got, c) >= 0.0 && channel(got, c) <= 1.0)) FAIL("out of range at " << u << ", " << v);
            }
          }
        }
      }
    }
  }
}

TEST_CASE("sixteen lanes give the bits of one, whatever the other lanes do") {
  Random random;
  std::vector<float> floats(33 * 20 * 4);
  for (auto& f : floats) f = static_cast<float>(random.between(-5, 1000));
  const Texture textures[] = {random_texture(random, 33, 20, true), make_texture_float(33, 20, floats.data())};
  const Wrap wraps[] = {Wrap::kRepeat, Wrap::kMirror, Wrap::kClamp};
  int different = 0;
  for (int i = 0; i < 4000; ++i) {
    const Texture& t = textures[i % 2];
    Sampler s;
    s.wrap_u = wraps[random.below(3)];
    s.wrap_v = wraps[random.below(3)];
    s.magnify = random.below(2) ? Filter::kLinear : Filter::kNearest;
    s.minify = random.below(2) ? Filter::kLinear : Filter::kNearest;
    s.mip = static_cast<MipFilter>(random.below(3));
    float in[6][16];
    for (int lane = 0; lane < 16; ++lane) {
      const double scale = std::exp2(random.between(-8, 2));
      for (int k = 0; k < 2; ++k) in[k][lane] = static_cast<float>(random.between(-4, 4));
      for (int k = 2; k < 6; ++k) in[k][lane] = static_cast<float>(random.between(-scale, scale));
    }
    const auto mask = static_cast<std::uint32_t>(random.below(65536));
    const auto wide = [&](int k) { return WideF::load(in[k]); };
    const Vec4<WideF> got =
        sample<WideF>(t, s, {wide(0), wide(1)}, {wide(2), wide(3)}, {wide(4), wide(5)}, mask_from_bits(mask));
    float out[4][16];
    got.x.store(out[0]);
    got.y.store(out[1]);
    got.z.store(out[2]);
    got.w.store(out[3]);
    for (int lane = 0; lane < 16; ++lane) {
      if (!((mask >> lane) & 1u)) continue;
      const Vec4f one =
          sample<float>(t, s, {in[0][lane], in[1][lane]}, {in[2][lane], in[3][lane]}, {in[4][lane], in[5][lane]}, true);
      different += as_int(one.x) != as_int(out[0][lane]);
      different += as_int(one.y) != as_int(out[1][lane]);
      different += as_int(one.z) != as_int(out[2][lane]);
      different += as_int(one.w) != as_int(out[3][lane]);
    }
  }
  CHECK(different == 0);
}
