// The elementary functions against the double precision library, by exponent over the whole range of floats and at the
// known worst cases; the wide bits against the float bits; and a digest that is the same on every machine.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "core/math.h"
#include "tests/core/isa_case.h"
#include "tests/core/near_half_pi.h"

using namespace shoal;

namespace {

constexpr float kMost = std::numeric_limits<float>::max();
const float kNan = std::numeric_limits<float>::quiet_NaN();

using Inputs = std::vector<float>;

float from_bits(std::uint32_t bits) { return std::bit_cast<float>(bits); }

// Every exponent and sign, `n` random mantissas each, first and last of each binade.
Inputs all_binades(int n) {
  std::mt19937 engine(7);
  Inputs r;
  for (std::uint32_t top = 0; top < 512; ++top) {
    if ((top & 255u) == 255u) continue;
    for (int i = 0; i < n; ++i) r.push_back(from_bits(top << 23 | (static_cast<std::uint32_t>(engine()) & 0x7FFFFFu)));
    r.push_back(from_bits(top << 23));
    r.push_back(from_bits(top << 23 | 0x7FFFFFu));
  }
  return r;
}
// n even steps from low to high, moved off the grid by chance.
void add_range(Inputs& inputs, double low, double high, int n) {
  std::mt19937 engine(11);
  for (int i = 0; i < n; ++i)
    inputs.push_back(static_cast<float>(low + (high - low) * (i + static_cast<double>(engine()) / 4294967296.0) / n));
}
// The n floats on either side of v.
void add_around(Inputs& inputs, float v, int n) {
  float up = v, down = v;
  for (int i = 0; i < n; ++i) {
    inputs.push_back(up);
    inputs.push_back(down);
    up = std::nextafter(up, kMost);
    down = std::nextafter(down, -kMost);
  }
}

// |got - want| in units of the spacing of floats at want; where want overflows, infinity counts as 2^128.
double ulps(float got, double want) {
  if (std::isnan(got)) return 1e30;
  const double limit = 0x1p128;
  const double g = std::isinf(got) ? std::copysign(limit, got) : static_cast<double>(got);
  const double w = std::clamp(want, -limit, limit);
  const int exponent = w == 0.0 ? -149 : std::max(std::min(std::ilogb(w), 127) - 23, -149);
  return std::fabs(g - w) / std::ldexp(1.0, exponent);
}

template <class Ours, class Truth>
void check_bound(const char* name, const Inputs& inputs, double bound, Ours ours, Truth truth) {
  double worst = 0.0;
  float worst_at = 0.0f;
  for (const float x : inputs) {
    const double error = ulps(ours(x), truth(static_cast<double>(x)));
    if (!(error <= worst)) {
      worst = error;
      worst_at = x;
    }
  }
  INFO(name << ": worst " << worst << " ULP at " << worst_at << " (bits " << std::bit_cast<std::uint32_t>(worst_at)
            << "), got " << ours(worst_at) << ", want " << truth(static_cast<double>(worst_at)));
  CHECK(worst <= bound);
}

// Each float through sixteen lanes at once must give what it gives alone, bit for bit.
template <class Alone, class Wide>
void check_same_bits(const char* name, const Inputs& inputs, Alone alone, Wide wide) {
  for (std::size_t at = 0; at + 16 <= inputs.size(); at += 16) {
    float got[16];
    wide(WideF::load(inputs.data() + at)).store(got);
    for (std::size_t i = 0; i < 16; ++i) {
      const float want = alone(inputs[at + i]);
      if (std::bit_cast<std::uint32_t>(got[i]) == std::bit_cast<std::uint32_t>(want)) continue;
      FAIL(name << ": " << inputs[at + i] << " gives " << got[i] << " in lane " << i << ", " << want << " alone");
    }
  }
}

#define SHOAL_CHECK_FUNCTION(function, inputs, bound, truth)                                          \
  do {                                                                                                \
    check_bound(                                                                                      \
        #function, inputs, bound, [](float v) { return function(v); }, truth);                        \
    check_same_bits(                                                                                  \
        #function, inputs, [](float v) { return function(v); }, [](WideF v) { return function(v); }); \
  } while (false)

Inputs angles() {
  Inputs inputs = all_binades(200);
  add_range(inputs, -20.0, 20.0, 40000);
  add_range(inputs, -13000.0, 13000.0, 40000);
  for (const std::uint32_t bits : kNearHalfPi) {
    add_around(inputs, from_bits(bits), 2);
    inputs.push_back(-from_bits(bits));
  }
  // Beside the small multiples of pi/4, where quadrants change, and beside the end of the short reduction.
  for (int k = 1; k < 4000; ++k) add_around(inputs, static_cast<float>(k * 0.78539816339744830962), 3);
  add_around(inputs, 12000.0f, 500);
  return inputs;
}

}  // namespace

SHOAL_ISA_CASE(test_trigonometric, "sin, cos, tan over all finite floats") {
  const Inputs inputs = angles();
  SHOAL_CHECK_FUNCTION(det_sin, inputs, 1.0, [](double v) { return std::sin(v); });
  SHOAL_CHECK_FUNCTION(det_cos, inputs, 1.0, [](double v) { return std::cos(v); });
  SHOAL_CHECK_FUNCTION(det_tan, inputs, 2.5, [](double v) { return std::tan(v); });
  for (const float x : inputs) {
    if (det_sin(-x) == -det_sin(x) && det_cos(-x) == det_cos(x) && std::fabs(det_sin(x)) <= 1.0f) continue;
    FAIL("symmetry or range at " << x);
  }
  for (const float v : {kInfinity, -kInfinity, kNan}) {
    CHECK(det_sin(v) == 0.0f);
    CHECK(det_cos(v) == 1.0f);
    CHECK(det_tan(v) == 0.0f);
  }
  CHECK(std::bit_cast<std::uint32_t>(det_sin(-0.0f)) == 0x80000000u);
  // The sign of a NaN is the machine's choice: it must not show. Nor may a signaling one.
  for (const std::uint32_t nan : {0x7FC00000u, 0xFFC00000u, 0x7F800001u, 0xFF800001u}) {
    volatile std::uint32_t hidden = nan;
    const float v = from_bits(hidden);
    for (const float zero : {det_sin(v), det_tan(v), det_atan(v), det_exp2(v), det_exp(v)})
      CHECK(std::bit_cast<std::uint32_t>(zero) == 0u);
    CHECK(det_pow(2.0f, v) == 1.0f);
    CHECK(det_pow(v, 2.0f) == 0.0f);
    CHECK(det_log2(v) == -kInfinity);
    CHECK(det_acos(v) == kHalfPi);
  }
  CHECK(det_sin(kHalfPi) == 1.0f);
}

SHOAL_ISA_CASE(test_exponential, "exp2 and exp from underflow to overflow") {
  Inputs inputs = all_binades(200);
  add_range(inputs, -152.0, 130.0, 100000);
  add_range(inputs, -1.0, 1.0, 40000);
  for (int k = -303; k <= 260; ++k) add_around(inputs, 0.5f * static_cast<float>(k), 20);
  SHOAL_CHECK_FUNCTION(det_exp2, inputs, 1.25, [](double v) { return std::exp2(v); });
  SHOAL_CHECK_FUNCTION(det_exp, inputs, 1.75, [](double v) { return std::exp(v); });
  for (int k = -149; k <= 127; ++k) CHECK(det_exp2(static_cast<float>(k)) == std::ldexp(1.0f, k));
  CHECK(det_exp2(128.0f) == kInfinity);
  CHECK(det_exp2(kInfinity) == kInfinity);
  CHECK(det_exp2(-kInfinity) == 0.0f);
  CHECK(det_exp2(kNan) == 0.0f);
  CHECK(det_exp(0.0f) == 1.0f);
  CHECK(det_exp(89.0f) == kInfinity);
  CHECK(det_exp(-kInfinity) == 0.0f);
  CHECK(det_exp(kNan) == 0.0f);
}

SHOAL_ISA_CASE(test_logarithm, "log2 and log, denormals and neighbours of 1 included") {
  Inputs inputs;
  for (const float x : all_binades(400))
    if (x > 0.0f) inputs.push_back(x);
  add_range(inputs, 0.5, 2.0, 100000);
  add_around(inputs, 1.0f, 5000);
  add_around(inputs, 0x1.6a09e6p-1f, 500);
  SHOAL_CHECK_FUNCTION(det_log2, inputs, 0.75, [](double v) { return std::log2(v); });
  SHOAL_CHECK_FUNCTION(det_log, inputs, 0.75, [](double v) { return std::log(v); });
  for (int k = -149; k <= 127; ++k) CHECK(det_log2(std::ldexp(1.0f, k)) == static_cast<float>(k));
  for (const float v : {0.0f, -0.0f, -1.0f, -kMost, -kInfinity, kNan}) {
    CHECK(det_log2(v) == -kInfinity);
    CHECK(det_log(v) == -kInfinity);
  }
  CHECK(det_log2(kInfinity) == kInfinity);
  CHECK(det_log(kInfinity) == kInfinity);
}

SHOAL_ISA_CASE(test_arcs, "acos and atan") {
  Inputs inputs;
  for (const float x : all_binades(200))
    if (std::fabs(x) <= 1.0f) inputs.push_back(x);
  add_range(inputs, -1.0, 1.0, 100000);
  for (const float edge : {0.5f, -0.5f}) add_around(inputs, edge, 500);
  for (std::uint32_t i = 0; i < 5000; ++i) {
    inputs.push_back(from_bits(0x3F800000u - i));
    inputs.push_back(from_bits(0xBF800000u - i));
  }
  SHOAL_CHECK_FUNCTION(det_acos, inputs, 1.5, [](double v) { return std::acos(v); });
  for (const float v : {1.5f, kMost, kInfinity}) {
    CHECK(det_acos(v) == 0.0f);
    CHECK(det_acos(-v) == kPi);
  }
  CHECK(det_acos(kNan) == kHalfPi);

  Inputs all = all_binades(200);
  add_range(all, -10.0, 10.0, 40000);
  add_around(all, 0.41421356f, 500);
  add_around(all, 1.0f, 500);
  SHOAL_CHECK_FUNCTION(det_atan, all, 2.5, [](double v) { return std::atan(v); });
  CHECK(det_atan(kInfinity) == kHalfPi);
  CHECK(det_atan(-kInfinity) == -kHalfPi);
  CHECK(det_atan(kNan) == 0.0f);
}

SHOAL_ISA_CASE(test_atan2, "atan2 in all quadrants, at every ratio, at zeros and infinities") {
  std::mt19937 engine(3);
  Inputs ys = all_binades(300), xs = ys;
  std::shuffle(xs.begin(), xs.end(), engine);
  // Of similar size, so that the quotient is no power of ten off.
  const std::size_t wild = ys.size();
  for (std::size_t i = 0; i < wild; ++i) {
    const double ratio = static_cast<double>(engine()) / 1073741824.0;
    const float y = static_cast<float>(static_cast<double>(xs[i]) * ratio);
    if (!std::isfinite(y)) continue;
    ys.push_back(y);
    xs.push_back(xs[i]);
  }
  ys.resize(ys.size() / 16 * 16);
  double worst = 0.0;
  std::size_t at = 0;
  for (std::size_t i = 0; i < ys.size(); ++i) {
    const double error =
        ulps(det_atan2(ys[i], xs[i]), std::atan2(static_cast<double>(ys[i]), static_cast<double>(xs[i])));
    if (error <= worst) continue;
    worst = error;
    at = i;
  }
  INFO("worst at y = " << ys[at] << ", x = " << xs[at] << ": " << det_atan2(ys[at], xs[at]));
  CHECK(worst <= 2.5);
  for (std::size_t i = 0; i < ys.size(); i += 16) {
    float got[16];
    det_atan2(WideF::load(ys.data() + i), WideF::load(xs.data() + i)).store(got);
    for (std::size_t k = 0; k < 16; ++k) {
      const float alone = det_atan2(ys[i + k], xs[i + k]);
      if (std::bit_cast<std::uint32_t>(got[k]) == std::bit_cast<std::uint32_t>(alone)) continue;
      FAIL("lanes differ at y = " << ys[i + k] << ", x = " << xs[i + k]);
    }
  }
  const float special[] = {0.0f, -0.0f, 1.0f, -1.0f, kInfinity, -kInfinity, 0x1p-149f, -0x1p-149f, kMost, -kMost};
  for (const float y : special) {
    for (const float x : special) {
      const double want = std::atan2(static_cast<double>(y), static_cast<double>(x));
      const float got = det_atan2(y, x);
      INFO("y = " << y << ", x = " << x << ": got " << got << ", want " << want);
      CHECK(ulps(got, want) <= 2.5);
      CHECK(std::signbit(got) == std::signbit(want));
    }
    CHECK(det_atan2(y, kNan) == 0.0f);
    CHECK(det_atan2(kNan, y) == 0.0f);
  }
}

SHOAL_ISA_CASE(test_pow, "pow: any base, near 1 with large exponents, overflow and denormals") {
  std::mt19937 engine(5);
  Inputs xs, ys;
  const auto unit = [&] { return static_cast<double>(engine()) / 4294967296.0; };
  const auto add = [&](float x, double y) {
    if (!(std::fabs(y) <= static_cast<double>(kMost)) || !(x > 0.0f)) return;
    xs.push_back(x);
    ys.push_back(static_cast<float>(y));
  };
  for (const float x : all_binades(200)) {
    if (!(x > 0.0f) || x == 1.0f) continue;
    // Results from below the denormals to above infinity, and everyday exponents.
    add(x, (unit() * 284.0 - 154.0) / std::log2(static_cast<double>(x)));
    add(x, unit() * 8.0 - 4.0);
  }
  for (int i = 1; i < 4000; ++i) {
    for (const float x : {from_bits(0x3F800000u + static_cast<std::uint32_t>(i)),
                          from_bits(0x3F800000u - static_cast<std::uint32_t>(i))})
      for (int n = 0; n < 4; ++n) add(x, (unit() * 284.0 - 154.0) / std::log2(static_cast<double>(x)));
  }
  for (int i = 0; i < 60000; ++i) add(static_cast<float>(unit() * 4.0), unit() * 6.0 - 3.0);
  // The exponents of sRGB, on its range.
  for (int i = 0; i < 40000; ++i) add(static_cast<float>(unit()), i % 2 == 0 ? 2.4 : 1.0 / 2.4);
  xs.resize(xs.size() / 16 * 16);
  double worst = 0.0;
  std::size_t at = 0;
  for (std::size_t i = 0; i < xs.size(); ++i) {
    const double error = ulps(det_pow(xs[i], ys[i]), std::pow(static_cast<double>(xs[i]), static_cast<double>(ys[i])));
    if (error <= worst) continue;
    worst = error;
    at = i;
  }
  INFO("worst " << worst << " at x = " << xs[at] << ", y = " << ys[at] << ": " << det_pow(xs[at], ys[at]));
  CHECK(worst <= 1.5);
  for (std::size_t i = 0; i < xs.size(); i += 16) {
    float got[16];
    det_pow(WideF::load(xs.data() + i), WideF::load(ys.data() + i)).store(got);
    for (std::size_t k = 0; k < 16; ++k) {
      const float alone = det_pow(xs[i + k], ys[i + k]);
      if (std::bit_cast<std::uint32_t>(got[k]) == std::bit_cast<std::uint32_t>(alone)) continue;
      FAIL("lanes differ at x = " << xs[i + k] << ", y = " << ys[i + k]);
    }
  }
  const float bases[] = {0.0f, 0x1p-149f, 0.5f, 1.0f, 1.5f, kMost, kInfinity};
  const float exponents[] = {0.0f, -0.0f, 1.0f, -1.0f, 2.0f, kMost, -kMost, 0x1p-149f, kInfinity, -kInfinity};
  for (const float x : bases) {
    for (const float y : exponents) {
      INFO("x = " << x << ", y = " << y << ": got " << det_pow(x, y));
      CHECK(ulps(det_pow(x, y), std::pow(static_cast<double>(x), static_cast<double>(y))) <= 1.5);
    }
  }
  CHECK(det_pow(-2.0f, 2.0f) == 0.0f);
  CHECK(det_pow(kNan, 2.0f) == 0.0f);
  CHECK(det_pow(2.0f, kNan) == 1.0f);
}

namespace {

// FNV-1a over the result bits.
struct Digest {
  std::uint64_t value = 0xCBF29CE484222325u;
  void add(WideF v) {
    std::int32_t bits[16];
    as_int(v).store(bits);
    for (const std::int32_t b : bits) value = (value ^ static_cast<std::uint32_t>(b)) * 0x100000001B3u;
  }
};

template <class Function>
std::uint64_t digest_of(Function function) {
  std::uint64_t state = 1;
  const auto next = [&state] {  // SplitMix64
    state += 0x9E3779B97F4A7C15u;
    std::uint64_t z = (state ^ (state >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  };
  Digest digest;
  for (int round = 0; round < 8192; ++round) {
    std::int32_t any[16], everyday[16];
    for (std::size_t i = 0; i < 16; ++i) {
      const std::uint64_t r = next();
      any[i] = static_cast<std::int32_t>(r >> 32);
      everyday[i] = static_cast<std::int32_t>(r & 0xFFFFFFu) - 0x800000;
    }
    const WideF bits = as_float(WideI::load(any)), small = to_float(WideI::load(everyday)) * 0x1p-19f;
    digest.add(function(bits, small));
    digest.add(function(small, bits));
    digest.add(function(small * 0.0625f, permute(small, lane_index() ^ 5)));
  }
  return digest.value;
}

}  // namespace

// Infinities, NaN and denormals go in too: 393 216 results a function, 11 functions.
SHOAL_ISA_CASE(test_digest, "the same bits on every machine") {
  CHECK(digest_of([](WideF a, WideF) { return det_sin(a); }) == 0x5E27D20F0844CDAEu);
  CHECK(digest_of([](WideF a, WideF) { return det_cos(a); }) == 0x5616DB8595A12D41u);
  CHECK(digest_of([](WideF a, WideF) { return det_tan(a); }) == 0xD24E67F7318693A7u);
  CHECK(digest_of([](WideF a, WideF b) { return det_atan2(a, b); }) == 0x64A84AA999A1685Fu);
  CHECK(digest_of([](WideF a, WideF) { return det_atan(a); }) == 0x074B0A1524285277u);
  CHECK(digest_of([](WideF a, WideF) { return det_acos(a); }) == 0x2C803DD6D389E2E5u);
  CHECK(digest_of([](WideF a, WideF) { return det_exp2(a); }) == 0x94630C4C91C1AAFFu);
  CHECK(digest_of([](WideF a, WideF) { return det_exp(a); }) == 0xF02F5C73B9C456A1u);
  CHECK(digest_of([](WideF a, WideF) { return det_log2(a); }) == 0x057DAFB2849CC95Au);
  CHECK(digest_of([](WideF a, WideF) { return det_log(a); }) == 0x15C17019CF2245E7u);
  CHECK(digest_of([](WideF a, WideF b) { return det_pow(a, b); }) == 0x74B440BF05205B69u);
}
