// Small vectors, templated on the lane type: float, WideF, or double in oracles.
//
// The types are GLM's, for one number and for lanes alike (docs/decisions/0010-glm-vectors.md). The sums, differences,
// products and quotients of components are GLM's operators; every other function whose bits reach a pixel is written
// here or in core/vec_lanes.h, in an order of operations that is part of the determinism contract. The operations of
// GLM that may be used are those of tests/core/test_glm.cpp. This header and core/matrix.h alone include GLM.
#pragma once

#include "core/wide/isa_select.h"

// In code for one instruction set GLM's operators are always inlined, as SHOAL_INLINE functions are.
#if !defined(SHOAL_ISA_SCALAR) && !defined(GLM_FORCE_INLINE)
#define GLM_FORCE_INLINE
#endif
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace shoal {

template <class F>
using Vec2 = glm::vec<2, F, glm::defaultp>;
template <class F>
using Vec3 = glm::vec<3, F, glm::defaultp>;
template <class F>
using Vec4 = glm::vec<4, F, glm::defaultp>;
using Vec2f = glm::vec2;
using Vec3f = glm::vec3;
using Vec4f = glm::vec4;
using Vec3d = glm::dvec3;

// The dot product. It is summed in the order x, y, z.
template <class F>
SHOAL_INLINE F dot(Vec3<F> a, Vec3<F> b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

// The cross product.
template <class F>
SHOAL_INLINE Vec3<F> cross(Vec3<F> a, Vec3<F> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// A scalar vector in every lane.
template <class F>
SHOAL_INLINE Vec3<F> broadcast(Vec3f v) {
  return {F(v.x), F(v.y), F(v.z)};
}
template <class F>
SHOAL_INLINE Vec2<F> broadcast(Vec2f v) {
  return {F(v.x), F(v.y)};
}

// GLM has a dot product of other lengths, which adds in its own order: a call of it by our name does not compile.
template <class F>
void dot(Vec2<F> a, Vec2<F> b) = delete;
template <class F>
void dot(Vec4<F> a, Vec4<F> b) = delete;

}  // namespace shoal
