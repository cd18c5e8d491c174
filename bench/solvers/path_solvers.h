// Other ways to solve the flat path (path_solver.h has the problem, and ours), to measure ours against: fixed point,
// Newton, Halley with any number of steps, the quartic in closed form, a table. docs/solvers.md has errors and costs.
//
// All take the lengths as solve_path does and return the same: S, q and the thin side's distance, finite for any finite
// input. A fixed point or a table finds q; S then follows from the geometry, S = d q / (a q + b).
#pragma once

#include <cstddef>
#include <vector>

#include "core/math.h"
#include "refraction/broad/path_solver.h"

namespace shoal {

// 1 / q over the unit square: across, d / (d + a + b); down, b / (a + b). a, b: the thin and the dense side's distance.
struct PathTable {
  std::size_t size = 0;      // points a side
  std::vector<float> inv_q;  // size rows
};
// By bisection in double.
//   size  points a side, 2 to 4096
PathTable make_path_table(const PathConstants& c, std::size_t size);  // path_table.cpp

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

template <class F>
SHOAL_INLINE PathSolution<F> path_of_q(const ScaledPath<F>& p, F q) {
  return {(p.d * q) / (p.thin * q + p.dense), q, p.guarded_thin_m};
}

// q <- sqrt(r^2 + m S(q)^2), from Steel's starting value r (x^2 + 1), x = d / (b + 3 a), at most 1e5.
//   steps  0 or more
// Source: Steel 2024, virtual_depth (four steps).
// Differs: a and b are the thin and the dense side's distances, not the camera's and the point's: from the dense side
//          Steel's own form has no real root where the ray would be totally reflected.
template <class F>
SHOAL_INLINE PathSolution<F> solve_fixed_point(const PathConstants& c, F thin_m, F dense_m, F d_m, int steps) {
  if (c.identity) return straight_path(thin_m, dense_m, d_m);
  const ScaledPath<F> p = scale_path(c, thin_m, dense_m, d_m);
  const F x = min(p.d / (p.dense + F(3.0f) * p.thin), F(1e5f));
  F q = F(c.ratio) * (x * x + F(1.0f));
  for (int step = 0; step < steps; ++step) q = path_q(c, path_of_q(p, q).tan_thin);
  return path_of_q(p, q);
}

// Newton on F(S) from scale_path's start. F is concave: a step from the left stays there, one from the right lands
// left, where the lower bound holds it.
template <class F>
SHOAL_INLINE PathSolution<F> solve_newton(const PathConstants& c, F thin_m, F dense_m, F d_m, int steps) {
  if (c.identity) return straight_path(thin_m, dense_m, d_m);
  const ScaledPath<F> p = scale_path(c, thin_m, dense_m, d_m);
  F s = p.start;
  for (int step = 0; step < steps; ++step) {
    const F i = F(1.0f) / path_q(c, s);
    const F f = p.thin * s + p.dense * (s * i) - p.d;
    s = max(s - f / (p.thin + p.dense * F(c.ratio * c.ratio) * (i * i * i)), p.lo);
  }
  return {s, path_q(c, s), p.guarded_thin_m};
}

// Halley from the same start; solve_path is this with two steps.
template <class F>
SHOAL_INLINE PathSolution<F> solve_halley(const PathConstants& c, F thin_m, F dense_m, F d_m, int steps) {
  if (c.identity) return straight_path(thin_m, dense_m, d_m);
  const ScaledPath<F> p = scale_path(c, thin_m, dense_m, d_m);
  F s = p.start;
  for (int step = 0; step < steps; ++step) s = halley_step(c, p, s);
  return {s, path_q(c, s), p.guarded_thin_m};
}

// Cube root of x >= 0; 0 below 1e-36.
template <class F>
SHOAL_INLINE F cube_root(F x) {
  const F root = det_exp2(det_log2(max(x, F(1e-36f))) * F(1.0f / 3.0f));
  return select(x > F(1e-36f), root, F(0.0f));
}

// The quartic of the virtual distance v = b / q in closed form (Ferrari, Cardano), then q = sqrt(r^2 + m S^2) from
// S = d / (a + v).
//
// With C = (m d^2 - b^2) / r^2, E = (m d^2 + b^2) / r^2 and y = v + a / 2 the quartic is
// y^4 + (C - a^2 / 2) y^2 - a E y + a^4 / 16 + a^2 C / 4 = 0, and w = z + C takes its resolvent in z to
// w^3 = (C + a^2) w^2 + a^2 G, G = E^2 - C^2, which has one positive root.
// Source: derived. The quartic itself: Glaeser and Schroecker 2000.
template <class F>
SHOAL_INLINE PathSolution<F> solve_quartic(const PathConstants& c, F thin_m, F dense_m, F d_m) {
  if (c.identity) return straight_path(thin_m, dense_m, d_m);
  const ScaledPath<F> p = scale_path(c, thin_m, dense_m, d_m);
  const F a = p.thin, inv_r2 = F(c.inv_ratio * c.inv_ratio);
  const F md2 = F(c.m) * p.d * p.d * inv_r2, b2 = p.dense * p.dense * inv_r2;
  const F big_c = md2 - b2, big_e = md2 + b2, big_g = F(4.0f) * b2 * md2;
  // The cubic's positive root: w = t + K / 3.
  const F k = big_c + a * a, third = k * F(1.0f / 3.0f), third3 = third * third * third;
  const F half_ag = F(0.5f) * a * a * big_g;
  const F h = third3 + half_ag;
  const F discriminant = F(2.0f) * half_ag * (third3 + F(0.5f) * half_ag);
  const F cube = cube_root(h + sqrt(max(discriminant, F(0.0f))));
  const F one_real = cube + select(cube > F(0.0f), third * third / max(cube, F(1e-12f)), F(0.0f));
  const F size = abs(third), size3 = max(abs(third3), F(1e-36f));
  const F angle = det_acos(clamp(h / size3, F(-1.0f), F(1.0f)));
  const F three_real = F(2.0f) * size * det_cos(angle * F(1.0f / 3.0f));
  const F w = max(third + select(discriminant >= F(0.0f), one_real, three_real), F(1e-18f));
  // The quartic's positive root, by forms that do not cancel where there are some: z = a^2 (1 + G / w^2).
  const F g = big_g / (w * w), root = sqrt(F(1.0f) + g);
  const F inner = F(2.0f) * (big_e / root - big_c) - a * a * g;
  const F v = F(0.5f) * (a * g / (root + F(1.0f)) + sqrt(max(inner, F(0.0f))));
  const F s = clamp(p.d / (a + v), p.lo, max(p.hi, p.lo));
  return {s, path_q(c, s), p.guarded_thin_m};
}

SHOAL_INLINE float look_up(const float* values, std::int32_t at) { return values[at]; }
SHOAL_INLINE WideF look_up(const float* values, WideI at) { return gather(values, at); }

// Four values of the table, mixed.
template <class F>
SHOAL_INLINE PathSolution<F> solve_table(const PathConstants& c, const PathTable& table, F thin_m, F dense_m, F d_m) {
  if (c.identity) return straight_path(thin_m, dense_m, d_m);
  const ScaledPath<F> p = scale_path(c, thin_m, dense_m, d_m);
  const F depths = p.thin + p.dense, cells = F(static_cast<float>(table.size - 1));
  const F x = clamp(p.d / (p.d + depths), F(0.0f), F(1.0f)) * cells;
  const F y = clamp(p.dense / depths, F(0.0f), F(1.0f)) * cells;
  const F column = min(floor(x), cells - F(1.0f)), row = min(floor(y), cells - F(1.0f));
  const F u = x - column, v = y - row;
  const IntOf<F> width = IntOf<F>(static_cast<std::int32_t>(table.size));
  const IntOf<F> at = to_int_trunc(row) * width + to_int_trunc(column);
  const float* values = table.inv_q.data();
  const F top = look_up(values, at) * (F(1.0f) - u) + look_up(values, at + IntOf<F>(1)) * u;
  const F bottom = look_up(values, at + width) * (F(1.0f) - u) + look_up(values, at + width + IntOf<F>(1)) * u;
  return path_of_q(p, F(1.0f) / max(top * (F(1.0f) - v) + bottom * v, F(1e-10f)));
}

// The apparent distance of the path's far end (virtual_distance, path_solver.h) from a solver's path.
template <class F>
SHOAL_INLINE F apparent_distance(const PathSolution<F>& path, bool eye_is_thin, F far_m) {
  return eye_is_thin ? far_m / path.q : path.thin_m * path.q;
}

}  // namespace shoal::inline SHOAL_ISA_NS
