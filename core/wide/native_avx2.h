// AVX2: two registers of eight lanes, vector masks.
#pragma once

#include <bit>

#include "core/wide/compress_table.h"
#include "core/wide/native_x86.h"

namespace shoal::inline SHOAL_ISA_NS::wide_detail {
typedef float VF __attribute__((vector_size(32)));
typedef std::int32_t VI __attribute__((vector_size(32)));
typedef std::uint32_t VU __attribute__((vector_size(32)));
inline constexpr int kParts = 2;
}  // namespace shoal::inline SHOAL_ISA_NS::wide_detail

#include "core/wide/native_vector_mask.h"

namespace shoal::inline SHOAL_ISA_NS::wide_detail {

SHOAL_INLINE VF f_set1(float s) { return _mm256_set1_ps(s); }
SHOAL_INLINE VI i_set1(std::int32_t s) { return (VI)_mm256_set1_epi32(s); }
SHOAL_INLINE VF f_load(const float* p) { return _mm256_loadu_ps(p); }
SHOAL_INLINE VI i_load(const std::int32_t* p) { return (VI)_mm256_loadu_si256(reinterpret_cast<const __m256i*>(p)); }
SHOAL_INLINE void f_store(float* p, VF v) { _mm256_storeu_ps(p, v); }
SHOAL_INLINE void i_store(std::int32_t* p, VI v) { _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), (__m256i)v); }

SHOAL_INLINE std::uint32_t m_bits(VM a) { return static_cast<std::uint32_t>(_mm256_movemask_ps((__m256)a)); }
SHOAL_INLINE VM m_from_bits(std::uint32_t bits) {
  const VI lane_bit = {1, 2, 4, 8, 16, 32, 64, 128};
  return (i_set1(static_cast<std::int32_t>(bits)) & lane_bit) == lane_bit;
}
SHOAL_INLINE VF f_select(VM m, VF a, VF b) { return _mm256_blendv_ps(b, a, (__m256)m); }
SHOAL_INLINE VI i_select(VM m, VI a, VI b) { return (VI)_mm256_blendv_ps((__m256)b, (__m256)a, (__m256)m); }
SHOAL_INLINE VF f_min(VF a, VF b) { return _mm256_min_ps(a, b); }
SHOAL_INLINE VF f_max(VF a, VF b) { return _mm256_max_ps(a, b); }
SHOAL_INLINE VI i_min(VI a, VI b) { return (VI)_mm256_min_epi32((__m256i)a, (__m256i)b); }
SHOAL_INLINE VI i_max(VI a, VI b) { return (VI)_mm256_max_epi32((__m256i)a, (__m256i)b); }
SHOAL_INLINE VF f_sqrt(VF a) { return _mm256_sqrt_ps(a); }
SHOAL_INLINE VF f_floor(VF a) { return _mm256_floor_ps(a); }
SHOAL_INLINE VF f_from_i(VI a) { return _mm256_cvtepi32_ps((__m256i)a); }
SHOAL_INLINE VI i_trunc(VF a) { return (VI)_mm256_cvttps_epi32(a); }
SHOAL_INLINE VI i_nearest(VF a) { return (VI)_mm256_cvtps_epi32(a); }
SHOAL_INLINE VI i_shl(VI a, VI n) { return (VI)_mm256_sllv_epi32((__m256i)a, (__m256i)n); }
SHOAL_INLINE VI i_shr(VI a, VI n) { return (VI)_mm256_srlv_epi32((__m256i)a, (__m256i)n); }

// Both halves are looked up by the index's low three bits; bit 3 chooses (blendv reads the sign bit).
SHOAL_INLINE VF permute_two(VF low, VF high, VI index) {
  const __m256 from_low = _mm256_permutevar8x32_ps(low, (__m256i)index);
  const __m256 from_high = _mm256_permutevar8x32_ps(high, (__m256i)index);
  return _mm256_blendv_ps(from_low, from_high, (__m256)(VI)((VU)index << 28u));
}
SHOAL_INLINE void f_permute(const VF* v, const VI* index, VF* out) {
  const VF low = v[0], high = v[1];
  out[0] = permute_two(low, high, index[0]);
  out[1] = permute_two(low, high, index[1]);
}
SHOAL_INLINE void compress_four(std::int32_t* out, __m128i v, std::uint32_t bits) {
  const __m128i shuffle = _mm_load_si128(reinterpret_cast<const __m128i*>(kCompressTable.byte[bits]));
  _mm_storeu_si128(reinterpret_cast<__m128i*>(out), _mm_shuffle_epi8(v, shuffle));
}
// Four lanes at a time, each group stored where the one before ended; what follows the last is zero.
SHOAL_INLINE void i_compress(const VI* v, const VM* m, VI* out) {
  alignas(64) std::int32_t lane[16] = {};
  const std::uint32_t bits = m_bits(m[0]) | m_bits(m[1]) << 8;
  compress_four(lane, _mm256_castsi256_si128((__m256i)v[0]), bits & 15u);
  compress_four(lane + std::popcount(bits & 0xFu), _mm256_extracti128_si256((__m256i)v[0], 1), (bits >> 4) & 15u);
  compress_four(lane + std::popcount(bits & 0xFFu), _mm256_castsi256_si128((__m256i)v[1]), (bits >> 8) & 15u);
  compress_four(lane + std::popcount(bits & 0xFFFu), _mm256_extracti128_si256((__m256i)v[1], 1), bits >> 12);
  out[0] = i_load(lane);
  out[1] = i_load(lane + 8);
}
SHOAL_INLINE VI i_gather(const std::int32_t* base, VI index) {
  return (VI)_mm256_i32gather_epi32(base, (__m256i)index, 4);
}
SHOAL_INLINE VI i_gather(const std::int32_t* base, VI index, VM m, VI other) {
  return (VI)_mm256_mask_i32gather_epi32((__m256i)other, base, (__m256i)index, (__m256i)m, 4);
}
SHOAL_INLINE VF f_gather(const float* base, VI index) { return _mm256_i32gather_ps(base, (__m256i)index, 4); }
SHOAL_INLINE VF f_gather(const float* base, VI index, VM m, VF other) {
  return _mm256_mask_i32gather_ps(other, base, (__m256i)index, (__m256)m, 4);
}
SHOAL_INLINE void i_load_pairs(const std::uint32_t* base, const std::int32_t* index, VI& first, VI& second) {
  __m256 low = _mm256_castps128_ps256(load_two_pairs(base, index[0], index[1]));
  __m256 high = _mm256_castps128_ps256(load_two_pairs(base, index[2], index[3]));
  low = _mm256_insertf128_ps(low, load_two_pairs(base, index[4], index[5]), 1);
  high = _mm256_insertf128_ps(high, load_two_pairs(base, index[6], index[7]), 1);
  first = (VI)_mm256_shuffle_ps(low, high, 0x88);
  second = (VI)_mm256_shuffle_ps(low, high, 0xDD);
}
SHOAL_INLINE VI i_load_u8(const std::uint8_t* p) {
  return (VI)_mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(p)));
}
SHOAL_INLINE void i_store_u8(std::uint8_t* p, const VI* v) {
  store_u8_of_4(p, _mm256_castsi256_si128((__m256i)v[0]), _mm256_extracti128_si256((__m256i)v[0], 1),
                _mm256_castsi256_si128((__m256i)v[1]), _mm256_extracti128_si256((__m256i)v[1], 1));
}
// Lanes 0..7 with 8..15, then 0..3 with 4..7, and so on: the fixed tree.
SHOAL_INLINE float f_reduce_min(const VF* v) {
  const __m256 half = _mm256_min_ps(v[0], v[1]);
  return f_min_of_4(_mm_min_ps(_mm256_castps256_ps128(half), _mm256_extractf128_ps(half, 1)));
}
SHOAL_INLINE float f_reduce_max(const VF* v) {
  const __m256 half = _mm256_max_ps(v[0], v[1]);
  return f_max_of_4(_mm_max_ps(_mm256_castps256_ps128(half), _mm256_extractf128_ps(half, 1)));
}
SHOAL_INLINE std::int32_t i_reduce_min(const VI* v) {
  const __m256i half = (__m256i)i_min(v[0], v[1]);
  return i_min_of_4(_mm_min_epi32(_mm256_castsi256_si128(half), _mm256_extracti128_si256(half, 1)));
}
SHOAL_INLINE std::int32_t i_reduce_max(const VI* v) {
  const __m256i half = (__m256i)i_max(v[0], v[1]);
  return i_max_of_4(_mm_max_epi32(_mm256_castsi256_si128(half), _mm256_extracti128_si256(half, 1)));
}

}  // namespace shoal::inline SHOAL_ISA_NS::wide_detail
