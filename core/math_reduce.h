// Range reduction by pi/2 for core/math.h: short and wide for everyday angles, in 96-bit integers for the rest.
#pragma once

#include <cstdint>

#include "core/wide/lanes.h"

namespace shoal::inline SHOAL_ISA_NS::math_detail {

// The first 224 bits of 2/pi after 32 zeros, so that the window of any exponent from 2^-24 up starts inside of it.
inline constexpr std::uint32_t kTwoOverPi[8] = {0x00000000u, 0xA2F9836Eu, 0x4E441529u, 0xFC2757D1u,
                                                0xF534DDC0u, 0xDB629599u, 0x3C439041u, 0xFE5163ABu};

SHOAL_INLINE std::uint32_t two_over_pi_word(int bit) {
  const int word = bit >> 5;
  const std::uint32_t high = kTwoOverPi[word];
  const std::uint32_t low = word + 1 < 8 ? kTwoOverPi[word + 1] : 0u;
  return static_cast<std::uint32_t>(((static_cast<std::uint64_t>(high) << 32) | low) >> (32 - (bit & 31)));
}

// x - quadrant * pi/2 as hi + lo, for finite x >= 0.5; 0 for infinities and NaN. The quadrant is modulo 4.
//
// x = m 2^q with an integer m < 2^24. Of 2^q 2/pi only the bits from weight 2 down matter modulo 4; 96 of them times m,
// modulo 2^96, leave the quadrant in the top two bits and a fraction that is good to 2^-61.
// Source: Payne and Hanek, "Radian reduction for trigonometric functions", SIGNUM 1983.
SHOAL_INLINE void reduce_exactly(float x, float& hi, float& lo, std::int32_t& quadrant) {
  const std::uint32_t bits = static_cast<std::uint32_t>(as_int(x));
  const int exponent = static_cast<int>(bits >> 23) & 255;
  hi = lo = 0.0f;
  quadrant = 0;
  if (exponent == 255) return;
  const std::uint32_t m = (bits & 0x7FFFFFu) | 0x800000u;
  // Bit p of kTwoOverPi weighs 2^(31 - p) in 2/pi, so weight 2 in 2^q 2/pi is bit q + 30.
  const int first = exponent - 150 + 30;
  const std::uint64_t w0 = two_over_pi_word(first), w1 = two_over_pi_word(first + 32),
                      w2 = two_over_pi_word(first + 64);
  const std::uint64_t turns = ((m * w0) << 32) + m * w1 + ((m * w2) >> 32);
  const std::uint64_t nearest = (turns + (std::uint64_t{1} << 61)) >> 62;
  const std::int64_t rest = static_cast<std::int64_t>(turns - (nearest << 62));
  const double r = static_cast<double>(rest) * 0x1.921fb54442d18p-62;  // pi/2 * 2^-62
  hi = static_cast<float>(r);
  lo = static_cast<float>(r - static_cast<double>(hi));
  quadrant = static_cast<std::int32_t>(nearest & 3u);
}

// Lane by lane for the lanes of `which`. Out of line: it is rare, and every sine would carry a copy.
__attribute__((noinline, cold)) inline void reduce_lanes_exactly(const float* x, std::uint32_t which, float* hi,
                                                                 float* lo, std::int32_t* quadrant) {
  for (int i = 0; i < 16; ++i)
    if (((which >> i) & 1u) != 0) reduce_exactly(x[i], hi[i], lo[i], quadrant[i]);
}

SHOAL_INLINE void reduce_where(bool which, float x, float& hi, float& lo, std::int32_t& quadrant) {
  if (which) reduce_lanes_exactly(&x, 1u, &hi, &lo, &quadrant);
}
SHOAL_INLINE void reduce_where(WideM which, WideF x, WideF& hi, WideF& lo, WideI& quadrant) {
  const std::uint32_t lanes = to_bits(which);
  if (lanes == 0) return;
  alignas(64) float at[16], high[16], low[16];
  alignas(64) std::int32_t turn[16];
  x.store(at);
  hi.store(high);
  lo.store(low);
  quadrant.store(turn);
  reduce_lanes_exactly(at, lanes, high, low, turn);
  hi = WideF::load(high);
  lo = WideF::load(low);
  quadrant = WideI::load(turn);
}

// x = quadrant pi/2 + hi + lo with |hi + lo| <= pi/4 (1 + 2^-20), for x >= 0; a NaN or infinity is taken as 0.
//
// Up to 12000 the quadrant has 13 bits, so its products with the first three 11-bit pieces of pi/2 are exact, and so
// are the first two differences; the rest is off by 2^-49 at most. Where that is not small beside the result, and for
// larger x, integers take over. Source: Cody and Waite, Software Manual for the Elementary Functions, 1980.
template <class F>
SHOAL_INLINE void reduce_by_half_pi(F x, F& hi, F& lo, IntOf<F>& quadrant) {
  const MaskOf<F> large = !(x <= F(12000.0f));
  const F a = select(large, F(0.0f), x);
  quadrant = to_int_nearest(a * F(0x1.45f306p-1f));  // 2/pi
  const F k = to_float(quadrant);
  const F rest = (a - k * F(0x1.92p+0f)) - k * F(0x1.fb4p-12f);
  const F third = k * F(0x1.444p-24f);
  hi = rest - third;
  const F back = hi - rest;
  lo = ((rest - (hi - back)) - (third + back)) - k * F(0x1.68c234p-39f);
  const MaskOf<F> cancelled = (abs(hi) < F(0x1p-18f)) & (quadrant != IntOf<F>(0));
  reduce_where(large | cancelled, x, hi, lo, quadrant);
}

}  // namespace shoal::inline SHOAL_ISA_NS::math_detail
