// Small vectors and a 4 x 4 matrix, templated on the lane type (float, WideF, or double in oracles).
//
// The types are plain aggregates in namespace shoal, the same in every translation unit; the functions are always
// inlined, so no ISA's copy of them can be linked into another's code.
#pragma once

#include "core/wide/isa_select.h"

namespace shoal {

template <class F>
struct Vec2 {
  F x, y;
};
template <class F>
struct Vec3 {
  F x, y, z;
};
template <class F>
struct Vec4 {
  F x, y, z, w;
};
using Vec2f = Vec2<float>;
using Vec3f = Vec3<float>;
using Vec4f = Vec4<float>;
using Vec3d = Vec3<double>;

// Row-major: m[row][column]; a point transforms as m * (x, y, z, 1).
struct Mat4 {
  float m[4][4];
};
inline constexpr Mat4 kIdentity4 = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

template <class F>
SHOAL_INLINE Vec2<F> operator+(Vec2<F> a, Vec2<F> b) {
  return {a.x + b.x, a.y + b.y};
}
template <class F>
SHOAL_INLINE Vec2<F> operator-(Vec2<F> a, Vec2<F> b) {
  return {a.x - b.x, a.y - b.y};
}
template <class F>
SHOAL_INLINE Vec2<F> operator*(Vec2<F> a, F s) {
  return {a.x * s, a.y * s};
}

template <class F>
SHOAL_INLINE Vec3<F> operator+(Vec3<F> a, Vec3<F> b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class F>
SHOAL_INLINE Vec3<F> operator-(Vec3<F> a, Vec3<F> b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class F>
SHOAL_INLINE Vec3<F> operator-(Vec3<F> a) {
  return {-a.x, -a.y, -a.z};
}
// Component by component (colours).
template <class F>
SHOAL_INLINE Vec3<F> operator*(Vec3<F> a, Vec3<F> b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <class F>
SHOAL_INLINE Vec3<F> operator*(Vec3<F> a, F s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class F>
SHOAL_INLINE Vec3<F> operator*(F s, Vec3<F> a) {
  return a * s;
}
template <class F>
SHOAL_INLINE Vec3<F> operator/(Vec3<F> a, F s) {
  return {a.x / s, a.y / s, a.z / s};
}
// The fixed order of these sums is part of the contract.
template <class F>
SHOAL_INLINE F dot(Vec3<F> a, Vec3<F> b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
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

template <class F>
SHOAL_INLINE Vec3<F> transform_point(const Mat4& t, Vec3<F> p) {
  return {((F(t.m[0][0]) * p.x + F(t.m[0][1]) * p.y) + F(t.m[0][2]) * p.z) + F(t.m[0][3]),
          ((F(t.m[1][0]) * p.x + F(t.m[1][1]) * p.y) + F(t.m[1][2]) * p.z) + F(t.m[1][3]),
          ((F(t.m[2][0]) * p.x + F(t.m[2][1]) * p.y) + F(t.m[2][2]) * p.z) + F(t.m[2][3])};
}
template <class F>
SHOAL_INLINE Vec3<F> transform_direction(const Mat4& t, Vec3<F> p) {
  return {(F(t.m[0][0]) * p.x + F(t.m[0][1]) * p.y) + F(t.m[0][2]) * p.z,
          (F(t.m[1][0]) * p.x + F(t.m[1][1]) * p.y) + F(t.m[1][2]) * p.z,
          (F(t.m[2][0]) * p.x + F(t.m[2][1]) * p.y) + F(t.m[2][2]) * p.z};
}

}  // namespace shoal
