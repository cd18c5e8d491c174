// Transforms of nodes in double. Loading and writing use the same arithmetic, so that a written scene is read back bit
// for bit. The order of operations is part of the determinism contract; that of GLM's product and inverse differs.
#pragma once

#include <cmath>

#include "core/matrix.h"
#include "scene/animation.h"

namespace shoal {

// The product a * b of affine matrices. A sum that cancels to less than double's rounding of its terms becomes zero, so
// that the matrix of a child that was computed with an inverse has exact zeros again.
inline Affine product(const Affine& a, const Affine& b) {
  constexpr double kRounding = 1.0 / (1ull << 50);
  Affine out{};
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 3; ++r) {
      const double t0 = a[0][r] * b[c].x, t1 = a[1][r] * b[c].y, t2 = a[2][r] * b[c].z;
      const double t3 = c == 3 ? a[3][r] : 0.0;
      const double sum = ((t0 + t1) + t2) + t3;
      const double size = ((std::fabs(t0) + std::fabs(t1)) + std::fabs(t2)) + std::fabs(t3);
      out[c][r] = std::fabs(sum) <= size * kRounding ? 0.0 : sum;
    }
  }
  return out;
}

// The inverse, by cofactors.
//   out  receives the inverse; it is left as it is where there is none
// Returns false where the determinant is zero or not finite.
inline bool inverse(const Affine& m, Affine& out) {
  double cofactor[3][3];  // [column][row] of m
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) {
      const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
      cofactor[c][r] = m[c1][r1] * m[c2][r2] - m[c2][r1] * m[c1][r2];
    }
  }
  const double det = (m[0].x * cofactor[0][0] + m[1].x * cofactor[1][0]) + m[2].x * cofactor[2][0];
  if (!(std::fabs(det) > 0) || !std::isfinite(det)) return false;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) out[c][r] = cofactor[r][c] / det;
    out[3][r] = -((out[0][r] * m[3].x + out[1][r] * m[3].y) + out[2][r] * m[3].z);
  }
  return true;
}

// The matrix T * R * S.
//   rotation  quaternion x y z w of any length; one that is shorter than 1e-6 or not finite does not rotate
// Source: glTF 2.0 specification, 3.5.3.
inline Affine from_trs(const glm::dvec3& translation, const glm::dvec4& rotation, const glm::dvec3& scale) {
  double x = rotation.x, y = rotation.y, z = rotation.z, w = rotation.w;
  const double length = std::sqrt(((x * x + y * y) + z * z) + w * w);
  if (length > 1e-6 && std::isfinite(length)) {
    x /= length;
    y /= length;
    z /= length;
    w /= length;
  } else {
    x = y = z = 0;
    w = 1;
  }
  const glm::dvec3 x_axis{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)};
  const glm::dvec3 y_axis{2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)};
  const glm::dvec3 z_axis{2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)};
  return {x_axis * scale.x, y_axis * scale.y, z_axis * scale.z, translation};
}

inline Affine local_affine(const LocalTransform& local) {
  return local.is_matrix ? local.matrix : from_trs(local.translation, local.rotation, local.scale);
}

// The first three rows in double: exact.
inline Affine widen(const Mat4& m) { return {glm::dvec3(m[0]), glm::dvec3(m[1]), glm::dvec3(m[2]), glm::dvec3(m[3])}; }

// Each component rounded to float once; the last row is 0 0 0 1.
inline Mat4 narrow(const Affine& m) {
  return {Vec4f(Vec3f(m[0]), 0.0f), Vec4f(Vec3f(m[1]), 0.0f), Vec4f(Vec3f(m[2]), 0.0f), Vec4f(Vec3f(m[3]), 1.0f)};
}

}  // namespace shoal
