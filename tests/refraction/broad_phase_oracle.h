// What the broad phase must do, in double and by other means, and scenes to try it on.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <random>

#include "refraction/broad/broad_phase.h"

namespace shoal_test {

using namespace shoal;

inline Vec3d to_double(Vec3f v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
inline double norm(Vec3d v) { return std::sqrt(dot(v, v)); }

// The same numbers from every standard library.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  float in(float lo, float hi) {
    return static_cast<float>(static_cast<double>(lo) +
                              static_cast<double>(hi - lo) * (static_cast<double>(engine_()) / 4294967296.0));
  }
  float log_in(float lo, float hi) { return lo * std::pow(hi / lo, in(0, 1)); }

 private:
  std::mt19937 engine_;
};

// 1920 x 1080, 60 degrees, any yaw, up to 75 degrees of pitch.
inline View looking(Vec3f eye, Random& random, bool orthographic) {
  const float yaw = random.in(0, 6.2831853f), pitch = random.in(-1.3f, 1.3f);
  const float cy = std::cos(yaw), sy = std::sin(yaw), cp = std::cos(pitch), sp = std::sin(pitch);
  Camera camera;
  camera.position_world = eye;
  camera.forward_world = {cp * cy, sp, cp * sy};
  camera.right_world = {-sy, 0, cy};
  camera.up_world = {-sp * cy, cp, -sp * sy};
  camera.orthographic = orthographic;
  return make_view(camera, 1920, 1080, {0, 0});
}

// Apparent distance by Newton in double on Snell's law from S = 0: the function is concave and increasing, so that the
// iterates rise to the root and stop there.
inline double oracle_distance(float ior, bool eye_above, double eye_m, double far_m, double d_m) {
  const double n = static_cast<double>(ior), ratio = n < 1.0 ? 1.0 / n : n, m = (ratio - 1.0) * (ratio + 1.0);
  const bool eye_is_thin = eye_above == (n >= 1.0);
  const double thin = std::max(eye_is_thin ? eye_m : far_m, 1e-10 * (eye_m + far_m + d_m));
  const double dense = eye_is_thin ? far_m : eye_m;
  double s = 0.0;
  for (int i = 0; i < 200; ++i) {
    const double q = std::sqrt(ratio * ratio + m * s * s);
    const double next = s - (thin * s + dense * s / q - d_m) / (thin + dense * ratio * ratio / (q * q * q));
    if (!(next > s * (1.0 + 1e-15))) break;
    s = next;
  }
  const double q = std::sqrt(ratio * ratio + m * s * s);
  return eye_is_thin ? far_m / q : thin * q;
}

inline Vec3d oracle_virtual(const BroadPhase& bp, Vec3d p) {
  const Vec3d n = to_double(bp.far_normal);
  const double far_m = dot(p - to_double(bp.plane_origin), n), refracted_m = std::max(far_m, 0.0);
  double v = 0.0;
  if (bp.path.identity) {
    v = refracted_m;
  } else if (bp.orthographic) {
    v = refracted_m * static_cast<double>(bp.far_scale);
  } else {
    const Vec3d r = p - to_double(bp.eye_world);
    const double d = norm(r - n * dot(r, n));
    v = oracle_distance(bp.path.ior, !bp.eye_below, static_cast<double>(bp.eye_distance_m), refracted_m, d);
  }
  return p + n * (v - refracted_m);
}

// sup of |Hessian of v(b, x, y)| over points seen from the thin side at distance 1, S the thin side's tangent:
// dv = (db - K dd) / (q - K S), K = v m S / (q (1 + v)).
inline double largest_hessian(double n) {
  using Complex = std::complex<double>;
  const double m = n * n - 1.0, h = 1e-30;
  const auto gradient = [&](Complex s, Complex v, Complex& by_b, Complex& by_d) {
    const Complex q = std::sqrt(n * n + m * s * s), k = v * m * s / (q * (1.0 + v));
    by_b = q / (n * n + m * s * s / (1.0 + v));
    by_d = -k * by_b;
  };
  double worst = 0.0;
  for (int i = 0; i < 300; ++i) {
    for (int j = 0; j < 250; ++j) {
      const double s = std::pow(10.0, -2.0 + 5.0 * i / 299.0), v = std::pow(10.0, -5.0 + 10.0 * j / 249.0);
      const double q = std::sqrt(n * n + m * s * s), d = s * (1.0 + v);
      Complex b_s, d_s, b_v, d_v;
      gradient(Complex(s, h), v, b_s, d_s);
      gradient(s, Complex(v, h), b_v, d_v);
      // Jacobian of (b, d) = (v q, S (1 + v)), inverted.
      const double j11 = v * m * s / q, j12 = q, j21 = 1.0 + v, j22 = s, det = j11 * j22 - j12 * j21;
      const double s_b = j22 / det, s_d = -j12 / det, v_b = -j21 / det, v_d = j11 / det;
      const double bb = (b_s.imag() * s_b + b_v.imag() * v_b) / h, bd = (b_s.imag() * s_d + b_v.imag() * v_d) / h;
      const double dd = (d_s.imag() * s_d + d_v.imag() * v_d) / h, across = d_s.real() / d;
      const double mean = 0.5 * (bb + dd), radius = std::hypot(0.5 * (bb - dd), bd);
      worst = std::max({worst, std::fabs(mean + radius), std::fabs(mean - radius), std::fabs(across)});
    }
  }
  return worst;
}

// A random triangle on the far side of the plane y = 0 (or through it), shrunk until edge_deviation_px passes for all
// of its edges, and no further. Returns the largest deviation in it, pixels at each point's own depth.
inline double worst_deviation_of_passing_triangle(Random& random, float ior, bool eye_above, bool through_plane) {
  const float a = random.log_in(0.02f, 20.0f), side = eye_above ? -1.0f : 1.0f;
  const View view = looking({0, -side * a, 0}, random, false);
  const BroadPhase bp = make_broad_phase(Vec3f{0, 0, 0}, Vec3f{0, 1, 0}, ior, view);
  float d = random.log_in(0.01f, 50.0f) * a;
  const float distance = random.log_in(1e-4f, 10.0f) * a;
  const float b = through_plane && random.in(0, 1) < 0.5f ? -distance : distance;
  // A third of them at the critical angle's distance, where the map from the dense side is steepest.
  if (random.in(0, 1) < 0.3f) {
    const float off = random.in(-0.5f, 0.5f);
    d = a * bp.path.inv_sqrt_m * (1.0f + off * random.log_in(1e-3f, 1.0f));
  }
  const float angle = random.in(0, 6.2831853f);
  const Vec3f centre = {d * std::cos(angle), b * side, d * std::sin(angle)};
  Vec3f shape[3];
  const float flat = random.log_in(1e-3f, 1.0f), turn = random.in(0, 6.2831853f);
  const bool regular = random.in(0, 1) < 0.3f;
  for (int i = 0; i < 3; ++i) {
    const float x = random.in(-0.5f, 0.5f), y = random.in(-0.5f, 0.5f), z = random.in(-0.5f, 0.5f);
    const float corner = turn + 2.0943951f * static_cast<float>(i);
    shape[i] = regular ? Vec3f{std::cos(corner), y * flat, std::sin(corner)} : Vec3f{x, y * flat, z};
  }
  Vec3f p[3];
  const auto passes = [&](float scale) {
    for (int i = 0; i < 3; ++i) {
      p[i] = centre + shape[i] * scale;
      if (!through_plane) p[i].y = eye_above ? std::min(p[i].y, 0.0f) : std::max(p[i].y, 0.0f);
    }
    for (int i = 0; i < 3; ++i)
      if (edge_deviation_px(bp, view, p[i], p[(i + 1) % 3]) > kEdgeThresholdPx) return false;
    return true;
  };
  float good = random.log_in(1e-3f, 100.0f) * a, bad = 0.0f;
  for (int i = 0; i < 60 && !passes(good); ++i) {
    bad = good;
    good *= 0.7f;
  }
  if (!passes(good)) return 0.0;
  for (int i = 0; i < 10 && bad > 0.0f; ++i) {
    const float middle = 0.5f * (good + bad);
    (passes(middle) ? good : bad) = middle;
  }
  passes(good);

  const Vec3d world[3] = {to_double(p[0]), to_double(p[1]), to_double(p[2])};
  Vec3d image[3];
  for (int i = 0; i < 3; ++i) image[i] = oracle_virtual(bp, world[i]);
  double worst = 0.0;
  constexpr int kSteps = 14;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; i + j <= kSteps; ++j) {
      const double u = static_cast<double>(i) / kSteps, v = static_cast<double>(j) / kSteps, t = 1.0 - u - v;
      const Vec3d straight = image[0] * t + image[1] * u + image[2] * v;
      const Vec3d exact = oracle_virtual(bp, world[0] * t + world[1] * u + world[2] * v);
      const double w = dot(to_double(view.row_w), exact - to_double(bp.eye_world));
      if (w < static_cast<double>(bp.near_m)) continue;
      worst = std::max(worst, norm(exact - straight) * static_cast<double>(bp.px_per_unit) / w);
    }
  }
  return worst;
}

}  // namespace shoal_test
