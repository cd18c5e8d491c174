// The refracted path between two points on either side of a flat interface.
//
// Fermat's path crosses the plane where both ends see it: with thin_m and dense_m the ends' distances from the plane, d
// their horizontal distance, r >= 1 the ratio of the indices, m = r^2 - 1 and S the tangent of the angle on the thin
// (optically lighter) side, Snell's law is
//
//   F(S) = thin_m S + dense_m S / q(S) - d = 0,   q(S) = sqrt(r^2 + m S^2) = tan thin / tan dense
//
// F is increasing and concave on S >= 0, and the same for both directions of travel. All closed bounds and both Halley
// steps work on it; an ior below 1 only exchanges which side is the thin one, so r >= 1 always.
#pragma once

#include <cmath>

#include "core/vec_lanes.h"

namespace shoal {

// What the solver needs to know of one pair of media, computed once (path_constants).
struct PathConstants {
  float ior = 1;     // n_water / n_air
  float ratio = 1;   // r = max(ior, 1 / ior)
  float m = 0;       // r^2 - 1
  float sqrt_m = 0;  // tangent of the dense side's critical angle is 1 / sqrt_m
  float inv_ratio = 1, inv_sqrt_m = 0;
  bool identity = true;        // ior is 1
  bool water_is_thin = false;  // ior below 1
};

//   S        tangent of the angle from the normal on the thin side, >= 0, finite
//   q        S over the dense side's tangent, in [r, inf); r at S = 0
//   thin_m   the thin side's distance as the solver took it: at least kMinThin of the path
template <class F>
struct PathSolution {
  F tan_thin;
  F q;
  F thin_m;
};

// Below this share of thin + dense + d the thin side's distance is taken as this much: S stays below 1e10.
inline constexpr float kMinThin = 1e-10f;

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

//   ior  n_water / n_air, in [1/3, 3]
SHOAL_INLINE PathConstants path_constants(float ior) {
  PathConstants c;
  c.ior = ior;
  c.identity = ior == 1.0f;
  c.water_is_thin = ior < 1.0f;
  // (n - 1)(n + 1) in double: near n = 1 the difference of squares would have few digits.
  const double n = static_cast<double>(ior);
  const double r = c.water_is_thin ? 1.0 / n : n;
  const double m = (r - 1.0) * (r + 1.0);
  c.ratio = static_cast<float>(r);
  c.m = static_cast<float>(m);
  c.sqrt_m = static_cast<float>(std::sqrt(m));
  c.inv_ratio = static_cast<float>(1.0 / r);
  c.inv_sqrt_m = c.identity ? 0.0f : static_cast<float>(1.0 / std::sqrt(m));
  return c;
}

// A path's lengths in units near 1, and where a solver starts.
template <class F>
struct ScaledPath {
  F thin, dense, d;
  F guarded_thin_m;  // the thin side's distance as the solvers take it, in metres
  F lo, hi;          // bounds of S
  F start;
};

//   c  not the identity; the lengths as for solve_path
// Source: bounds lo = max(d / (a + b / r), (d - b / sqrt m) / a) from q >= r, q >= sqrt(m) S, and hi, the root of a
//         quadratic, from q <= r + sqrt(m) S; start sqrt(lo hi).
template <class F>
SHOAL_INLINE ScaledPath<F> scale_path(const PathConstants& c, F thin_m, F dense_m, F d_m) {
  // A power of two takes the lengths near 1, exactly, so that no product over- or underflows.
  const F size = clamp(thin_m + dense_m + d_m, F(0x1p-100f), F(0x1p120f));
  ScaledPath<F> p;
  p.guarded_thin_m = max(thin_m, F(kMinThin) * size);
  const F scale = as_float(IntOf<F>(0x7F000000) - (as_int(size) & IntOf<F>(0x7F800000)));
  const F a = p.guarded_thin_m * scale, b = dense_m * scale, d = d_m * scale;
  const F r = F(c.ratio);
  p.lo = max(d / (a + b * F(c.inv_ratio)), (d - b * F(c.inv_sqrt_m)) / a);
  const F quad_a = F(c.sqrt_m) * a, quad_b = r * a + b - F(c.sqrt_m) * d, quad_c = r * d;
  const F root = sqrt(quad_b * quad_b + F(4.0f) * quad_a * quad_c);
  const MaskOf<F> rising = quad_b >= F(0.0f);
  p.hi = select(rising, F(2.0f) * quad_c, root - quad_b) / select(rising, quad_b + root, F(2.0f) * quad_a);
  p.start = sqrt(p.lo * p.hi);
  p.thin = a, p.dense = b, p.d = d;
  return p;
}

// q of a tangent on the thin side.
template <class F>
SHOAL_INLINE F path_q(const PathConstants& c, F s) {
  return sqrt(F(c.ratio * c.ratio) + F(c.m) * s * s);
}

// One step of Halley's method from s: g = S / q, g' = r^2 / q^3, g'' = -3 m r^2 S / q^5.
template <class F>
SHOAL_INLINE F halley_step(const PathConstants& c, const ScaledPath<F>& p, F s) {
  const F m = F(c.m), r2 = F(c.ratio * c.ratio);
  const F i = F(1.0f) / sqrt(r2 + m * s * s);
  const F slope = p.dense * r2 * (i * i * i);
  const F f = p.thin * s + p.dense * (s * i) - p.d;
  const F f1 = p.thin + slope;
  const F f2 = F(-3.0f) * m * slope * (s * i * i);
  return max(s - (F(2.0f) * f * f1) / (F(2.0f) * f1 * f1 - f * f2), F(0.0f));
}

// The path where the ratio of the indices is 1: a straight line.
template <class F>
SHOAL_INLINE PathSolution<F> straight_path(F thin_m, F dense_m, F d_m) {
  const F size = clamp(thin_m + dense_m + d_m, F(0x1p-100f), F(0x1p120f));
  const F guarded_thin_m = max(thin_m, F(kMinThin) * size);
  return {min(d_m / (guarded_thin_m + dense_m), F(1e10f)), F(1.0f), guarded_thin_m};
}

// Solves F(S) = 0.
//
//   c                     the media
//   thin_m, dense_m, d_m  metres, >= 0 and finite: distances from the plane, horizontal distance
// Returns the path; for any finite input all three are finite. With all three zero it is the path along the normal.
// Source: derived from Snell's law: scale_path's start, two Halley steps. Others to compare it with: path_solvers.h.
// Differs: Steel (2024) iterates on the depth ratio itself by fixed point, which diverges from the dense side.
// Error: that of the virtual distances dense_m / q and thin_m q, below.
template <class F>
SHOAL_INLINE PathSolution<F> solve_path(const PathConstants& c, F thin_m, F dense_m, F d_m) {
  if (c.identity) return straight_path(thin_m, dense_m, d_m);
  const ScaledPath<F> p = scale_path(c, thin_m, dense_m, d_m);
  F s = p.start;
  for (int step = 0; step < 2; ++step) s = halley_step(c, p, s);
  return {s, path_q(c, s), p.guarded_thin_m};
}

// Where the far end of the path appears to the eye, straight behind its own foot on the plane.
//
//   eye_is_thin          the eye's side is the thin one (air for ior > 1)
//   eye_m, far_m, d_m    metres, >= 0, finite: distances of eye and point from the plane, horizontal distance
// Returns the apparent distance from the plane in metres, >= 0: far_m / q seen from the thin side, far_m q from the
// dense one (where far_m -> 0 gives max(0, sqrt(m) d - eye_m), the edge of Snell's window: it is not 0 there).
// Error: over d/a in [0, 50] x b/a in [1e-3, 100] (a eye_m, b far_m) and ior 1/3 to 3: relative 1.2e-6 from the thin
//        side and 6e-6 from the dense one (worst round d/a = 1 / sqrt(m), where the function itself is steep); 2.5e-4
//        px at 935 px a unit and a = 2 m. tests/refraction/test_path_solver.cpp pins all three.
template <class F>
SHOAL_INLINE F virtual_distance(const PathConstants& c, bool eye_is_thin, F eye_m, F far_m, F d_m) {
  if (c.identity) return far_m;
  if (eye_is_thin) return far_m / solve_path(c, eye_m, far_m, d_m).q;
  const PathSolution<F> path = solve_path(c, far_m, eye_m, d_m);
  return path.thin_m * path.q;
}

}  // namespace shoal::inline SHOAL_ISA_NS
