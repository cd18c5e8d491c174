// Elementary functions of our own: the same bits for float and WideF, on every instruction set and compiler.
//
// Only + - * / sqrt, compares, selects and integer operations; polynomials are minimax fits with float coefficients.
// None returns a NaN, whatever comes in; where C's would, the doc comment says what comes instead. Errors are in units
// in the last place (ULP) of the result against the real function, and tests/core/test_math.cpp pins each over the
// whole range of floats, denormals and known worst cases included.
#pragma once

#include "core/math_reduce.h"
#include "core/wide/lanes.h"

namespace shoal::inline SHOAL_ISA_NS {

inline constexpr float kPi = 0x1.921fb6p+1f;
inline constexpr float kHalfPi = 0x1.921fb6p+0f;
inline constexpr float kInfinity = __builtin_huge_valf();

namespace math_detail {

// v without its last twelve bits: the product of two such numbers is exact.
template <class F>
SHOAL_INLINE F upper_half(F v) {
  return as_float(as_int(v) & IntOf<F>(-4096));
}

// v, or `instead` where v is a NaN. By its bits: where a comparison feeds a clamp, Clang makes both one fmaxnm on
// AArch64, and that lets signaling NaNs through.
template <class F>
SHOAL_INLINE F unless_nan(F v, F instead) {
  return select((as_int(v) & IntOf<F>(0x7FFFFFFF)) > IntOf<F>(0x7F800000), instead, v);
}

// sin and cos of hi + lo, |hi + lo| <= pi/4. Fit errors 2^-32.5 and 2^-32.9, relative.
template <class F>
SHOAL_INLINE F sin_near_zero(F hi, F lo) {
  const F z = hi * hi;
  const F p = ((F(0x1.7c2da2p-19f) * z - F(0x1.a05956p-13f)) * z + F(0x1.111174p-7f)) * z - F(0x1.555556p-3f);
  return hi + ((hi * z) * p + (lo - lo * (F(0.5f) * z)));
}
template <class F>
SHOAL_INLINE F cos_near_zero(F hi, F lo) {
  const F z = hi * hi;
  const F half = F(0.5f) * z;
  const F p = (F(0x1.99e7ep-16f) * z - F(0x1.6c0c28p-10f)) * z + F(0x1.55554ap-5f);
  const F first = F(1.0f) - half;
  return first + (((F(1.0f) - first) - half) + ((z * z) * p - hi * lo));
}

// 2^(k + f) for |f| <= 0.5 and k within -152..129: fit error 2^-28. The two factors keep denormals and overflow right.
template <class F>
SHOAL_INLINE F exp2_of(IntOf<F> k, F f) {
  F p = F(0x1.3f906cp-13f) * f + F(0x1.5f0a66p-10f);
  p = p * f + F(0x1.3b30bp-7f);
  p = p * f + F(0x1.c6af78p-5f);
  p = p * f + F(0x1.ebfbd8p-3f);
  p = p * f + F(0x1.62e43p-1f);
  const IntOf<F> half = k >> 1;
  const F scale1 = as_float((half + IntOf<F>(127)) << 23);
  const F scale2 = as_float((k - half + IntOf<F>(127)) << 23);
  return ((F(1.0f) + f * p) * scale1) * scale2;
}

// log2 of a positive finite x as hi + lo, off by 2^-34 of it at most (2^-34 absolute once |log2 x| >= 1/2).
//
// x = 2^e m, m within sqrt(1/2)..sqrt(2), s = (m - 1)/(m + 1): log2 m = 2/(3 ln 2) s (3 + s^2 + s^4 R(s^2)), with s and
// the bracket carried in two floats. Fit error of the bracket 2^-43.
template <class F>
SHOAL_INLINE void log2_split(F x, F& hi, F& lo) {
  using I = IntOf<F>;
  const MaskOf<F> denormal = x < F(0x1p-126f);
  const I above = as_int(select(denormal, x * F(0x1p+24f), x)) - I(0x3F3504F3);  // sqrt(1/2)
  const F e = to_float((above >> 23) - select(denormal, I(24), I(0)));
  const F m = as_float((above & I(0x7FFFFF)) + I(0x3F3504F3));
  // s = s1 + s2
  const F f = m - F(1.0f), g = m + F(1.0f);
  const F g1 = upper_half(g), g2 = m - (g1 - F(1.0f));
  const F inverse = F(1.0f) / g;
  const F s1 = upper_half(f * inverse);
  const F s2 = ((f - s1 * g1) - s1 * g2) * inverse;
  const F s = s1 + s2, z = s * s;
  // The bracket: b1 + b2
  F tail = F(0x1.2c6f92p-2f) * z + F(0x1.54adc8p-2f);
  tail = tail * z + F(0x1.b6dd92p-2f);
  tail = tail * z + F(0x1.333332p-1f);
  const F small = s2 * (s + s1) + (z * z) * tail;
  const F square = s1 * s1;
  const F q = square + small, q_rest = small - (q - square);
  const F b = F(3.0f) + q;
  const F b1 = upper_half(b);
  const F b2 = ((q - (b - F(3.0f))) + q_rest) + (b - b1);
  // Their product: p1 + p2, times 2/(3 ln 2)
  const F u = s1 * b1, v = s2 * b + s1 * b2;
  const F p1 = upper_half(u + v), p2 = (u - p1) + v;
  const F l1 = p1 * F(0x1.ec8p-1f);
  const F l2 = p2 * F(0x1.ec709ep-1f) - p1 * F(0x1.ec478cp-14f);
  hi = e + l1;
  lo = (l1 - (hi - e)) + l2;
}

// atan(t) for |t| <= tan(pi/8), fit error 2^-29.8; asin(s) for 0 <= s <= 0.5 with z = s^2, fit error 2^-31.7.
template <class F>
SHOAL_INLINE F atan_near_zero(F t) {
  const F z = t * t;
  F p = F(0x1.b2752ap-4f) - F(0x1.f4bf5cp-5f) * z;
  p = p * z - F(0x1.23bdfp-3f);
  p = p * z + F(0x1.999206p-3f);
  p = p * z - F(0x1.55554ap-2f);
  return t + (t * z) * p;
}
template <class F>
SHOAL_INLINE F asin_near_zero(F s, F z) {
  F p = F(0x1.34c444p-5f) * z + F(0x1.d5241p-7f);
  p = p * z + F(0x1.04d2e2p-5f);
  p = p * z + F(0x1.6ca754p-5f);
  p = p * z + F(0x1.3338acp-4f);
  p = p * z + F(0x1.55554cp-3f);
  return s + (s * z) * p;
}

}  // namespace math_detail

// Sine and cosine of an angle in radians, together: half the price of both.
//
// x: any float; a NaN or infinity is taken as 0 (sine 0, cosine 1). sin(-x) is exactly -sin(x), cos(-x) exactly cos(x).
// Error: 1 ULP over all finite floats.
template <class F>
SHOAL_INLINE void det_sincos(F x, F& sine, F& cosine) {
  using I = IntOf<F>;
  // The sign of a NaN is the machine's choice, so it must not reach the sign of the zero that comes out.
  const F angle = math_detail::unless_nan(x, F(0.0f));
  F hi, lo;
  I quadrant;
  math_detail::reduce_by_half_pi(abs(angle), hi, lo, quadrant);
  const F s = math_detail::sin_near_zero(hi, lo), c = math_detail::cos_near_zero(hi, lo);
  const MaskOf<F> odd = (quadrant & I(1)) != I(0);
  const I sine_sign = (quadrant << 30) ^ as_int(angle);
  const I cosine_sign = (quadrant + I(1)) << 30;
  sine = flip_sign_if(select(odd, c, s), sine_sign < I(0));
  cosine = flip_sign_if(select(odd, s, c), cosine_sign < I(0));
}

// Sine of x radians: domain, special values and error as det_sincos.
template <class F>
SHOAL_INLINE F det_sin(F x) {
  F sine, cosine;
  det_sincos(x, sine, cosine);
  return sine;
}

// Cosine of x radians: domain, special values and error as det_sincos.
template <class F>
SHOAL_INLINE F det_cos(F x) {
  F sine, cosine;
  det_sincos(x, sine, cosine);
  return cosine;
}

// Tangent of x radians. A NaN or infinity is taken as 0. No float is close enough to a pole to overflow.
// Error: 2.5 ULP over all finite floats.
template <class F>
SHOAL_INLINE F det_tan(F x) {
  F sine, cosine;
  det_sincos(x, sine, cosine);
  return sine / cosine;
}

// The angle of (x, y) from +x, in radians within -pi..pi, zeros and infinities as in C (signed zeros choose the side).
// 0 where either is a NaN.
// Error: 2.5 ULP.
template <class F>
SHOAL_INLINE F det_atan2(F y, F x) {
  const F ax = abs(x), ay = abs(y);
  F large = max(ax, ay), small = min(ax, ay);
  // Both infinite, or both zero: any finite pair of the same ratio.
  const MaskOf<F> infinite = small == F(kInfinity);
  large = select(infinite, F(1.0f), large);
  small = select(infinite, F(1.0f), small);
  large = select(large == F(0.0f), F(1.0f), large);
  // Away from overflow of the sum and from denormals, exactly.
  const F scale = select(large > F(0x1p+126f), F(0.25f), select(large < F(0x1p-100f), F(0x1p+64f), F(1.0f)));
  large = large * scale;
  small = small * scale;
  // Within an eighth of a turn: atan(small / large), above pi/8 as pi/4 + atan((small - large) / (small + large)).
  const MaskOf<F> upper = (small > large * F(0x1.a8279ap-2f)) & (large < F(kInfinity));
  const F t = select(upper, small - large, small) / select(upper, small + large, large);
  F r = math_detail::atan_near_zero(t);
  F eighths = select(upper, F(1.0f), F(0.0f));
  // Reflected at the diagonal, at the y axis, at the x axis.
  const MaskOf<F> steep = ay > ax;
  eighths = select(steep, F(2.0f) - eighths, eighths);
  r = flip_sign_if(r, steep);
  const MaskOf<F> left = as_int(x) < IntOf<F>(0);
  eighths = select(left, F(4.0f) - eighths, eighths);
  r = flip_sign_if(r, left);
  // pi/4 in two parts, the first short enough for an exact product.
  const F angle = eighths * F(0x1.921fcp-1f) + (r - eighths * F(0x1.5777a6p-22f));
  const MaskOf<F> valid = (x == x) & (y == y);
  return select(valid, flip_sign_if(angle, as_int(y) < IntOf<F>(0)), F(0.0f));
}

// Arc tangent in radians, within -pi/2..pi/2. 0 for a NaN. Error: 2.5 ULP.
template <class F>
SHOAL_INLINE F det_atan(F x) {
  return det_atan2(x, F(1.0f));
}

// Arc cosine in radians, within 0..pi. x is clamped to -1..1; a NaN is taken as 0 (pi/2). Error: 1.5 ULP, near 1 too.
template <class F>
SHOAL_INLINE F det_acos(F x) {
  const F a = min(math_detail::unless_nan(abs(x), F(0.0f)), F(1.0f));
  const MaskOf<F> outer = a > F(0.5f), negative = x < F(0.0f);
  const F z = select(outer, (F(1.0f) - a) * F(0.5f), a * a);
  const F p = math_detail::asin_near_zero(select(outer, sqrt(z), a), z);
  const F inner_result = F(kHalfPi) - (flip_sign_if(p, negative) + F(0x1.777a5cp-25f));
  const F outer_result = select(negative, F(kPi) - ((p + p) + F(0x1.777a5cp-24f)), p + p);
  return select(outer, outer_result, inner_result);
}

// 2 to the x. +infinity from 128 up, 0 below -150; 0 for a NaN.
// Error: 1.25 ULP, of the denormal spacing too where the result is denormal.
template <class F>
SHOAL_INLINE F det_exp2(F x) {
  const F a = min(max(math_detail::unless_nan(x, F(-151.0f)), F(-151.0f)), F(129.0f));
  const IntOf<F> k = to_int_nearest(a);
  return math_detail::exp2_of(k, a - to_float(k));
}

// e to the x. +infinity from 88.73 up, 0 below -104; 0 for a NaN.
// Error: 1.75 ULP, of the denormal spacing too where the result is denormal.
template <class F>
SHOAL_INLINE F det_exp(F x) {
  const F a = min(max(math_detail::unless_nan(x, F(-104.5f)), F(-104.5f)), F(89.0f));
  const IntOf<F> k = to_int_nearest(a * F(0x1.715476p+0f));
  const F turns = to_float(k);
  // ln 2 in two parts, the first short enough for an exact product.
  const F rest = (a - turns * F(0x1.63p-1f)) + turns * F(0x1.bd0106p-13f);
  return math_detail::exp2_of(k, rest * F(0x1.715476p+0f));
}

// Logarithm to base 2. -infinity for zero, negative numbers and NaN; +infinity for +infinity. Denormals are
// numbers like any other.
// Error: 0.75 ULP, near 1 too.
template <class F>
SHOAL_INLINE F det_log2(F x) {
  F hi, lo;
  math_detail::log2_split(x, hi, lo);
  return select(x > F(0.0f), select(x < F(kInfinity), hi + lo, F(kInfinity)), F(-kInfinity));
}

// Natural logarithm; domain and special values as det_log2. Error: 0.75 ULP, near 1 too.
template <class F>
SHOAL_INLINE F det_log(F x) {
  F hi, lo;
  math_detail::log2_split(x, hi, lo);
  const F h = math_detail::upper_half(hi);
  const F r = h * F(0x1.62ep-1f) + (h * F(0x1.0bfbe8p-15f) + ((hi - h) + lo) * F(0x1.62e43p-1f));
  return select(x > F(0.0f), select(x < F(kInfinity), r, F(kInfinity)), F(-kInfinity));
}

// x to the y, for x >= 0. A negative or NaN x is taken as 0, a NaN y as 0, an infinite y as the largest float.
// Anything to the 0 is 1; 0 to the y is 0 for y > 0 and +infinity for y < 0, +infinity to the y the other way round.
// Overflow gives +infinity, underflow a denormal or 0.
// Error: 1.5 ULP, near 1 with large exponents and at denormal results too.
template <class F>
SHOAL_INLINE F det_pow(F x, F y) {
  const F most = F(0x1.fffffep+127f);
  const F exponent = max(min(math_detail::unless_nan(y, F(0.0f)), most), -most);
  const MaskOf<F> ordinary = (x > F(0.0f)) & (x < F(kInfinity));
  F hi, lo;
  math_detail::log2_split(select(ordinary, x, F(1.0f)), hi, lo);
  const F estimate = exponent * hi;
  const MaskOf<F> over = estimate > F(130.0f), under = estimate < F(-152.0f);
  const F n = select(over | under, F(0.0f), exponent);
  // n (hi + lo) in two floats.
  const F n1 = math_detail::upper_half(n), h1 = math_detail::upper_half(hi);
  const F p1 = n1 * h1;
  const F p2 = n * ((hi - h1) + lo) + (n - n1) * h1;
  const F sum = max(min(p1 + p2, F(129.0f)), F(-151.0f));
  const IntOf<F> k = to_int_nearest(sum);
  const F fraction = max(min((p1 - to_float(k)) + p2, F(1.0f)), F(-1.0f));
  F r = math_detail::exp2_of(k, fraction);
  r = select(over, F(kInfinity), select(under, F(0.0f), r));
  const F zero_power = select(y > F(0.0f), F(0.0f), select(y < F(0.0f), F(kInfinity), F(1.0f)));
  const F infinite_power = select(y > F(0.0f), F(kInfinity), select(y < F(0.0f), F(0.0f), F(1.0f)));
  return select(ordinary, r, select(x == F(kInfinity), infinite_power, zero_power));
}

}  // namespace shoal::inline SHOAL_ISA_NS
