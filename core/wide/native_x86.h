// What the three x86 bodies of the wide type share.
#pragma once

#include <cstdint>
#include <cstring>

#include "core/wide/isa_select.h"

// GCC 12 sees uninitialized variables in its own AVX-512 headers once they are inlined.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <immintrin.h>
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

namespace shoal::inline SHOAL_ISA_NS::wide_detail {

// base[i], base[i + 1], base[j], base[j + 1], by two 64-bit loads.
SHOAL_INLINE __m128 load_two_pairs(const std::uint32_t* base, std::int32_t i, std::int32_t j) {
  const __m128 low = _mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(base + i)));
  return _mm_loadh_pi(low, reinterpret_cast<const __m64*>(base + j));
}

// The last two steps of the fixed tree of reduce_min and reduce_max: lanes 0, 1 with 2, 3, then 0 with 1.
SHOAL_INLINE float f_min_of_4(__m128 v) {
  const __m128 two = _mm_min_ps(v, _mm_movehl_ps(v, v));
  return _mm_cvtss_f32(_mm_min_ss(two, _mm_shuffle_ps(two, two, 0x55)));
}
SHOAL_INLINE float f_max_of_4(__m128 v) {
  const __m128 two = _mm_max_ps(v, _mm_movehl_ps(v, v));
  return _mm_cvtss_f32(_mm_max_ss(two, _mm_shuffle_ps(two, two, 0x55)));
}
SHOAL_INLINE std::int32_t i_min_of_4(__m128i v) {
  const __m128i two = _mm_min_epi32(v, _mm_shuffle_epi32(v, 0xEE));
  return _mm_cvtsi128_si32(_mm_min_epi32(two, _mm_shuffle_epi32(two, 0x55)));
}
SHOAL_INLINE std::int32_t i_max_of_4(__m128i v) {
  const __m128i two = _mm_max_epi32(v, _mm_shuffle_epi32(v, 0xEE));
  return _mm_cvtsi128_si32(_mm_max_epi32(two, _mm_shuffle_epi32(two, 0x55)));
}
// Sixteen int32s in four registers, saturated to bytes.
SHOAL_INLINE void store_u8_of_4(std::uint8_t* p, __m128i a, __m128i b, __m128i c, __m128i d) {
  _mm_storeu_si128(reinterpret_cast<__m128i*>(p), _mm_packus_epi16(_mm_packs_epi32(a, b), _mm_packs_epi32(c, d)));
}

}  // namespace shoal::inline SHOAL_ISA_NS::wide_detail
