// Matrices of host-side code: places of nodes, of joints and of what stands on them. GLM's types, column-major:
// m[column] is a column vector, and a point transforms as m * (x, y, z, 1).
//
// GLM's own matrix product and inverse add in another order than the functions here and in scene/build/transform.h, so
// they would change pixels (tests/core/test_glm.cpp): a call of them in namespace shoal does not compile.
#pragma once

#include "core/vec.h"

#include <glm/mat4x3.hpp>
#include <glm/mat4x4.hpp>

namespace shoal {

using Mat4 = glm::mat4;       // world_from_local, joint_from_mesh
using Affine = glm::dmat4x3;  // the same in double, without the last row, which is 0 0 0 1

inline constexpr Mat4 kIdentity4{1.0f};
inline constexpr Affine kAffineIdentity{1.0};

// The affine matrix that is written row by row, as on paper.
//   x_row, y_row, z_row  its first three rows; the fourth is 0 0 0 1
constexpr Mat4 from_rows(Vec4f x_row, Vec4f y_row, Vec4f z_row) {
  return {x_row.x, y_row.x, z_row.x, 0.0f, x_row.y, y_row.y, z_row.y, 0.0f,
          x_row.z, y_row.z, z_row.z, 0.0f, x_row.w, y_row.w, z_row.w, 1.0f};
}

// The matrix that moves a point by `offset`.
inline Mat4 translation(Vec3f offset) {
  return from_rows({1, 0, 0, offset.x}, {0, 1, 0, offset.y}, {0, 0, 1, offset.z});
}

// A point under an affine matrix. Each component is summed in the order x, y, z, offset.
inline Vec3f transform_point(const Mat4& m, Vec3f p) {
  return {((m[0].x * p.x + m[1].x * p.y) + m[2].x * p.z) + m[3].x,
          ((m[0].y * p.x + m[1].y * p.y) + m[2].y * p.z) + m[3].y,
          ((m[0].z * p.x + m[1].z * p.y) + m[2].z * p.z) + m[3].z};
}

// A direction under an affine matrix: its offset does not count.
inline Vec3f transform_direction(const Mat4& m, Vec3f d) {
  return {(m[0].x * d.x + m[1].x * d.y) + m[2].x * d.z, (m[0].y * d.x + m[1].y * d.y) + m[2].y * d.z,
          (m[0].z * d.x + m[1].z * d.y) + m[2].z * d.z};
}

Mat4 operator*(const Mat4&, const Mat4&) = delete;
Vec4f operator*(const Mat4&, const Vec4f&) = delete;
Mat4 inverse(const Mat4&) = delete;

}  // namespace shoal
