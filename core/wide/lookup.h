// Look-ups in a table of 64 words: a meshlet's vertices.
#pragma once

#include <cstdint>

#include "core/wide/wide.h"

namespace shoal::inline SHOAL_ISA_NS {

#if defined(SHOAL_ISA_AVX512)
// Two permutes of two registers and a blend, about a tenth of a gather (notes of docs/PERFORMANCE.md).
SHOAL_INLINE WideI lookup64(const std::int32_t* table, WideI index) {
  const __m512i i = (__m512i)index.part[0];
  const __m512i low = _mm512_permutex2var_epi32(_mm512_loadu_si512(table), i, _mm512_loadu_si512(table + 16));
  const __m512i high = _mm512_permutex2var_epi32(_mm512_loadu_si512(table + 32), i, _mm512_loadu_si512(table + 48));
  const __mmask16 upper = _mm512_test_epi32_mask(i, _mm512_set1_epi32(32));
  WideI r;
  r.part[0] = (wide_detail::VI)_mm512_mask_blend_epi32(upper, low, high);
  return r;
}
SHOAL_INLINE WideF lookup64(const float* table, WideI index) {
  return as_float(lookup64(reinterpret_cast<const std::int32_t*>(table), index));
}
#else
SHOAL_INLINE WideI lookup64(const std::int32_t* table, WideI index) { return gather(table, index); }
SHOAL_INLINE WideF lookup64(const float* table, WideI index) { return gather(table, index); }
#endif

}  // namespace shoal::inline SHOAL_ISA_NS
