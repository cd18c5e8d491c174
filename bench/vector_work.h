// The same vector arithmetic on GLM's vectors of lanes and on a plain struct of three lanes: docs/decisions/
// 0010-glm-vectors.md compares them.
#pragma once

#include "core/vec_lanes.h"

namespace shoal::bench::inline SHOAL_ISA_NS {

// An aggregate with the operators that the kernels use.
struct PlainVec3 {
  WideF x, y, z;
};
SHOAL_INLINE PlainVec3 operator+(PlainVec3 a, PlainVec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
SHOAL_INLINE PlainVec3 operator-(PlainVec3 a, PlainVec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
SHOAL_INLINE PlainVec3 operator*(PlainVec3 a, PlainVec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
SHOAL_INLINE PlainVec3 operator*(PlainVec3 a, WideF s) { return {a.x * s, a.y * s, a.z * s}; }

template <class V>
SHOAL_INLINE WideF dot_of(V a, V b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
template <class V>
SHOAL_INLINE V unit(V a) {
  return a * (WideF(1.0f) / sqrt(dot_of(a, a)));
}

// A view ray that is reflected and refracted at a normal, a half vector, a tangent frame and two blended colours.
//   x  varies the normal
// Returns a number that depends on all of them.
template <class V>
SHOAL_INLINE WideF vector_work(WideF x) {
  const WideF one(1.0f), eta(0.75f);
  const V normal = unit(V{x, one, x * WideF(0.5f)}), direction = unit(V{WideF(0.3f), WideF(-1.0f), x});
  const WideF cosine = max(WideF(0.0f) - dot_of(direction, normal), WideF(0.0f));
  const V reflected = direction + normal * (cosine * WideF(2.0f));
  const WideF cosine2_below = one - eta * eta * (one - cosine * cosine);
  const V refracted = direction * eta + normal * (eta * cosine - sqrt(cosine2_below));
  const V half = unit(reflected - direction);
  const V across{normal.y * half.z - normal.z * half.y, normal.z * half.x - normal.x * half.z,
                 normal.x * half.y - normal.y * half.x};
  const V local = V{one, x, one} * dot_of(across, refracted) + half * dot_of(half, refracted) + normal * cosine;
  const V sky{WideF(0.2f), WideF(0.4f), WideF(0.9f)}, ground{x * x, WideF(0.3f), WideF(0.1f)};
  const V light = (sky * (one - cosine) + ground * cosine) * V{dot_of(half, normal), one, local.y};
  return dot_of(light, local) + refracted.y;
}

}  // namespace shoal::bench::inline SHOAL_ISA_NS
