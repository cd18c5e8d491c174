// The wide type, plain C++ body: the reference for every other one, and the one that runs everywhere.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/wide/isa_select.h"

namespace shoal::inline SHOAL_ISA_NS {

struct WideM {
  bool lane[16];
};

struct alignas(64) WideF {
  float lane[16];
  WideF() = default;
  SHOAL_INLINE WideF(float s) {  // NOLINT: broadcast is implicit on purpose
    for (float& l : lane) l = s;
  }
  static SHOAL_INLINE WideF load(const float* p) {
    WideF r;
    std::memcpy(r.lane, p, 64);
    return r;
  }
  SHOAL_INLINE void store(float* p) const { std::memcpy(p, lane, 64); }
};

struct alignas(64) WideI {
  std::int32_t lane[16];
  WideI() = default;
  SHOAL_INLINE WideI(std::int32_t s) {  // NOLINT: broadcast is implicit on purpose
    for (auto& l : lane) l = s;
  }
  static SHOAL_INLINE WideI load(const std::int32_t* p) {
    WideI r;
    std::memcpy(r.lane, p, 64);
    return r;
  }
  SHOAL_INLINE void store(std::int32_t* p) const { std::memcpy(p, lane, 64); }
};

namespace wide_detail {
template <class R, class Op>
SHOAL_INLINE R each(Op op) {
  R r;
  for (int i = 0; i < 16; ++i) r.lane[i] = op(i);
  return r;
}
SHOAL_INLINE std::uint32_t bits(std::int32_t a) { return static_cast<std::uint32_t>(a); }
SHOAL_INLINE std::int32_t wrap(std::uint32_t a) { return static_cast<std::int32_t>(a); }
// The fixed tree of reduce_min and reduce_max: lanes 0..7 with 8..15, then 0..3 with 4..7, then 0, 1 with 2, 3, then 0
// with 1. It decides which zero comes out where zeros of either sign go in.
template <class T, class Pick>
SHOAL_INLINE T reduce(const T* lane, Pick pick) {
  T r[16];
  std::memcpy(r, lane, 64);
  for (int n = 8; n > 0; n /= 2)
    for (int i = 0; i < n; ++i) r[i] = pick(r[i], r[i + n]);
  return r[0];
}
}  // namespace wide_detail

SHOAL_INLINE WideF operator+(WideF a, WideF b) {
  return wide_detail::each<WideF>([&](int i) { return a.lane[i] + b.lane[i]; });
}
SHOAL_INLINE WideF operator-(WideF a, WideF b) {
  return wide_detail::each<WideF>([&](int i) { return a.lane[i] - b.lane[i]; });
}
SHOAL_INLINE WideF operator*(WideF a, WideF b) {
  return wide_detail::each<WideF>([&](int i) { return a.lane[i] * b.lane[i]; });
}
SHOAL_INLINE WideF operator/(WideF a, WideF b) {
  return wide_detail::each<WideF>([&](int i) { return a.lane[i] / b.lane[i]; });
}
SHOAL_INLINE WideF operator-(WideF a) {
  return wide_detail::each<WideF>([&](int i) { return -a.lane[i]; });
}
SHOAL_INLINE WideM operator<(WideF a, WideF b) {
  return wide_detail::each<WideM>([&](int i) { return a.lane[i] < b.lane[i]; });
}
SHOAL_INLINE WideM operator<=(WideF a, WideF b) {
  return wide_detail::each<WideM>([&](int i) { return a.lane[i] <= b.lane[i]; });
}
SHOAL_INLINE WideM operator>(WideF a, WideF b) { return b < a; }
SHOAL_INLINE WideM operator>=(WideF a, WideF b) { return b <= a; }
SHOAL_INLINE WideM operator==(WideF a, WideF b) {
  return wide_detail::each<WideM>([&](int i) { return a.lane[i] == b.lane[i]; });
}
SHOAL_INLINE WideM operator!=(WideF a, WideF b) {
  return wide_detail::each<WideM>([&](int i) { return a.lane[i] != b.lane[i]; });
}

// Integers wrap.
SHOAL_INLINE WideI operator+(WideI a, WideI b) {
  return wide_detail::each<WideI>(
      [&](int i) { return wide_detail::wrap(wide_detail::bits(a.lane[i]) + wide_detail::bits(b.lane[i])); });
}
SHOAL_INLINE WideI operator-(WideI a, WideI b) {
  return wide_detail::each<WideI>(
      [&](int i) { return wide_detail::wrap(wide_detail::bits(a.lane[i]) - wide_detail::bits(b.lane[i])); });
}
// The low 32 bits.
SHOAL_INLINE WideI operator*(WideI a, WideI b) {
  return wide_detail::each<WideI>(
      [&](int i) { return wide_detail::wrap(wide_detail::bits(a.lane[i]) * wide_detail::bits(b.lane[i])); });
}
SHOAL_INLINE WideI operator-(WideI a) { return WideI(0) - a; }
SHOAL_INLINE WideI operator&(WideI a, WideI b) {
  return wide_detail::each<WideI>([&](int i) { return a.lane[i] & b.lane[i]; });
}
SHOAL_INLINE WideI operator|(WideI a, WideI b) {
  return wide_detail::each<WideI>([&](int i) { return a.lane[i] | b.lane[i]; });
}
SHOAL_INLINE WideI operator^(WideI a, WideI b) {
  return wide_detail::each<WideI>([&](int i) { return a.lane[i] ^ b.lane[i]; });
}
SHOAL_INLINE WideI operator~(WideI a) { return a ^ WideI(-1); }
// Shifts are by 0..31, elsewhere undefined.
SHOAL_INLINE WideI operator<<(WideI a, int n) {
  return wide_detail::each<WideI>([&](int i) { return wide_detail::wrap(wide_detail::bits(a.lane[i]) << n); });
}
// Arithmetic shift.
SHOAL_INLINE WideI operator>>(WideI a, int n) {
  return wide_detail::each<WideI>([&](int i) { return a.lane[i] >> n; });
}
SHOAL_INLINE WideI shift_right_logical(WideI a, int n) {
  return wide_detail::each<WideI>([&](int i) { return std::int32_t(std::uint32_t(a.lane[i]) >> n); });
}
// Each lane by its own n.
SHOAL_INLINE WideI shift_left(WideI a, WideI n) {
  return wide_detail::each<WideI>([&](int i) { return wide_detail::wrap(wide_detail::bits(a.lane[i]) << n.lane[i]); });
}
SHOAL_INLINE WideI shift_right_logical(WideI a, WideI n) {
  return wide_detail::each<WideI>([&](int i) { return wide_detail::wrap(wide_detail::bits(a.lane[i]) >> n.lane[i]); });
}
SHOAL_INLINE WideM operator<(WideI a, WideI b) {
  return wide_detail::each<WideM>([&](int i) { return a.lane[i] < b.lane[i]; });
}
SHOAL_INLINE WideM operator<=(WideI a, WideI b) {
  return wide_detail::each<WideM>([&](int i) { return a.lane[i] <= b.lane[i]; });
}
SHOAL_INLINE WideM operator>(WideI a, WideI b) { return b < a; }
SHOAL_INLINE WideM operator>=(WideI a, WideI b) { return b <= a; }
SHOAL_INLINE WideM operator==(WideI a, WideI b) {
  return wide_detail::each<WideM>([&](int i) { return a.lane[i] == b.lane[i]; });
}
SHOAL_INLINE WideM operator!=(WideI a, WideI b) {
  return wide_detail::each<WideM>([&](int i) { return a.lane[i] != b.lane[i]; });
}

SHOAL_INLINE WideM operator&(WideM a, WideM b) {
  return wide_detail::each<WideM>([&](int i) { return a.lane[i] && b.lane[i]; });
}
SHOAL_INLINE WideM operator|(WideM a, WideM b) {
  return wide_detail::each<WideM>([&](int i) { return a.lane[i] || b.lane[i]; });
}
SHOAL_INLINE WideM operator^(WideM a, WideM b) {
  return wide_detail::each<WideM>([&](int i) { return a.lane[i] != b.lane[i]; });
}
SHOAL_INLINE WideM operator!(WideM a) {
  return wide_detail::each<WideM>([&](int i) { return !a.lane[i]; });
}
// Bit i of the result is lane i; the upper sixteen bits are 0.
SHOAL_INLINE std::uint32_t to_bits(WideM m) {
  std::uint32_t bits = 0;
  for (int i = 0; i < 16; ++i) bits |= std::uint32_t(m.lane[i]) << i;
  return bits;
}
SHOAL_INLINE WideM mask_from_bits(std::uint32_t bits) {
  return wide_detail::each<WideM>([&](int i) { return ((bits >> i) & 1u) != 0; });
}
SHOAL_INLINE bool any(WideM m) { return to_bits(m) != 0; }
SHOAL_INLINE bool all(WideM m) { return to_bits(m) == 0xFFFFu; }
SHOAL_INLINE bool none(WideM m) { return to_bits(m) == 0; }

SHOAL_INLINE WideF select(WideM m, WideF a, WideF b) {
  return wide_detail::each<WideF>([&](int i) { return m.lane[i] ? a.lane[i] : b.lane[i]; });
}
SHOAL_INLINE WideI select(WideM m, WideI a, WideI b) {
  return wide_detail::each<WideI>([&](int i) { return m.lane[i] ? a.lane[i] : b.lane[i]; });
}
// min is a < b ? a : b and max is a > b ? a : b, so a NaN in either gives b.
SHOAL_INLINE WideF min(WideF a, WideF b) { return select(a < b, a, b); }
SHOAL_INLINE WideF max(WideF a, WideF b) { return select(a > b, a, b); }
SHOAL_INLINE WideI min(WideI a, WideI b) { return select(a < b, a, b); }
SHOAL_INLINE WideI max(WideI a, WideI b) { return select(a > b, a, b); }
SHOAL_INLINE WideF sqrt(WideF a) {
  return wide_detail::each<WideF>([&](int i) { return std::sqrt(a.lane[i]); });
}
SHOAL_INLINE WideF abs(WideF a) {
  return wide_detail::each<WideF>([&](int i) { return std::fabs(a.lane[i]); });
}
SHOAL_INLINE WideI abs(WideI a) { return max(a, -a); }
SHOAL_INLINE WideF floor(WideF a) {
  return wide_detail::each<WideF>([&](int i) { return std::floor(a.lane[i]); });
}

// Lane by lane: of a bit_cast of the whole struct GCC 12 makes accesses that its alias analysis then moves (AArch64,
// -O2).
SHOAL_INLINE WideI as_int(WideF a) {
  return wide_detail::each<WideI>([&](int i) { return std::bit_cast<std::int32_t>(a.lane[i]); });
}
SHOAL_INLINE WideF as_float(WideI a) {
  return wide_detail::each<WideF>([&](int i) { return std::bit_cast<float>(a.lane[i]); });
}
SHOAL_INLINE WideF to_float(WideI a) {
  return wide_detail::each<WideF>([&](int i) { return float(a.lane[i]); });
}
// v with its sign turned over where m is set (zeros and infinities too).
SHOAL_INLINE WideF flip_sign_if(WideF v, WideM m) { return select(m, -v, v); }
// Toward zero. The argument must be within +-2147483520 and no NaN.
SHOAL_INLINE WideI to_int_trunc(WideF a) {
  return wide_detail::each<WideI>([&](int i) { return std::int32_t(a.lane[i]); });
}
// Nearest, ties to even. Same domain. The rounding mode is nearest wherever Shoal runs (core/float_mode.h).
SHOAL_INLINE WideI to_int_nearest(WideF a) {
  return wide_detail::each<WideI>([&](int i) { return std::int32_t(std::lrintf(a.lane[i])); });
}

// lane i of the result is lane index[i] & 15 of v.
SHOAL_INLINE WideF permute(WideF v, WideI index) {
  return wide_detail::each<WideF>([&](int i) { return v.lane[index.lane[i] & 15]; });
}
SHOAL_INLINE WideI permute(WideI v, WideI index) {
  return wide_detail::each<WideI>([&](int i) { return v.lane[index.lane[i] & 15]; });
}
// The lanes that m selects, in order, at the front; the rest is 0.
SHOAL_INLINE WideI compress(WideI v, WideM m) {
  WideI r(0);
  for (int i = 0, n = 0; i < 16; ++i)
    if (m.lane[i]) r.lane[n++] = v.lane[i];
  return r;
}
SHOAL_INLINE WideF compress(WideF v, WideM m) { return as_float(compress(as_int(v), m)); }

SHOAL_INLINE WideF gather(const float* base, WideI index) {
  return wide_detail::each<WideF>([&](int i) { return base[index.lane[i]]; });
}
SHOAL_INLINE WideI gather(const std::int32_t* base, WideI index) {
  return wide_detail::each<WideI>([&](int i) { return base[index.lane[i]]; });
}
// Loads base[index] only where m is set; elsewhere the result is `other` and no memory is read.
SHOAL_INLINE WideF gather(const float* base, WideI index, WideM m, WideF other) {
  return wide_detail::each<WideF>([&](int i) { return m.lane[i] ? base[index.lane[i]] : other.lane[i]; });
}
SHOAL_INLINE WideI gather(const std::int32_t* base, WideI index, WideM m, WideI other) {
  return wide_detail::each<WideI>([&](int i) { return m.lane[i] ? base[index.lane[i]] : other.lane[i]; });
}
// Two neighbouring 32-bit texels, base[index] and base[index + 1], by one 64-bit load a lane.
SHOAL_INLINE void load_texel_pairs(const std::uint32_t* base, WideI index, WideI& first, WideI& second) {
  for (int i = 0; i < 16; ++i) {
    std::int32_t pair[2];
    std::memcpy(pair, base + index.lane[i], 8);
    first.lane[i] = pair[0];
    second.lane[i] = pair[1];
  }
}
SHOAL_INLINE WideI load_u8(const std::uint8_t* p) {
  return wide_detail::each<WideI>([&](int i) { return std::int32_t(p[i]); });
}
// Each lane clamped to 0..255, one byte each.
SHOAL_INLINE void store_u8(std::uint8_t* p, WideI v) {
  for (int i = 0; i < 16; ++i) p[i] = std::uint8_t(v.lane[i] < 0 ? 0 : v.lane[i] > 255 ? 255 : v.lane[i]);
}
// Rewrites the unselected lanes with what they held: for memory that one thread owns.
SHOAL_INLINE void store_masked(float* p, WideF v, WideM m) { select(m, v, WideF::load(p)).store(p); }
SHOAL_INLINE void store_masked(std::int32_t* p, WideI v, WideM m) { select(m, v, WideI::load(p)).store(p); }

// No NaN allowed. Sums across lanes do not exist on purpose.
SHOAL_INLINE float reduce_min(WideF v) {
  return wide_detail::reduce(v.lane, [](float a, float b) { return a < b ? a : b; });
}
SHOAL_INLINE float reduce_max(WideF v) {
  return wide_detail::reduce(v.lane, [](float a, float b) { return a > b ? a : b; });
}
SHOAL_INLINE std::int32_t reduce_min(WideI v) {
  return wide_detail::reduce(v.lane, [](std::int32_t a, std::int32_t b) { return a < b ? a : b; });
}
SHOAL_INLINE std::int32_t reduce_max(WideI v) {
  return wide_detail::reduce(v.lane, [](std::int32_t a, std::int32_t b) { return a > b ? a : b; });
}
SHOAL_INLINE WideI lane_index() {
  return wide_detail::each<WideI>([](int i) { return i; });
}
SHOAL_INLINE float extract(WideF v, int i) { return v.lane[i]; }
SHOAL_INLINE std::int32_t extract(WideI v, int i) { return v.lane[i]; }

}  // namespace shoal::inline SHOAL_ISA_NS
