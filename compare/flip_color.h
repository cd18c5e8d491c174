// Colour spaces and constants of FLIP, computed at compile time.
#pragma once

#include "shading/srgb.h"

namespace shoal {

struct Matrix3 {
  float m[3][3];
};

namespace flip_detail {

struct Matrix3d {
  double m[3][3];
};

constexpr Matrix3d inverse(const Matrix3d& a) {
  const auto& m = a.m;
  Matrix3d r{};
  const double determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                             m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                             m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const int a0 = (j + 1) % 3, a1 = (j + 2) % 3, b0 = (i + 1) % 3, b1 = (i + 2) % 3;
      r.m[i][j] = (m[a0][b0] * m[a1][b1] - m[a0][b1] * m[a1][b0]) / determinant;
    }
  }
  return r;
}

// Linear BT.709 to XYZ over the white's XYZ, so that white is (1, 1, 1): the columns of the primaries' XYZ, each scaled
// so that they sum to the white's.
constexpr Matrix3d make_white_xyz_from_rgb() {
  constexpr double kX[4] = {0.64, 0.30, 0.15, 0.31271}, kY[4] = {0.33, 0.60, 0.06, 0.32902};  // R, G, B, D65
  Matrix3d xyz{};
  double white[3] = {};
  for (int c = 0; c < 4; ++c) {
    const double column[3] = {kX[c] / kY[c], 1.0, (1.0 - kX[c] - kY[c]) / kY[c]};
    for (int i = 0; i < 3; ++i) {
      if (c < 3) {
        xyz.m[i][c] = column[i];
      } else {
        white[i] = column[i];
      }
    }
  }
  const Matrix3d back = inverse(xyz);
  Matrix3d r{};
  for (int c = 0; c < 3; ++c) {
    const double scale = back.m[c][0] * white[0] + back.m[c][1] * white[1] + back.m[c][2] * white[2];
    for (int i = 0; i < 3; ++i) r.m[i][c] = xyz.m[i][c] * scale / white[i];
  }
  return r;
}

constexpr Matrix3 rounded(const Matrix3d& a) {
  Matrix3 r{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r.m[i][j] = static_cast<float>(a.m[i][j]);
  return r;
}

// Newton; x > 0.
constexpr double root(double x, int n) {
  double y = 1.0;
  for (int i = 0; i < 200; ++i) {
    double power = 1.0;
    for (int k = 1; k < n; ++k) power *= y;
    y += (x / power - y) / n;
  }
  return y;
}

struct Lab {
  double l, a, b;
};
// A primary as Hunt-adjusted CIELAB; none of its XYZ is near black.
constexpr Lab hunt_lab_of_primary(int c) {
  const Matrix3d m = make_white_xyz_from_rgb();
  double f[3] = {};
  for (int i = 0; i < 3; ++i) f[i] = root(m.m[i][c], 3);
  const double l = 116.0 * f[1] - 16.0;
  return {l, 0.01 * l * 500.0 * (f[0] - f[1]), 0.01 * l * 200.0 * (f[1] - f[2])};
}
constexpr double make_largest_color_error() {
  const Lab g = hunt_lab_of_primary(1), b = hunt_lab_of_primary(2);
  const double da = g.a - b.a, db = g.b - b.b, dl = g.l > b.l ? g.l - b.l : b.l - g.l;
  const double hyab = dl + root(da * da + db * db, 2);
  const double tenth = root(hyab, 10);
  double power = 1.0;
  for (int i = 0; i < 7; ++i) power *= tenth;
  return power;
}

}  // namespace flip_detail

inline constexpr Matrix3 kWhiteXyzFromRgb = flip_detail::rounded(flip_detail::make_white_xyz_from_rgb());
inline constexpr Matrix3 kRgbFromWhiteXyz =
    flip_detail::rounded(flip_detail::inverse(flip_detail::make_white_xyz_from_rgb()));

// Section 4.1.3 of Andersson et al. 2020: q_c, p_c, p_t, and the error between green and blue, the largest one.
inline constexpr float kColorExponent = 0.7f;
inline constexpr float kColorKnee = 0.4f, kColorKneeError = 0.95f;
inline constexpr float kLargestColorError = static_cast<float>(flip_detail::make_largest_color_error());

// (k0 x^2 + k1 x + k2) / (k3 x^2 + k4 x + k5): Narkowicz 2016, with x scaled by 0.6.
inline constexpr float kAces[6] = {0.36f * 2.51f, 0.6f * 0.03f, 0.0f, 0.36f * 2.43f, 0.6f * 0.59f, 0.14f};

}  // namespace shoal
