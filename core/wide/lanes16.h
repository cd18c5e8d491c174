// Lanes of sixteen bits: the few operations that filtering of 15-bit texels needs (shading/textures/texel_filter.h).
//
// A register holds 1, 2 or 4 lanes of 128 bits, and every operation stays within them (low16 and its kin interleave the
// lower or upper halves of each): code on top is one for every register size, and sees the same numbers.
#pragma once

#include <cstdint>

#include "core/wide/wide.h"

namespace shoal::inline SHOAL_ISA_NS::lanes16 {

// add16, sub16   wrap
// mulhrs16       (a * b + 2^14) >> 15, signed; a and b not both -32768
// low16, high16, low64, high64   interleave a and b by 16 or 64 bits: the lower, the upper halves
// words<k>       32-bit words of each lane in the order k, as in x86's pshufd: all of one word, 0 0 1 1, or 2 2 3 3
// load_pairs     lane i is the sixteen bytes at base + index[4 i]
#if defined(SHOAL_ISA_AVX512)
using Reg = __m512i;
SHOAL_INLINE Reg add16(Reg a, Reg b) { return _mm512_add_epi16(a, b); }
SHOAL_INLINE Reg sub16(Reg a, Reg b) { return _mm512_sub_epi16(a, b); }
SHOAL_INLINE Reg mulhrs16(Reg a, Reg b) { return _mm512_mulhrs_epi16(a, b); }
SHOAL_INLINE Reg low16(Reg a, Reg b) { return _mm512_unpacklo_epi16(a, b); }
SHOAL_INLINE Reg high16(Reg a, Reg b) { return _mm512_unpackhi_epi16(a, b); }
SHOAL_INLINE Reg low64(Reg a, Reg b) { return _mm512_unpacklo_epi64(a, b); }
SHOAL_INLINE Reg high64(Reg a, Reg b) { return _mm512_unpackhi_epi64(a, b); }
template <int kWords>
SHOAL_INLINE Reg words(Reg a) {
  return _mm512_shuffle_epi32(a, static_cast<_MM_PERM_ENUM>(kWords));
}
SHOAL_INLINE Reg zero() { return _mm512_setzero_si512(); }
SHOAL_INLINE const __m128i* at(const std::uint64_t* p) { return reinterpret_cast<const __m128i*>(p); }
SHOAL_INLINE Reg load_pairs(const std::uint64_t* base, const std::int32_t* index) {
  const __m256i low = _mm256_inserti128_si256(_mm256_castsi128_si256(_mm_loadu_si128(at(base + index[0]))),
                                              _mm_loadu_si128(at(base + index[4])), 1);
  const __m256i high = _mm256_inserti128_si256(_mm256_castsi128_si256(_mm_loadu_si128(at(base + index[8]))),
                                               _mm_loadu_si128(at(base + index[12])), 1);
  return _mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
}
#elif defined(SHOAL_ISA_AVX2)
using Reg = __m256i;
SHOAL_INLINE Reg add16(Reg a, Reg b) { return _mm256_add_epi16(a, b); }
SHOAL_INLINE Reg sub16(Reg a, Reg b) { return _mm256_sub_epi16(a, b); }
SHOAL_INLINE Reg mulhrs16(Reg a, Reg b) { return _mm256_mulhrs_epi16(a, b); }
SHOAL_INLINE Reg low16(Reg a, Reg b) { return _mm256_unpacklo_epi16(a, b); }
SHOAL_INLINE Reg high16(Reg a, Reg b) { return _mm256_unpackhi_epi16(a, b); }
SHOAL_INLINE Reg low64(Reg a, Reg b) { return _mm256_unpacklo_epi64(a, b); }
SHOAL_INLINE Reg high64(Reg a, Reg b) { return _mm256_unpackhi_epi64(a, b); }
template <int kWords>
SHOAL_INLINE Reg words(Reg a) {
  return _mm256_shuffle_epi32(a, kWords);
}
SHOAL_INLINE Reg zero() { return _mm256_setzero_si256(); }
SHOAL_INLINE const __m128i* at(const std::uint64_t* p) { return reinterpret_cast<const __m128i*>(p); }
SHOAL_INLINE Reg load_pairs(const std::uint64_t* base, const std::int32_t* index) {
  return _mm256_inserti128_si256(_mm256_castsi128_si256(_mm_loadu_si128(at(base + index[0]))),
                                 _mm_loadu_si128(at(base + index[4])), 1);
}
#elif defined(SHOAL_ISA_SSE42)
using Reg = __m128i;
SHOAL_INLINE Reg add16(Reg a, Reg b) { return _mm_add_epi16(a, b); }
SHOAL_INLINE Reg sub16(Reg a, Reg b) { return _mm_sub_epi16(a, b); }
SHOAL_INLINE Reg mulhrs16(Reg a, Reg b) { return _mm_mulhrs_epi16(a, b); }
SHOAL_INLINE Reg low16(Reg a, Reg b) { return _mm_unpacklo_epi16(a, b); }
SHOAL_INLINE Reg high16(Reg a, Reg b) { return _mm_unpackhi_epi16(a, b); }
SHOAL_INLINE Reg low64(Reg a, Reg b) { return _mm_unpacklo_epi64(a, b); }
SHOAL_INLINE Reg high64(Reg a, Reg b) { return _mm_unpackhi_epi64(a, b); }
template <int kWords>
SHOAL_INLINE Reg words(Reg a) {
  return _mm_shuffle_epi32(a, kWords);
}
SHOAL_INLINE Reg zero() { return _mm_setzero_si128(); }
SHOAL_INLINE Reg load_pairs(const std::uint64_t* base, const std::int32_t* index) {
  return _mm_loadu_si128(reinterpret_cast<const __m128i*>(base + index[0]));
}
#elif defined(SHOAL_ISA_NEON)
using Reg = int16x8_t;
SHOAL_INLINE Reg add16(Reg a, Reg b) { return vaddq_s16(a, b); }
SHOAL_INLINE Reg sub16(Reg a, Reg b) { return vsubq_s16(a, b); }
SHOAL_INLINE Reg mulhrs16(Reg a, Reg b) { return vqrdmulhq_s16(a, b); }
SHOAL_INLINE Reg low16(Reg a, Reg b) { return vzip1q_s16(a, b); }
SHOAL_INLINE Reg high16(Reg a, Reg b) { return vzip2q_s16(a, b); }
SHOAL_INLINE Reg low64(Reg a, Reg b) {
  return vreinterpretq_s16_s64(vzip1q_s64(vreinterpretq_s64_s16(a), vreinterpretq_s64_s16(b)));
}
SHOAL_INLINE Reg high64(Reg a, Reg b) {
  return vreinterpretq_s16_s64(vzip2q_s64(vreinterpretq_s64_s16(a), vreinterpretq_s64_s16(b)));
}
template <int kWords>
SHOAL_INLINE Reg words(Reg a) {
  const int32x4_t v = vreinterpretq_s32_s16(a);
  const int32x4_t low = kWords == 0x50 ? vzip1q_s32(v, v) : vzip2q_s32(v, v);
  const int32x4_t all_of_one = vdupq_laneq_s32(v, kWords & 3);
  return vreinterpretq_s16_s32(kWords == 0x50 || kWords == 0xFA ? low : all_of_one);
}
SHOAL_INLINE Reg zero() { return vdupq_n_s16(0); }
SHOAL_INLINE Reg load_pairs(const std::uint64_t* base, const std::int32_t* index) {
  return vreinterpretq_s16_u64(vld1q_u64(base + index[0]));
}
#else
struct Reg {
  std::int16_t v[8];
};
template <class Op>
SHOAL_INLINE Reg each16(Op op) {
  Reg r;
  for (int i = 0; i < 8; ++i) r.v[i] = static_cast<std::int16_t>(op(i));
  return r;
}
SHOAL_INLINE Reg add16(Reg a, Reg b) {
  return each16([&](int i) { return a.v[i] + b.v[i]; });
}
SHOAL_INLINE Reg sub16(Reg a, Reg b) {
  return each16([&](int i) { return a.v[i] - b.v[i]; });
}
SHOAL_INLINE Reg mulhrs16(Reg a, Reg b) {
  return each16([&](int i) { return (a.v[i] * b.v[i] + 0x4000) >> 15; });
}
SHOAL_INLINE Reg low16(Reg a, Reg b) {
  return each16([&](int i) { return (i & 1 ? b : a).v[i >> 1]; });
}
SHOAL_INLINE Reg high16(Reg a, Reg b) {
  return each16([&](int i) { return (i & 1 ? b : a).v[4 + (i >> 1)]; });
}
SHOAL_INLINE Reg low64(Reg a, Reg b) {
  return each16([&](int i) { return (i & 4 ? b : a).v[i & 3]; });
}
SHOAL_INLINE Reg high64(Reg a, Reg b) {
  return each16([&](int i) { return (i & 4 ? b : a).v[4 + (i & 3)]; });
}
template <int kWords>
SHOAL_INLINE Reg words(Reg a) {
  return each16([&](int i) { return a.v[2 * (kWords >> (i & 6) & 3) + (i & 1)]; });
}
SHOAL_INLINE Reg zero() { return Reg{}; }
// Texel by texel, so that the order of bytes in memory does not matter.
SHOAL_INLINE Reg load_pairs(const std::uint64_t* base, const std::int32_t* index) {
  return each16([&](int i) { return base[index[0] + (i >> 2)] >> (16 * (i & 3)); });
}
#endif

}  // namespace shoal::inline SHOAL_ISA_NS::lanes16
