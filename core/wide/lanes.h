// The vocabulary that lets one template serve one pixel (F = float) and sixteen (F = WideF).
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "core/wide/wide.h"

namespace shoal::inline SHOAL_ISA_NS {

template <class F>
struct LanesOf;
template <>
struct LanesOf<float> {
  using Int = std::int32_t;
  using Mask = bool;
  static constexpr int kCount = 1;
};
template <>
struct LanesOf<WideF> {
  using Int = WideI;
  using Mask = WideM;
  static constexpr int kCount = 16;
};
template <class F>
using IntOf = typename LanesOf<F>::Int;
template <class F>
using MaskOf = typename LanesOf<F>::Mask;

SHOAL_INLINE float select(bool m, float a, float b) { return m ? a : b; }
SHOAL_INLINE std::int32_t select(bool m, std::int32_t a, std::int32_t b) { return m ? a : b; }
SHOAL_INLINE float min(float a, float b) { return a < b ? a : b; }
SHOAL_INLINE float max(float a, float b) { return a > b ? a : b; }
SHOAL_INLINE std::int32_t min(std::int32_t a, std::int32_t b) { return a < b ? a : b; }
SHOAL_INLINE std::int32_t max(std::int32_t a, std::int32_t b) { return a > b ? a : b; }
SHOAL_INLINE float sqrt(float a) { return std::sqrt(a); }
SHOAL_INLINE float abs(float a) { return std::fabs(a); }
SHOAL_INLINE float floor(float a) { return std::floor(a); }
SHOAL_INLINE std::int32_t as_int(float a) { return std::bit_cast<std::int32_t>(a); }
SHOAL_INLINE float as_float(std::int32_t a) { return std::bit_cast<float>(a); }
SHOAL_INLINE float to_float(std::int32_t a) { return static_cast<float>(a); }
SHOAL_INLINE std::int32_t to_int_trunc(float a) { return static_cast<std::int32_t>(a); }
SHOAL_INLINE std::int32_t to_int_nearest(float a) { return static_cast<std::int32_t>(std::lrintf(a)); }
SHOAL_INLINE std::int32_t shift_right_logical(std::int32_t a, int n) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) >> n);
}
SHOAL_INLINE std::int32_t shift_left(std::int32_t a, std::int32_t n) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) << n);
}
SHOAL_INLINE float flip_sign_if(float v, bool m) { return m ? -v : v; }
SHOAL_INLINE bool any(bool m) { return m; }
SHOAL_INLINE bool all(bool m) { return m; }
SHOAL_INLINE bool none(bool m) { return !m; }

template <class F>
SHOAL_INLINE F clamp(F v, F lo, F hi) {
  return min(max(v, lo), hi);
}

}  // namespace shoal::inline SHOAL_ISA_NS
