// Where a ray first meets the height field itself, not a mesh of it.
#pragma once

#include "water/surface.h"

namespace shoal::inline SHOAL_ISA_NS {

// A ray that dips through the surface and back by less than this share of the height bound may pass.
inline constexpr float kLeastDip = 1e-3f;
// Steps after which a ray counts as skimming the surface, and as meeting it there.
inline constexpr int kMaxSurfaceSteps = 512;

// First crossing of a ray with the surface.
//
//   origin, direction   x and z along the plane's axes from the body's origin, y the height over the plane; metres; the
//                       direction of any length but 0
//   t_min, t_max        >= 0: the stretch of the ray, in lengths of the direction
//   lanes               which rays are asked for
// Returns t, or infinity where the ray does not cross within t_min..t_max or is not asked for. It crosses from the side
// it is on at t_min: from above or from under water.
// How: only within the height bound; from there in steps that the slope bound allows, at least so long that a dip of
// kLeastDip shows; the crossing of the last step by the rule of false position.
// Error: the point is off the surface by 2e-5 of the height bound and by what t's rounding moves it
//        (tests/water/test_intersect_surface.cpp, against dense samples in double).
template <class F>
SHOAL_INLINE F intersect_surface(const WaterSurface& surface, Vec3<F> origin, Vec3<F> direction, F t_min, F t_max,
                                 MaskOf<F> lanes) {
  // The stretch between the greatest heights. A level ray is made to cross them far away.
  const F bound = F(surface.height_bound_m);
  const F rise = select(abs(direction.y) > F(1e-20f), direction.y, F(1e-20f));
  const F to_top = (bound - origin.y) / rise, to_bottom = (-bound - origin.y) / rise;
  const F enter = min(to_top, to_bottom), leave = max(to_top, to_bottom);
  F t = max(t_min, enter);
  const F end = min(t_max, leave);
  MaskOf<F> active = lanes & (t <= end);
  if (surface.height_bound_m == 0.0f) return select(active, t, F(kInfinity));
  const auto clearance = [&](F at) SHOAL_LAMBDA {
    return (origin.y + direction.y * at) -
           surface_at(surface, origin.x + direction.x * at, origin.z + direction.z * at).height_m;
  };
  F gap = clearance(t);
  const MaskOf<F> above = gap > F(0.0f);
  // The greatest rate at which the gap can close.
  const F level = sqrt(direction.x * direction.x + direction.z * direction.z);
  const F rate = F(surface.slope_bound) * level + select(above, -direction.y, direction.y);
  active = active & (rate > F(0.0f));
  const F closing = max(rate, F(1e-20f));
  const F least_step = F(2.0f * kLeastDip) * bound / closing;

  MaskOf<F> found = active & !active;
  F lo = t, hi = t, gap_lo = gap, gap_hi = gap;
  for (int step = 0; step < kMaxSurfaceSteps && any(active); ++step) {
    const F next = min(t + max(abs(gap) / closing, least_step), end);
    const F gap_next = clearance(next);
    const MaskOf<F> crossed = active & ((gap_next > F(0.0f)) ^ above);
    lo = select(crossed, t, lo);
    gap_lo = select(crossed, gap, gap_lo);
    hi = select(crossed, next, hi);
    gap_hi = select(crossed, gap_next, gap_hi);
    found = found | crossed;
    active = active & !crossed & (next < end);
    t = select(active, next, t);
    gap = select(active, gap_next, gap);
  }
  // What skims.
  lo = select(active, t, lo);
  hi = select(active, t, hi);
  found = found | active;
  if (none(found)) return F(kInfinity);
  const auto zero_between = [&]() SHOAL_LAMBDA {
    const F fall = gap_lo - gap_hi;
    return lo + (hi - lo) * select(fall == F(0.0f), F(0.5f), gap_lo / select(fall == F(0.0f), F(1.0f), fall));
  };
  for (int round = 0; round < 3; ++round) {
    const F at = zero_between();
    const F gap_at = clearance(at);
    const MaskOf<F> before = !((gap_at > F(0.0f)) ^ above);
    lo = select(before, at, lo);
    gap_lo = select(before, gap_at, gap_lo);
    hi = select(before, hi, at);
    gap_hi = select(before, gap_hi, gap_at);
  }
  return select(found, zero_between(), F(kInfinity));
}

}  // namespace shoal::inline SHOAL_ISA_NS
