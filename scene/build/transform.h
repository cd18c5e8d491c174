// Node transforms in double, the same arithmetic for loading and for writing: a written scene comes back bit for bit.
#pragma once

#include <cmath>

#include "core/vec.h"
#include "scene/animation.h"

namespace shoal {

struct Affine {
  double m[3][4];  // row-major; the last row is 0 0 0 1
};
inline constexpr Affine kAffineIdentity = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

// a * b. A sum that cancels to less than double's own rounding of its terms is zero: so a child's matrix that was
// computed by an inverse gives exact zeros again.
inline Affine product(const Affine& a, const Affine& b) {
  constexpr double kRounding = 1.0 / (1ull << 50);
  Affine out{};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) {
      const double t0 = a.m[r][0] * b.m[0][c], t1 = a.m[r][1] * b.m[1][c], t2 = a.m[r][2] * b.m[2][c];
      const double t3 = c == 3 ? a.m[r][3] : 0.0;
      const double sum = ((t0 + t1) + t2) + t3;
      const double size = ((std::fabs(t0) + std::fabs(t1)) + std::fabs(t2)) + std::fabs(t3);
      out.m[r][c] = std::fabs(sum) <= size * kRounding ? 0.0 : sum;
    }
  }
  return out;
}

// False where there is none.
inline bool inverse(const Affine& a, Affine& out) {
  const auto& m = a.m;
  double cofactor[3][3];
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
      cofactor[r][c] = m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
    }
  }
  const double det = (m[0][0] * cofactor[0][0] + m[0][1] * cofactor[0][1]) + m[0][2] * cofactor[0][2];
  if (!(std::fabs(det) > 0) || !std::isfinite(det)) return false;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) out.m[r][c] = cofactor[c][r] / det;
    out.m[r][3] = -((out.m[r][0] * m[0][3] + out.m[r][1] * m[1][3]) + out.m[r][2] * m[2][3]);
  }
  return true;
}

// T * R * S. Source: glTF 2.0 specification, 3.5.3.
//   rotation  a quaternion x y z w, normalised here; one without length turns nothing
inline Affine from_trs(const double (&translation)[3], const double (&rotation)[4], const double (&scale)[3]) {
  double x = rotation[0], y = rotation[1], z = rotation[2], w = rotation[3];
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
  const double turned[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                               {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                               {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
  Affine out{};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) out.m[r][c] = turned[r][c] * scale[c];
    out.m[r][3] = translation[r];
  }
  return out;
}

inline Affine local_affine(const LocalTransform& local) {
  if (!local.is_matrix) return from_trs(local.translation, local.rotation, local.scale);
  Affine out{};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) out.m[r][c] = local.matrix[r][c];
  }
  return out;
}

inline Affine widen(const Mat4& t) {
  Affine out{};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) out.m[r][c] = static_cast<double>(t.m[r][c]);
  }
  return out;
}

inline Mat4 narrow(const Affine& a) {
  Mat4 out = kIdentity4;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) out.m[r][c] = static_cast<float>(a.m[r][c]);
  }
  return out;
}

}  // namespace shoal
