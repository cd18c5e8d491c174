// SSE4.2: four registers of four lanes, vector masks.
#pragma once

#include <bit>

#include "core/wide/compress_table.h"
#include "core/wide/native_x86.h"

namespace shoal::inline SHOAL_ISA_NS::wide_detail {
typedef float VF __attribute__((vector_size(16)));
typedef std::int32_t VI __attribute__((vector_size(16)));
typedef std::uint32_t VU __attribute__((vector_size(16)));
inline constexpr int kParts = 4;
}  // namespace shoal::inline SHOAL_ISA_NS::wide_detail

#include "core/wide/native_vector_mask.h"

namespace shoal::inline SHOAL_ISA_NS::wide_detail {

SHOAL_INLINE VF f_set1(float s) { return _mm_set1_ps(s); }
SHOAL_INLINE VI i_set1(std::int32_t s) { return (VI)_mm_set1_epi32(s); }
SHOAL_INLINE VF f_load(const float* p) { return _mm_loadu_ps(p); }
SHOAL_INLINE VI i_load(const std::int32_t* p) { return (VI)_mm_loadu_si128(reinterpret_cast<const __m128i*>(p)); }
SHOAL_INLINE void f_store(float* p, VF v) { _mm_storeu_ps(p, v); }
SHOAL_INLINE void i_store(std::int32_t* p, VI v) { _mm_storeu_si128(reinterpret_cast<__m128i*>(p), (__m128i)v); }

SHOAL_INLINE std::uint32_t m_bits(VM a) { return static_cast<std::uint32_t>(_mm_movemask_ps((__m128)a)); }
SHOAL_INLINE VM m_from_bits(std::uint32_t bits) {
  const VI lane_bit = {1, 2, 4, 8};
  return (i_set1(static_cast<std::int32_t>(bits)) & lane_bit) == lane_bit;
}
SHOAL_INLINE VF f_select(VM m, VF a, VF b) { return _mm_blendv_ps(b, a, (__m128)m); }
SHOAL_INLINE VI i_select(VM m, VI a, VI b) { return (VI)_mm_blendv_ps((__m128)b, (__m128)a, (__m128)m); }
SHOAL_INLINE VF f_min(VF a, VF b) { return _mm_min_ps(a, b); }
SHOAL_INLINE VF f_max(VF a, VF b) { return _mm_max_ps(a, b); }
SHOAL_INLINE VI i_min(VI a, VI b) { return (VI)_mm_min_epi32((__m128i)a, (__m128i)b); }
SHOAL_INLINE VI i_max(VI a, VI b) { return (VI)_mm_max_epi32((__m128i)a, (__m128i)b); }
SHOAL_INLINE VF f_sqrt(VF a) { return _mm_sqrt_ps(a); }
SHOAL_INLINE VF f_floor(VF a) { return _mm_floor_ps(a); }
SHOAL_INLINE VF f_from_i(VI a) { return _mm_cvtepi32_ps((__m128i)a); }
SHOAL_INLINE VI i_trunc(VF a) { return (VI)_mm_cvttps_epi32(a); }
SHOAL_INLINE VI i_nearest(VF a) { return (VI)_mm_cvtps_epi32(a); }
// There is no shift by lane: a << n is a times 2^(n & 15), built in a float's exponent, then 16 more where n has that
// bit. (2^31 at once would rely on what an overflowing conversion gives, which GCC folds otherwise than x86 computes.)
SHOAL_INLINE VI i_shl(VI a, VI n) {
  const VU power = (VU)i_trunc((VF)((((VU)n & 15u) << 23u) + 0x3F800000u));
  const VU r = (VU)a * power;
  return i_select((VI)((VU)n << 27u), (VI)(r << 16u), (VI)r);
}
// Five conditional shifts, one for each bit of n.
SHOAL_INLINE VI i_shr(VI a, VI n) {
  VU r = (VU)a;
  r = (VU)i_select((VI)((VU)n << 31u), (VI)(r >> 1u), (VI)r);
  r = (VU)i_select((VI)((VU)n << 30u), (VI)(r >> 2u), (VI)r);
  r = (VU)i_select((VI)((VU)n << 29u), (VI)(r >> 4u), (VI)r);
  r = (VU)i_select((VI)((VU)n << 28u), (VI)(r >> 8u), (VI)r);
  return i_select((VI)((VU)n << 27u), (VI)(r >> 16u), (VI)r);
}

SHOAL_INLINE void f_permute(const VF* v, const VI* index, VF* out) {
  alignas(64) float from[16];
  alignas(64) float to[16];
  std::memcpy(from, v, 64);
  const Lanes at = to_lanes(index);
  for (int i = 0; i < 16; ++i) to[i] = from[at.at[i] & 15];
  std::memcpy(out, to, 64);
}
SHOAL_INLINE void compress_four(std::int32_t* out, VI v, std::uint32_t bits) {
  const __m128i shuffle = _mm_load_si128(reinterpret_cast<const __m128i*>(kCompressTable.byte[bits]));
  i_store(out, (VI)_mm_shuffle_epi8((__m128i)v, shuffle));
}
// Four lanes at a time, each group stored where the one before ended; what follows the last is zero.
SHOAL_INLINE void i_compress(const VI* v, const VM* m, VI* out) {
  Lanes lanes = {};
  const std::uint32_t b0 = m_bits(m[0]), b1 = m_bits(m[1]), b2 = m_bits(m[2]), b3 = m_bits(m[3]);
  const std::uint32_t bits = b0 | b1 << 4 | b2 << 8;
  compress_four(lanes.at, v[0], b0);
  compress_four(lanes.at + std::popcount(b0), v[1], b1);
  compress_four(lanes.at + std::popcount(bits & 0xFFu), v[2], b2);
  compress_four(lanes.at + std::popcount(bits), v[3], b3);
  from_lanes(lanes, out);
}
SHOAL_INLINE VI i_gather(const std::int32_t* base, VI i) { return VI{base[i[0]], base[i[1]], base[i[2]], base[i[3]]}; }
SHOAL_INLINE VI i_gather(const std::int32_t* base, VI i, VM m, VI other) {
  return VI{m[0] ? base[i[0]] : other[0], m[1] ? base[i[1]] : other[1], m[2] ? base[i[2]] : other[2],
            m[3] ? base[i[3]] : other[3]};
}
SHOAL_INLINE VF f_gather(const float* base, VI i) { return VF{base[i[0]], base[i[1]], base[i[2]], base[i[3]]}; }
SHOAL_INLINE VF f_gather(const float* base, VI i, VM m, VF other) {
  return VF{m[0] ? base[i[0]] : other[0], m[1] ? base[i[1]] : other[1], m[2] ? base[i[2]] : other[2],
            m[3] ? base[i[3]] : other[3]};
}
SHOAL_INLINE void i_load_pairs(const std::uint32_t* base, const std::int32_t* index, VI& first, VI& second) {
  const __m128 low = load_two_pairs(base, index[0], index[1]);
  const __m128 high = load_two_pairs(base, index[2], index[3]);
  first = (VI)_mm_shuffle_ps(low, high, 0x88);
  second = (VI)_mm_shuffle_ps(low, high, 0xDD);
}
SHOAL_INLINE VI i_load_u8(const std::uint8_t* p) {
  std::int32_t four;
  std::memcpy(&four, p, 4);
  return (VI)_mm_cvtepu8_epi32(_mm_cvtsi32_si128(four));
}
SHOAL_INLINE void i_store_u8(std::uint8_t* p, const VI* v) {
  store_u8_of_4(p, (__m128i)v[0], (__m128i)v[1], (__m128i)v[2], (__m128i)v[3]);
}
// Lanes 0..7 with 8..15, then 0..3 with 4..7, and so on: the fixed tree.
SHOAL_INLINE float f_reduce_min(const VF* v) { return f_min_of_4(f_min(f_min(v[0], v[2]), f_min(v[1], v[3]))); }
SHOAL_INLINE float f_reduce_max(const VF* v) { return f_max_of_4(f_max(f_max(v[0], v[2]), f_max(v[1], v[3]))); }
SHOAL_INLINE std::int32_t i_reduce_min(const VI* v) {
  return i_min_of_4((__m128i)i_min(i_min(v[0], v[2]), i_min(v[1], v[3])));
}
SHOAL_INLINE std::int32_t i_reduce_max(const VI* v) {
  return i_max_of_4((__m128i)i_max(i_max(v[0], v[2]), i_max(v[1], v[3])));
}

}  // namespace shoal::inline SHOAL_ISA_NS::wide_detail
