// AVX-512 (F, BW, DQ, VL, CD): one register of sixteen lanes, masks in k registers.
#pragma once

#include "core/wide/native_x86.h"

namespace shoal::inline SHOAL_ISA_NS::wide_detail {

typedef float VF __attribute__((vector_size(64)));
typedef std::int32_t VI __attribute__((vector_size(64)));
typedef std::uint32_t VU __attribute__((vector_size(64)));
using VM = __mmask16;
inline constexpr int kParts = 1;

SHOAL_INLINE VF f_set1(float s) { return _mm512_set1_ps(s); }
SHOAL_INLINE VI i_set1(std::int32_t s) { return (VI)_mm512_set1_epi32(s); }
SHOAL_INLINE VF f_load(const float* p) { return _mm512_loadu_ps(p); }
SHOAL_INLINE VI i_load(const std::int32_t* p) { return (VI)_mm512_loadu_si512(p); }
SHOAL_INLINE void f_store(float* p, VF v) { _mm512_storeu_ps(p, v); }
SHOAL_INLINE void i_store(std::int32_t* p, VI v) { _mm512_storeu_si512(p, (__m512i)v); }
SHOAL_INLINE void f_store_masked(float* p, VF v, VM m) { _mm512_mask_storeu_ps(p, m, v); }
SHOAL_INLINE void i_store_masked(std::int32_t* p, VI v, VM m) { _mm512_mask_storeu_epi32(p, m, (__m512i)v); }

SHOAL_INLINE VM f_lt(VF a, VF b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
SHOAL_INLINE VM f_le(VF a, VF b) { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
SHOAL_INLINE VM f_eq(VF a, VF b) { return _mm512_cmp_ps_mask(a, b, _CMP_EQ_OQ); }
SHOAL_INLINE VM f_ne(VF a, VF b) { return _mm512_cmp_ps_mask(a, b, _CMP_NEQ_UQ); }
SHOAL_INLINE VM i_lt(VI a, VI b) { return _mm512_cmplt_epi32_mask((__m512i)a, (__m512i)b); }
SHOAL_INLINE VM i_le(VI a, VI b) { return _mm512_cmple_epi32_mask((__m512i)a, (__m512i)b); }
SHOAL_INLINE VM i_eq(VI a, VI b) { return _mm512_cmpeq_epi32_mask((__m512i)a, (__m512i)b); }
SHOAL_INLINE VM i_ne(VI a, VI b) { return _mm512_cmpneq_epi32_mask((__m512i)a, (__m512i)b); }

SHOAL_INLINE VM m_and(VM a, VM b) { return static_cast<VM>(a & b); }
SHOAL_INLINE VM m_or(VM a, VM b) { return static_cast<VM>(a | b); }
SHOAL_INLINE VM m_xor(VM a, VM b) { return static_cast<VM>(a ^ b); }
SHOAL_INLINE VM m_not(VM a) { return static_cast<VM>(~a); }
SHOAL_INLINE std::uint32_t m_bits(VM a) { return a; }
SHOAL_INLINE VM m_from_bits(std::uint32_t bits) { return static_cast<VM>(bits); }

SHOAL_INLINE VF f_select(VM m, VF a, VF b) { return _mm512_mask_blend_ps(m, b, a); }
SHOAL_INLINE VI i_select(VM m, VI a, VI b) { return (VI)_mm512_mask_blend_epi32(m, (__m512i)b, (__m512i)a); }
SHOAL_INLINE VF f_min(VF a, VF b) { return _mm512_min_ps(a, b); }
SHOAL_INLINE VF f_max(VF a, VF b) { return _mm512_max_ps(a, b); }
SHOAL_INLINE VI i_min(VI a, VI b) { return (VI)_mm512_min_epi32((__m512i)a, (__m512i)b); }
SHOAL_INLINE VI i_max(VI a, VI b) { return (VI)_mm512_max_epi32((__m512i)a, (__m512i)b); }
SHOAL_INLINE VF f_sqrt(VF a) { return _mm512_sqrt_ps(a); }
SHOAL_INLINE VF f_floor(VF a) { return _mm512_roundscale_ps(a, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC); }
SHOAL_INLINE VF f_from_i(VI a) { return _mm512_cvtepi32_ps((__m512i)a); }
SHOAL_INLINE VI i_trunc(VF a) { return (VI)_mm512_cvttps_epi32(a); }
SHOAL_INLINE VI i_nearest(VF a) { return (VI)_mm512_cvtps_epi32(a); }
SHOAL_INLINE VI i_shl(VI a, VI n) { return (VI)_mm512_sllv_epi32((__m512i)a, (__m512i)n); }
SHOAL_INLINE VI i_shr(VI a, VI n) { return (VI)_mm512_srlv_epi32((__m512i)a, (__m512i)n); }

SHOAL_INLINE void f_permute(const VF* v, const VI* index, VF* out) {
  out[0] = _mm512_permutexvar_ps((__m512i)index[0], v[0]);
}
SHOAL_INLINE void i_compress(const VI* v, const VM* m, VI* out) {
  out[0] = (VI)_mm512_maskz_compress_epi32(m[0], (__m512i)v[0]);
}
SHOAL_INLINE VI i_gather(const std::int32_t* base, VI index) {
  return (VI)_mm512_i32gather_epi32((__m512i)index, base, 4);
}
SHOAL_INLINE VI i_gather(const std::int32_t* base, VI index, VM m, VI other) {
  return (VI)_mm512_mask_i32gather_epi32((__m512i)other, m, (__m512i)index, base, 4);
}
SHOAL_INLINE VF f_gather(const float* base, VI index) { return _mm512_i32gather_ps((__m512i)index, base, 4); }
SHOAL_INLINE VF f_gather(const float* base, VI index, VM m, VF other) {
  return _mm512_mask_i32gather_ps(other, m, (__m512i)index, base, 4);
}
// Two registers of four pairs each, merged, then split into first and second texels.
SHOAL_INLINE void i_load_pairs(const std::uint32_t* base, const std::int32_t* index, VI& first, VI& second) {
  __m512 low = _mm512_castps128_ps512(load_two_pairs(base, index[0], index[1]));
  __m512 high = _mm512_castps128_ps512(load_two_pairs(base, index[2], index[3]));
  low = _mm512_insertf32x4(low, load_two_pairs(base, index[4], index[5]), 1);
  high = _mm512_insertf32x4(high, load_two_pairs(base, index[6], index[7]), 1);
  low = _mm512_insertf32x4(low, load_two_pairs(base, index[8], index[9]), 2);
  high = _mm512_insertf32x4(high, load_two_pairs(base, index[10], index[11]), 2);
  low = _mm512_insertf32x4(low, load_two_pairs(base, index[12], index[13]), 3);
  high = _mm512_insertf32x4(high, load_two_pairs(base, index[14], index[15]), 3);
  first = (VI)_mm512_shuffle_ps(low, high, 0x88);
  second = (VI)_mm512_shuffle_ps(low, high, 0xDD);
}
SHOAL_INLINE VI i_load_u8(const std::uint8_t* p) {
  return (VI)_mm512_cvtepu8_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p)));
}
SHOAL_INLINE void i_store_u8(std::uint8_t* p, const VI* v) {
  const __m512i positive = _mm512_max_epi32((__m512i)v[0], _mm512_setzero_si512());
  _mm_storeu_si128(reinterpret_cast<__m128i*>(p), _mm512_cvtusepi32_epi8(positive));
}
// Lanes 0..7 with 8..15, halved again: the first two steps of the fixed tree of reduce_min and reduce_max.
SHOAL_INLINE __m128 f_min_to_4(const VF* v) {
  const __m256 half = _mm256_min_ps(_mm512_castps512_ps256(v[0]), _mm512_extractf32x8_ps(v[0], 1));
  return _mm_min_ps(_mm256_castps256_ps128(half), _mm256_extractf128_ps(half, 1));
}
SHOAL_INLINE __m128 f_max_to_4(const VF* v) {
  const __m256 half = _mm256_max_ps(_mm512_castps512_ps256(v[0]), _mm512_extractf32x8_ps(v[0], 1));
  return _mm_max_ps(_mm256_castps256_ps128(half), _mm256_extractf128_ps(half, 1));
}
SHOAL_INLINE __m128i i_min_to_4(const VI* v) {
  const __m256i half =
      _mm256_min_epi32(_mm512_castsi512_si256((__m512i)v[0]), _mm512_extracti32x8_epi32((__m512i)v[0], 1));
  return _mm_min_epi32(_mm256_castsi256_si128(half), _mm256_extracti128_si256(half, 1));
}
SHOAL_INLINE __m128i i_max_to_4(const VI* v) {
  const __m256i half =
      _mm256_max_epi32(_mm512_castsi512_si256((__m512i)v[0]), _mm512_extracti32x8_epi32((__m512i)v[0], 1));
  return _mm_max_epi32(_mm256_castsi256_si128(half), _mm256_extracti128_si256(half, 1));
}
SHOAL_INLINE float f_reduce_min(const VF* v) { return f_min_of_4(f_min_to_4(v)); }
SHOAL_INLINE float f_reduce_max(const VF* v) { return f_max_of_4(f_max_to_4(v)); }
SHOAL_INLINE std::int32_t i_reduce_min(const VI* v) { return i_min_of_4(i_min_to_4(v)); }
SHOAL_INLINE std::int32_t i_reduce_max(const VI* v) { return i_max_of_4(i_max_to_4(v)); }

}  // namespace shoal::inline SHOAL_ISA_NS::wide_detail
