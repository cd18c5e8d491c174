// Functions of vectors that need square roots, comparisons and selects of their lanes.
#pragma once

#include "core/vec.h"
#include "core/wide/lanes.h"

namespace shoal::inline SHOAL_ISA_NS {

// The Euclidean length: the square root of dot(a, a).
template <class F>
SHOAL_INLINE F length(Vec3<F> a) {
  return sqrt(dot(a, a));
}
// The unit vector: a times the reciprocal of its length. The zero vector stays zero.
template <class F>
SHOAL_INLINE Vec3<F> normalize(Vec3<F> a) {
  const F len = length(a);
  return a * (F(1.0f) / select(len > F(0.0f), len, F(1.0f)));
}

// a where the mask is set, b elsewhere.
template <class F>
SHOAL_INLINE Vec3<F> select(MaskOf<F> m, Vec3<F> a, Vec3<F> b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}
template <class F>
SHOAL_INLINE Vec2<F> select(MaskOf<F> m, Vec2<F> a, Vec2<F> b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y)};
}

// a at t = 0; a + (b - a), which may round away from b, at t = 1.
template <class F>
SHOAL_INLINE Vec3<F> lerp(Vec3<F> a, Vec3<F> b, F t) {
  return a + (b - a) * t;
}

// Component by component.
template <class F>
SHOAL_INLINE Vec3<F> min(Vec3<F> a, Vec3<F> b) {
  return {min(a.x, b.x), min(a.y, b.y), min(a.z, b.z)};
}
template <class F>
SHOAL_INLINE Vec3<F> max(Vec3<F> a, Vec3<F> b) {
  return {max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)};
}

// Sixteen vectors, component by component.
SHOAL_INLINE Vec3<WideF> load3(const float (&from)[3][16]) {
  return {WideF::load(from[0]), WideF::load(from[1]), WideF::load(from[2])};
}

}  // namespace shoal::inline SHOAL_ISA_NS
