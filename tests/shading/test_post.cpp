// The way to the 8-bit picture: the sRGB encoder against long double, tone curve, exposure, byte layout; and the sky.
#include <catch2/catch.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "shading/post.h"
#include "shading/sky.h"

using namespace shoal;

namespace {

long double encoded_exactly(long double x) {
  return x <= 0.0031308L ? 12.92L * x : 1.055L * std::pow(x, 1.0L / 2.4L) - 0.055L;
}

float step_ulp(float x, int n) {
  return std::bit_cast<float>(static_cast<std::int32_t>(std::bit_cast<std::int32_t>(x) + n));
}

void encode_all(const float (&x)[16], std::int32_t (&codes)[16]) { encode_srgb8(WideF::load(x)).store(codes); }

Background day() {
  Background b;
  b.kind = Background::Kind::kSky;
  b.to_sun_world = {0.6f, 0.8f, 0.0f};
  b.sun = {20, 18, 15};
  return b;
}

Vec3f unit(double x, double y, double z) {
  const double l = std::sqrt(x * x + y * y + z * z);
  return {static_cast<float>(x / l), static_cast<float>(y / l), static_cast<float>(z / l)};
}

}  // namespace

TEST_CASE("every threshold of the sRGB encoder is the exact one") {
  for (int k = 1; k < 256; ++k) {
    // The last float below the border and the first at or above it, by the inverse curve in long double.
    const long double encoded = (static_cast<long double>(k) - 0.5L) / 255;
    const long double border = encoded <= 0.04045L ? encoded / 12.92L : std::pow((encoded + 0.055L) / 1.055L, 2.4L);
    const float first = kSrgb8Threshold.at[k];
    CHECK(static_cast<long double>(first) >= border);
    CHECK(static_cast<long double>(step_ulp(first, -1)) < border);
    int wrong = 0;
    for (int n = -2000; n < 2000; n += 16) {
      float x[16];
      std::int32_t codes[16];
      for (int i = 0; i < 16; ++i) x[i] = step_ulp(first, n + i);
      encode_all(x, codes);
      for (int i = 0; i < 16; ++i) {
        wrong += codes[i] != (n + i < 0 ? k - 1 : k);
        wrong += encode_srgb8(x[i]) != codes[i];
      }
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("the sRGB encoder is exact between the thresholds, monotone, and knows no other bytes") {
  int last = 0, wrong = 0;
  float x[16];
  std::int32_t codes[16];
  const std::int32_t one = std::bit_cast<std::int32_t>(1.0f);
  for (std::int32_t bits = 0; bits <= one; bits += 3001) {
    const float value = std::bit_cast<float>(bits);
    std::fill(std::begin(x), std::end(x), value);
    encode_all(x, codes);
    // A hair from a threshold long double may round either way; the case above has those floats.
    const long double exact = 255 * encoded_exactly(static_cast<long double>(value)) + 0.5L;
    const bool clear = std::abs(exact - std::nearbyint(exact)) > 1e-6L;
    wrong += (clear && codes[5] != static_cast<int>(std::floor(exact))) || codes[5] < last;
    last = codes[5];
  }
  CHECK(wrong == 0);
  CHECK(last == 255);
  CHECK(encode_srgb8(1.0f) == 255);
  CHECK(encode_srgb8(0.0f) == 0);
}

TEST_CASE("out of range is clipped, NaN is black") {
  const float inf = std::numeric_limits<float>::infinity();
  const float x[16] = {std::nanf(""), -std::nanf(""), inf, -inf, 1e30f, -1e30f, -0.0f, 1.0000001f,
                       -1e-40f,       1e-40f,         2,   3,    0.5f,  1,      0,     0.99f};
  const int expected[16] = {0, 0, 255, 0, 255, 0, 0, 255, 0, 0, 255, 255, 188, 255, 0, 254};
  std::int32_t codes[16];
  encode_all(x, codes);
  for (int i = 0; i < 16; ++i) {
    CHECK(codes[i] == expected[i]);
    CHECK(encode_srgb8(x[i]) == expected[i]);
  }
}

TEST_CASE("the ACES curve: Narkowicz's fit, monotone, flat at 1, safe outside") {
  double worst = 0;
  float last = 0;
  for (int i = 0; i < 4000; ++i) {
    const float x = static_cast<float>(std::exp2(i * 0.01 - 20.0));
    const double d = static_cast<double>(x),
                 exact = std::min(1.0, d * (2.51 * d + 0.03) / (d * (2.43 * d + 0.59) + 0.14));
    const float got = tone_aces(x);
    worst = std::max(worst, std::abs(static_cast<double>(got) - exact));
    CHECK(got >= last - 1e-7f);
    last = got;
  }
  CHECK(worst < 5e-7);
  CHECK(tone_aces(0.0f) == 0.0f);
  CHECK(tone_aces(-1.0f) == 0.0f);
  CHECK(tone_aces(std::nanf("")) == 0.0f);
  CHECK(tone_aces(std::numeric_limits<float>::infinity()) == 1.0f);
}

TEST_CASE("exposure in stops doubles and halves exactly; no curve changes nothing") {
  for (int stops = -10; stops <= 10; ++stops) {
    PostSettings settings;
    settings.exposure_stops = static_cast<float>(stops);
    CHECK(exposure_scale(settings) == std::ldexp(1.0f, stops));
  }
  const Vec3f same = tone_map<float>({0.25f, 3.0f, 0.0f}, PostSettings{}, exposure_scale(PostSettings{}));
  CHECK(same.x == 0.25f);
  CHECK(same.y == 3.0f);
  CHECK(same.z == 0.0f);
}

TEST_CASE("a block's codes land as rows of RGB bytes, and nothing else is touched") {
  std::int32_t r[16], g[16], b[16];
  for (int i = 0; i < 16; ++i) {
    r[i] = i;
    g[i] = 100 + i;
    b[i] = 255 - i;
  }
  std::vector<std::uint8_t> image(4 * 20, 77);
  store_rgb8_block(image.data() + 3, 20, WideI::load(r), WideI::load(g), WideI::load(b));
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 20; ++x) {
      const int pixel = (x - 3) / 3, lane = 4 * y + pixel, c = (x - 3) % 3;
      const bool inside = x >= 3 && pixel < 4;
      const int expected = !inside ? 77 : c == 0 ? r[lane] : c == 1 ? g[lane] : b[lane];
      CHECK(int(image[static_cast<std::size_t>(y * 20 + x)]) == expected);
    }
  }
}

TEST_CASE("a background colour is what every ray sees") {
  Background b;
  b.color = {0.1f, 0.2f, 0.3f};
  b.sun = {5, 5, 5};
  const Vec3f seen = background_radiance<float>(b, {0, 1, 0});
  CHECK(seen.x == 0.1f);
  CHECK(seen.y == 0.2f);
  CHECK(seen.z == 0.3f);
}

TEST_CASE("the sky: zenith above, horizon all round, ground below, no step between") {
  Background b = day();
  b.sun = {0, 0, 0};
  CHECK(background_radiance<float>(b, {0, 1, 0}).x == Approx(b.zenith.x));
  CHECK(background_radiance<float>(b, {1, 0, 0}).x == Approx(b.horizon.x));
  CHECK(background_radiance<float>(b, {0, 0, -1}).z == Approx(b.horizon.z));
  CHECK(background_radiance<float>(b, {0, -1, 0}).y == Approx(b.ground.y));
  double largest_step = 0;
  Vec3f last = background_radiance<float>(b, {0, -1, 0});
  for (int i = 1; i <= 20000; ++i) {
    const double angle = (i / 20000.0 - 0.5) * 3.14159265358979;
    const Vec3f here = background_radiance<float>(b, unit(std::cos(angle), std::sin(angle), 0));
    largest_step = std::max({largest_step, std::abs(double(here.x - last.x)), std::abs(double(here.y - last.y)),
                             std::abs(double(here.z - last.z))});
    last = here;
  }
  CHECK(largest_step < 5e-3);
}

TEST_CASE("the sun: a disc of half a degree where it is said to be, a glow that falls off, none behind the ground") {
  const Background b = day();
  Background dark = b;
  dark.sun = {0, 0, 0};
  const auto above_sky = [&](double degrees) {
    // Turned from the sun in the vertical plane.
    const double angle = std::atan2(0.8, 0.6) + degrees * 3.14159265358979 / 180;
    const Vec3f d = unit(std::cos(angle), std::sin(angle), 0);
    return double(background_radiance<float>(b, d).x - background_radiance<float>(dark, d).x);
  };
  CHECK(above_sky(0.0) > 20.0);
  CHECK(above_sky(0.26) > 20.0);
  CHECK(above_sky(0.37) < 4.0);
  double last = above_sky(0.4);
  for (double degrees = 0.8; degrees < 60; degrees += 0.4) {
    const double here = above_sky(degrees);
    CHECK(here <= last);
    last = here;
  }
  CHECK(above_sky(30.0) > 0.0);
  Background set = b;
  set.to_sun_world = unit(1, -0.5, 0);
  dark.to_sun_world = set.to_sun_world;
  CHECK(background_radiance<float>(set, set.to_sun_world).x == background_radiance<float>(dark, set.to_sun_world).x);
}

TEST_CASE("sky lanes give the bits of one") {
  const Background b = day();
  float x[16], y[16], z[16], out[16];
  for (int i = 0; i < 16; ++i) {
    const Vec3f d = unit(std::cos(i * 0.4), i * 0.13 - 0.9, std::sin(i * 0.7));
    x[i] = d.x;
    y[i] = d.y;
    z[i] = d.z;
  }
  background_radiance<WideF>(b, {WideF::load(x), WideF::load(y), WideF::load(z)}).y.store(out);
  for (int i = 0; i < 16; ++i) CHECK(out[i] == background_radiance<float>(b, {x[i], y[i], z[i]}).y);
}
