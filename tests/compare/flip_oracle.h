// FLIP written down from the papers' formulas, slow and in double precision: filters in two dimensions as they are
// defined, libm's powers, the white of IEC 61966-2-1's printed matrix.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "compare/flip.h"

namespace shoal::test {

using Triple = std::array<double, 3>;

inline Triple oracle_xyz(Triple c) {
  return {(0.4124 * c[0] + 0.3576 * c[1] + 0.1805 * c[2]) / 0.9505, 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2],
          (0.0193 * c[0] + 0.1192 * c[1] + 0.9505 * c[2]) / 1.0890};
}

// The inverse of oracle_xyz, by Cramer's rule.
inline Triple oracle_rgb(Triple t) {
  double m[3][3], r[3];
  for (int c = 0; c < 3; ++c) {
    Triple unit{0, 0, 0};
    unit[static_cast<std::size_t>(c)] = 1;
    const Triple column = oracle_xyz(unit);
    for (int i = 0; i < 3; ++i) m[i][c] = column[static_cast<std::size_t>(i)];
  }
  const auto det = [](double a[3][3]) {
    return a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) - a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
           a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
  };
  for (int c = 0; c < 3; ++c) {
    double n[3][3];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) n[i][j] = j == c ? t[static_cast<std::size_t>(i)] : m[i][j];
    r[c] = det(n) / det(m);
  }
  return {r[0], r[1], r[2]};
}

inline Triple oracle_hunt_lab(Triple rgb) {
  Triple f = oracle_xyz(rgb);
  for (double& v : f) v = v > std::pow(6.0 / 29, 3) ? std::cbrt(v) : v / (3 * std::pow(6.0 / 29, 2)) + 4.0 / 29;
  const double l = 116 * f[1] - 16;
  return {l, 0.01 * l * 500 * (f[0] - f[1]), 0.01 * l * 200 * (f[1] - f[2])};
}

inline double oracle_color_error(Triple a, Triple b) {
  const auto power = [](Triple p, Triple q) {
    const Triple x = oracle_hunt_lab(p), y = oracle_hunt_lab(q);
    return std::pow(std::fabs(x[0] - y[0]) + std::hypot(x[1] - y[1], x[2] - y[2]), 0.7);
  };
  const double most = power({0, 1, 0}, {0, 0, 1}), p = power(a, b);
  return p < 0.4 * most ? 0.95 / (0.4 * most) * p : 0.95 + (p - 0.4 * most) / (most - 0.4 * most) * 0.05;
}

// A picture's plane, and a filter of two dimensions over it with the edge going on.
struct OraclePlane {
  int width, height;
  std::vector<double> at;
  double clamped(int x, int y) const {
    x = std::clamp(x, 0, width - 1);
    y = std::clamp(y, 0, height - 1);
    return at[static_cast<std::size_t>(y * width + x)];
  }
};
template <class Weight>
std::vector<double> oracle_filter(const OraclePlane& plane, int radius, Weight weight, bool balance) {
  std::vector<double> w;
  double positive = 0, negative = 0;
  for (int y = -radius; y <= radius; ++y) {
    for (int x = -radius; x <= radius; ++x) {
      w.push_back(weight(static_cast<double>(x), static_cast<double>(y)));
      (w.back() > 0 ? positive : negative) += w.back();
    }
  }
  for (double& v : w) v /= v > 0 || !balance ? positive : -negative;
  std::vector<double> out;
  for (int y = 0; y < plane.height; ++y) {
    for (int x = 0; x < plane.width; ++x) {
      double sum = 0;
      std::size_t i = 0;
      for (int v = -radius; v <= radius; ++v)
        for (int u = -radius; u <= radius; ++u) sum += w[i++] * plane.clamped(x + u, y + v);
      out.push_back(sum);
    }
  }
  return out;
}

struct OracleSeen {
  std::vector<Triple> color;
  std::vector<double> edge, point;
};

inline OracleSeen oracle_seen(const LinearPicture& picture, double ppd) {
  OraclePlane plane[4];
  for (OraclePlane& p : plane) p.width = picture.width_px, p.height = picture.height_px;
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3) {
    Triple c;
    for (std::size_t k = 0; k < 3; ++k) c[k] = std::clamp(static_cast<double>(picture.rgb[i + k]), 0.0, 1.0);
    const Triple t = oracle_xyz(c);
    plane[0].at.push_back(116 * t[1] - 16);
    plane[1].at.push_back(500 * (t[0] - t[1]));
    plane[2].at.push_back(200 * (t[1] - t[2]));
    plane[3].at.push_back(t[1]);
  }
  const double pi = std::acos(-1.0),
               terms[3][4] = {{1, 0.0047, 0, 1e-5}, {1, 0.0053, 0, 1e-5}, {34.1, 0.04, 13.5, 0.025}};
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd));
  std::vector<double> seen[3];
  for (int k = 0; k < 3; ++k) {
    seen[k] = oracle_filter(
        plane[k], radius,
        [&](double x, double y) {
          const double d2 = (x * x + y * y) / (ppd * ppd), *t = terms[k];
          return t[0] * std::sqrt(pi / t[1]) * std::exp(-pi * pi * d2 / t[1]) +
                 t[2] * std::sqrt(pi / t[3]) * std::exp(-pi * pi * d2 / t[3]);
        },
        false);
  }
  OracleSeen result;
  for (std::size_t i = 0; i < seen[0].size(); ++i) {
    const double y = (seen[0][i] + 16) / 116;
    Triple rgb = oracle_rgb({y + seen[1][i] / 500, y, y - seen[2][i] / 200});
    for (double& v : rgb) v = std::clamp(v, 0.0, 1.0);
    result.color.push_back(rgb);
  }
  const double deviation = 0.5 * 0.082 * ppd, s2 = deviation * deviation;
  const int reach = static_cast<int>(std::ceil(3 * deviation));
  const auto bell = [&](double x, double y) { return std::exp(-(x * x + y * y) / (2 * s2)); };
  const auto features = [&](auto derivative) {
    const auto across = oracle_filter(
        plane[3], reach, [&](double x, double y) { return derivative(x) * bell(x, y); }, true);
    const auto down = oracle_filter(
        plane[3], reach, [&](double x, double y) { return derivative(y) * bell(x, y); }, true);
    std::vector<double> size;
    for (std::size_t i = 0; i < across.size(); ++i) size.push_back(std::hypot(across[i], down[i]));
    return size;
  };
  result.edge = features([](double x) { return -x; });
  result.point = features([&](double x) { return x * x / s2 - 1; });
  return result;
}

inline std::vector<double> oracle_ldr_flip(const LinearPicture& a, const LinearPicture& b, double ppd) {
  const OracleSeen p = oracle_seen(a, ppd), q = oracle_seen(b, ppd);
  std::vector<double> error;
  for (std::size_t i = 0; i < p.color.size(); ++i) {
    const double feature = std::max(std::fabs(p.edge[i] - q.edge[i]), std::fabs(p.point[i] - q.point[i]));
    error.push_back(std::pow(oracle_color_error(p.color[i], q.color[i]), 1 - std::sqrt(feature / std::sqrt(2.0))));
  }
  return error;
}

// The ACES fit with its pre-exposure of 0.6, as printed.
inline double oracle_aces(double x) {
  x *= 0.6;
  return std::clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}
inline double oracle_bright_input() {
  double low = 0, high = 10;
  for (int i = 0; i < 100; ++i) (oracle_aces((low + high) / 2) < 0.85 ? low : high) = (low + high) / 2;
  return low;
}

inline std::vector<double> oracle_hdr_flip(const LinearPicture& a, const LinearPicture& b, double ppd) {
  std::vector<double> luminance;
  for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
    const double y = 0.2126 * static_cast<double>(a.rgb[i]) + 0.7152 * static_cast<double>(a.rgb[i + 1]) +
                     0.0722 * static_cast<double>(a.rgb[i + 2]);
    if (y > 0) luminance.push_back(y);
  }
  std::sort(luminance.begin(), luminance.end());
  const double first = std::log2(oracle_bright_input() / luminance.back());
  const double last = std::log2(oracle_bright_input() / luminance[(luminance.size() - 1) / 2]);
  const int n = std::max(2, static_cast<int>(std::ceil(last - first)));
  std::vector<double> error(luminance.size(), 0.0);
  error.assign(a.rgb.size() / 3, 0.0);
  for (int i = 0; i < n; ++i) {
    const double scale = std::exp2(first + (last - first) * i / (n - 1));
    LinearPicture mapped[2] = {a, b};
    for (LinearPicture& m : mapped)
      for (float& v : m.rgb) v = static_cast<float>(oracle_aces(static_cast<double>(v) * scale));
    const std::vector<double> one = oracle_ldr_flip(mapped[0], mapped[1], ppd);
    for (std::size_t k = 0; k < error.size(); ++k) error[k] = std::max(error[k], one[k]);
  }
  return error;
}

}  // namespace shoal::test
