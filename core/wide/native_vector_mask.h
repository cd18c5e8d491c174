// What the bodies with vector masks share (SSE4.2, AVX2, NEON): a mask is a vector of 0 and -1, as the compiler's own
// vector comparisons give it. Included after VF, VI, VU and kParts are defined.
#pragma once

#include <cstdint>
#include <cstring>

namespace shoal::inline SHOAL_ISA_NS::wide_detail {

using VM = VI;

SHOAL_INLINE VM f_lt(VF a, VF b) { return a < b; }
SHOAL_INLINE VM f_le(VF a, VF b) { return a <= b; }
SHOAL_INLINE VM f_eq(VF a, VF b) { return a == b; }
SHOAL_INLINE VM f_ne(VF a, VF b) { return a != b; }
SHOAL_INLINE VM i_lt(VI a, VI b) { return a < b; }
SHOAL_INLINE VM i_le(VI a, VI b) { return a <= b; }
SHOAL_INLINE VM i_eq(VI a, VI b) { return a == b; }
SHOAL_INLINE VM i_ne(VI a, VI b) { return a != b; }
SHOAL_INLINE VM m_and(VM a, VM b) { return a & b; }
SHOAL_INLINE VM m_or(VM a, VM b) { return a | b; }
SHOAL_INLINE VM m_xor(VM a, VM b) { return a ^ b; }
SHOAL_INLINE VM m_not(VM a) { return ~a; }

// Sixteen lanes through memory, for what a register cannot do at a price worth paying.
struct alignas(64) Lanes {
  std::int32_t at[16];
};
SHOAL_INLINE Lanes to_lanes(const VI* v) {
  Lanes r;
  std::memcpy(r.at, v, 64);
  return r;
}
SHOAL_INLINE void from_lanes(const Lanes& lanes, VI* v) { std::memcpy(v, lanes.at, 64); }

}  // namespace shoal::inline SHOAL_ISA_NS::wide_detail
