// The wide type on native vectors: a struct of kParts registers (1 zmm, 2 ymm, 4 xmm or 4 NEON), every operator
// unrolled by hand, for a loop over the parts stays rolled in GCC at -O2 (docs/PERFORMANCE.md).
//
// The primitives (wide_detail::f_*, i_*, m_*) are the native_*.h file's; + - * / & | ^ << >> are the compiler's own
// vector operators. What each function does is written in core/wide/wide_scalar.h, the reference body.
#pragma once

#include <cstdint>

#include "core/wide/isa_select.h"

namespace shoal::inline SHOAL_ISA_NS {

struct WideM {
  wide_detail::VM part[wide_detail::kParts];
};

namespace wide_detail {
template <class R, class A, class Op>
SHOAL_INLINE R each(const A& a, Op op) {
  R r;
  r.part[0] = op(a.part[0]);
  if constexpr (kParts > 1) r.part[1] = op(a.part[1]);
  if constexpr (kParts > 2) {
    r.part[2] = op(a.part[2]);
    r.part[3] = op(a.part[3]);
  }
  return r;
}
template <class R, class A, class B, class Op>
SHOAL_INLINE R each(const A& a, const B& b, Op op) {
  R r;
  r.part[0] = op(a.part[0], b.part[0]);
  if constexpr (kParts > 1) r.part[1] = op(a.part[1], b.part[1]);
  if constexpr (kParts > 2) {
    r.part[2] = op(a.part[2], b.part[2]);
    r.part[3] = op(a.part[3], b.part[3]);
  }
  return r;
}
template <class R, class A, class B, class C, class Op>
SHOAL_INLINE R each(const A& a, const B& b, const C& c, Op op) {
  R r;
  r.part[0] = op(a.part[0], b.part[0], c.part[0]);
  if constexpr (kParts > 1) r.part[1] = op(a.part[1], b.part[1], c.part[1]);
  if constexpr (kParts > 2) {
    r.part[2] = op(a.part[2], b.part[2], c.part[2]);
    r.part[3] = op(a.part[3], b.part[3], c.part[3]);
  }
  return r;
}
// r.part[k] = op(k * lanes of a part), for loads and the like.
template <class R, class Op>
SHOAL_INLINE R each_offset(Op op) {
  constexpr int kLanes = 16 / kParts;
  R r;
  r.part[0] = op(0);
  if constexpr (kParts > 1) r.part[1] = op(kLanes);
  if constexpr (kParts > 2) {
    r.part[2] = op(2 * kLanes);
    r.part[3] = op(3 * kLanes);
  }
  return r;
}
template <class A, class Op>
SHOAL_INLINE void store_each(const A& a, Op op) {
  constexpr int kLanes = 16 / kParts;
  op(a.part[0], 0);
  if constexpr (kParts > 1) op(a.part[1], kLanes);
  if constexpr (kParts > 2) {
    op(a.part[2], 2 * kLanes);
    op(a.part[3], 3 * kLanes);
  }
}
}  // namespace wide_detail

struct alignas(64) WideF {
  wide_detail::VF part[wide_detail::kParts];
  WideF() = default;
  SHOAL_INLINE WideF(float s) {  // NOLINT: broadcast is implicit on purpose
    *this = wide_detail::each_offset<WideF>([s](int) SHOAL_LAMBDA { return wide_detail::f_set1(s); });
  }
  static SHOAL_INLINE WideF load(const float* p) {
    return wide_detail::each_offset<WideF>([p](int i) SHOAL_LAMBDA { return wide_detail::f_load(p + i); });
  }
  SHOAL_INLINE void store(float* p) const {
    wide_detail::store_each(*this, [p](wide_detail::VF v, int i) SHOAL_LAMBDA { wide_detail::f_store(p + i, v); });
  }
};

struct alignas(64) WideI {
  wide_detail::VI part[wide_detail::kParts];
  WideI() = default;
  SHOAL_INLINE WideI(std::int32_t s) {  // NOLINT: broadcast is implicit on purpose
    *this = wide_detail::each_offset<WideI>([s](int) SHOAL_LAMBDA { return wide_detail::i_set1(s); });
  }
  static SHOAL_INLINE WideI load(const std::int32_t* p) {
    return wide_detail::each_offset<WideI>([p](int i) SHOAL_LAMBDA { return wide_detail::i_load(p + i); });
  }
  SHOAL_INLINE void store(std::int32_t* p) const {
    wide_detail::store_each(*this, [p](wide_detail::VI v, int i) SHOAL_LAMBDA { wide_detail::i_store(p + i, v); });
  }
};

#define SHOAL_WIDE_UNARY(R, NAME, A, T, EXPR)                 \
  SHOAL_INLINE R NAME(A a) {                                  \
    using namespace wide_detail;                              \
    return each<R>(a, [](T x) SHOAL_LAMBDA { return EXPR; }); \
  }
#define SHOAL_WIDE_BINARY(R, NAME, A, T, EXPR)                        \
  SHOAL_INLINE R NAME(A a, A b) {                                     \
    using namespace wide_detail;                                      \
    return each<R>(a, b, [](T x, T y) SHOAL_LAMBDA { return EXPR; }); \
  }

SHOAL_WIDE_BINARY(WideF, operator+, WideF, VF, x + y)
SHOAL_WIDE_BINARY(WideF, operator-, WideF, VF, x - y)
SHOAL_WIDE_BINARY(WideF, operator*, WideF, VF, x* y)
SHOAL_WIDE_BINARY(WideF, operator/, WideF, VF, x / y)
SHOAL_WIDE_UNARY(WideF, operator-, WideF, VF, (VF)((VI)x ^ i_set1(INT32_MIN)))
SHOAL_WIDE_BINARY(WideM, operator<, WideF, VF, f_lt(x, y))
SHOAL_WIDE_BINARY(WideM, operator<=, WideF, VF, f_le(x, y))
SHOAL_WIDE_BINARY(WideM, operator==, WideF, VF, f_eq(x, y))
SHOAL_WIDE_BINARY(WideM, operator!=, WideF, VF, f_ne(x, y))
SHOAL_INLINE WideM operator>(WideF a, WideF b) { return b < a; }
SHOAL_INLINE WideM operator>=(WideF a, WideF b) { return b <= a; }

// Unsigned, so that wrapping is defined whatever the flags.
SHOAL_WIDE_BINARY(WideI, operator+, WideI, VI, (VI)((VU)x + (VU)y))
SHOAL_WIDE_BINARY(WideI, operator-, WideI, VI, (VI)((VU)x - (VU)y))
SHOAL_WIDE_BINARY(WideI, operator*, WideI, VI, (VI)((VU)x*(VU)y))
SHOAL_WIDE_BINARY(WideI, operator&, WideI, VI, x& y)
SHOAL_WIDE_BINARY(WideI, operator|, WideI, VI, x | y)
SHOAL_WIDE_BINARY(WideI, operator^, WideI, VI, x ^ y)
SHOAL_INLINE WideI operator-(WideI a) { return WideI(0) - a; }
SHOAL_INLINE WideI operator~(WideI a) { return a ^ WideI(-1); }
SHOAL_INLINE WideI operator<<(WideI a, int n) {
  using namespace wide_detail;
  return each<WideI>(a, [n](VI x) SHOAL_LAMBDA { return (VI)((VU)x << static_cast<std::uint32_t>(n)); });
}
SHOAL_INLINE WideI operator>>(WideI a, int n) {
  using namespace wide_detail;
  return each<WideI>(a, [n](VI x) SHOAL_LAMBDA { return x >> n; });
}
SHOAL_INLINE WideI shift_right_logical(WideI a, int n) {
  using namespace wide_detail;
  return each<WideI>(a, [n](VI x) SHOAL_LAMBDA { return (VI)((VU)x >> static_cast<std::uint32_t>(n)); });
}
SHOAL_WIDE_BINARY(WideI, shift_left, WideI, VI, i_shl(x, y))
SHOAL_WIDE_BINARY(WideI, shift_right_logical, WideI, VI, i_shr(x, y))
SHOAL_WIDE_BINARY(WideM, operator<, WideI, VI, i_lt(x, y))
SHOAL_WIDE_BINARY(WideM, operator<=, WideI, VI, i_le(x, y))
SHOAL_WIDE_BINARY(WideM, operator==, WideI, VI, i_eq(x, y))
SHOAL_WIDE_BINARY(WideM, operator!=, WideI, VI, i_ne(x, y))
SHOAL_INLINE WideM operator>(WideI a, WideI b) { return b < a; }
SHOAL_INLINE WideM operator>=(WideI a, WideI b) { return b <= a; }

SHOAL_WIDE_BINARY(WideM, operator&, WideM, VM, m_and(x, y))
SHOAL_WIDE_BINARY(WideM, operator|, WideM, VM, m_or(x, y))
SHOAL_WIDE_BINARY(WideM, operator^, WideM, VM, m_xor(x, y))
SHOAL_WIDE_UNARY(WideM, operator!, WideM, VM, m_not(x))
SHOAL_INLINE std::uint32_t to_bits(WideM m) {
  using namespace wide_detail;
  constexpr int kLanes = 16 / kParts;
  std::uint32_t bits = m_bits(m.part[0]);
  if constexpr (kParts > 1) bits |= m_bits(m.part[1]) << kLanes;
  if constexpr (kParts > 2) bits |= m_bits(m.part[2]) << (2 * kLanes) | m_bits(m.part[3]) << (3 * kLanes);
  return bits;
}
SHOAL_INLINE WideM mask_from_bits(std::uint32_t bits) {
  return wide_detail::each_offset<WideM>([bits](int i) SHOAL_LAMBDA { return wide_detail::m_from_bits(bits >> i); });
}
SHOAL_INLINE bool any(WideM m) { return to_bits(m) != 0; }
SHOAL_INLINE bool all(WideM m) { return to_bits(m) == 0xFFFFu; }
SHOAL_INLINE bool none(WideM m) { return to_bits(m) == 0; }

SHOAL_INLINE WideF select(WideM m, WideF a, WideF b) {
  using namespace wide_detail;
  return each<WideF>(m, a, b, [](VM k, VF x, VF y) SHOAL_LAMBDA { return f_select(k, x, y); });
}
SHOAL_INLINE WideI select(WideM m, WideI a, WideI b) {
  using namespace wide_detail;
  return each<WideI>(m, a, b, [](VM k, VI x, VI y) SHOAL_LAMBDA { return i_select(k, x, y); });
}
SHOAL_WIDE_BINARY(WideF, min, WideF, VF, f_min(x, y))
SHOAL_WIDE_BINARY(WideF, max, WideF, VF, f_max(x, y))
SHOAL_WIDE_BINARY(WideI, min, WideI, VI, i_min(x, y))
SHOAL_WIDE_BINARY(WideI, max, WideI, VI, i_max(x, y))
SHOAL_WIDE_UNARY(WideF, sqrt, WideF, VF, f_sqrt(x))
SHOAL_WIDE_UNARY(WideF, abs, WideF, VF, (VF)((VI)x& i_set1(INT32_MAX)))
SHOAL_WIDE_UNARY(WideF, floor, WideF, VF, f_floor(x))
SHOAL_INLINE WideI abs(WideI a) { return max(a, -a); }

SHOAL_WIDE_UNARY(WideI, as_int, WideF, VF, (VI)x)
SHOAL_WIDE_UNARY(WideF, as_float, WideI, VI, (VF)x)
SHOAL_WIDE_UNARY(WideF, to_float, WideI, VI, f_from_i(x))
SHOAL_WIDE_UNARY(WideI, to_int_trunc, WideF, VF, i_trunc(x))
SHOAL_WIDE_UNARY(WideI, to_int_nearest, WideF, VF, i_nearest(x))
SHOAL_INLINE WideF flip_sign_if(WideF v, WideM m) {
  return as_float(as_int(v) ^ select(m, WideI(INT32_MIN), WideI(0)));
}

SHOAL_INLINE WideF permute(WideF v, WideI index) {
  WideF r;
  wide_detail::f_permute(v.part, index.part, r.part);
  return r;
}
SHOAL_INLINE WideI permute(WideI v, WideI index) { return as_int(permute(as_float(v), index)); }
SHOAL_INLINE WideI compress(WideI v, WideM m) {
  WideI r;
  wide_detail::i_compress(v.part, m.part, r.part);
  return r;
}
SHOAL_INLINE WideF compress(WideF v, WideM m) { return as_float(compress(as_int(v), m)); }

SHOAL_INLINE WideI gather(const std::int32_t* base, WideI index) {
  using namespace wide_detail;
  return each<WideI>(index, [base](VI i) SHOAL_LAMBDA { return i_gather(base, i); });
}
SHOAL_INLINE WideI gather(const std::int32_t* base, WideI index, WideM m, WideI other) {
  using namespace wide_detail;
  return each<WideI>(index, m, other, [base](VI i, VM k, VI o) SHOAL_LAMBDA { return i_gather(base, i, k, o); });
}
SHOAL_INLINE WideF gather(const float* base, WideI index) {
  using namespace wide_detail;
  return each<WideF>(index, [base](VI i) SHOAL_LAMBDA { return f_gather(base, i); });
}
SHOAL_INLINE WideF gather(const float* base, WideI index, WideM m, WideF other) {
  using namespace wide_detail;
  return each<WideF>(index, m, other, [base](VI i, VM k, VF o) SHOAL_LAMBDA { return f_gather(base, i, k, o); });
}
SHOAL_INLINE void load_texel_pairs(const std::uint32_t* base, WideI index, WideI& first, WideI& second) {
  using namespace wide_detail;
  constexpr int kLanes = 16 / kParts;
  alignas(64) std::int32_t at[16];
  index.store(at);
  i_load_pairs(base, at, first.part[0], second.part[0]);
  if constexpr (kParts > 1) i_load_pairs(base, at + kLanes, first.part[1], second.part[1]);
  if constexpr (kParts > 2) {
    i_load_pairs(base, at + 2 * kLanes, first.part[2], second.part[2]);
    i_load_pairs(base, at + 3 * kLanes, first.part[3], second.part[3]);
  }
}
SHOAL_INLINE WideI load_u8(const std::uint8_t* p) {
  return wide_detail::each_offset<WideI>([p](int i) SHOAL_LAMBDA { return wide_detail::i_load_u8(p + i); });
}
SHOAL_INLINE void store_u8(std::uint8_t* p, WideI v) { wide_detail::i_store_u8(p, v.part); }
SHOAL_INLINE void store_masked(float* p, WideF v, WideM m) {
#if defined(SHOAL_ISA_AVX512)
  wide_detail::f_store_masked(p, v.part[0], m.part[0]);
#else
  select(m, v, WideF::load(p)).store(p);
#endif
}
SHOAL_INLINE void store_masked(std::int32_t* p, WideI v, WideM m) {
#if defined(SHOAL_ISA_AVX512)
  wide_detail::i_store_masked(p, v.part[0], m.part[0]);
#else
  select(m, v, WideI::load(p)).store(p);
#endif
}

SHOAL_INLINE float reduce_min(WideF v) { return wide_detail::f_reduce_min(v.part); }
SHOAL_INLINE float reduce_max(WideF v) { return wide_detail::f_reduce_max(v.part); }
SHOAL_INLINE std::int32_t reduce_min(WideI v) { return wide_detail::i_reduce_min(v.part); }
SHOAL_INLINE std::int32_t reduce_max(WideI v) { return wide_detail::i_reduce_max(v.part); }
SHOAL_INLINE WideI lane_index() {
  alignas(64) static constexpr std::int32_t kIndex[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  return WideI::load(kIndex);
}
SHOAL_INLINE float extract(WideF v, int i) {
  alignas(64) float lane[16];
  v.store(lane);
  return lane[i];
}
SHOAL_INLINE std::int32_t extract(WideI v, int i) {
  alignas(64) std::int32_t lane[16];
  v.store(lane);
  return lane[i];
}

#undef SHOAL_WIDE_UNARY
#undef SHOAL_WIDE_BINARY

}  // namespace shoal::inline SHOAL_ISA_NS
