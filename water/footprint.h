// What a pixel covers of the plane of the water, and what its mean leaves of a wave.
//
// A pixel shows the mean over its footprint. Of a sine that mean is the sine itself times sinc of the cycles across the
// footprint, once for each of its two sides; so each part of a surface is faded by that factor, and the slope variance
// that is lost becomes the roughness of the surface (Olano and Baker 2010, "LEAN Mapping": E[s^2] - E[s]^2).
#pragma once

#include "core/wide/lanes.h"

namespace shoal {

// The sides of the parallelogram, metres along the body's axes; all 0: a point.
template <class F>
struct Footprint {
  F ax, az, bx, bz;
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

// Square of the side of the square that isotropic waves, to second order, are faded by as by this footprint: the mean
// of the sides' squares. At grazing views the longer side rules: what is not faded enough sparkles, what is faded too
// much is mirrored by the roughness.
template <class F>
SHOAL_INLINE F isotropic_square(Footprint<F> p) {
  return F(0.5f) * ((p.ax * p.ax + p.az * p.az) + (p.bx * p.bx + p.bz * p.bz));
}

// sinc of the cycles across one side, its side lobes left out: 1 at 0, 0 from 1.1026 cycles on, smooth.
//   cycles2  square of the cycles across, >= 0
// Error: 0.033 of sinc's main lobe; the lobes left out reach 0.217 (tests/water/test_filter_surface.cpp).
template <class F>
SHOAL_INLINE F side_weight(F cycles2) {
  const F left = max(F(1.0f) - F(0.822467033f) * cycles2, F(0.0f));  // pi^2 / 12
  return left * left;
}

// A plane wave over a footprint.
//   turns_x, turns_z  cycles a metre along the axes
template <class F>
SHOAL_INLINE F wave_weight(F turns_x, F turns_z, Footprint<F> p) {
  const F a = turns_x * p.ax + turns_z * p.az, b = turns_x * p.bx + turns_z * p.bz;
  return side_weight(a * a) * side_weight(b * b);
}

// Waves of every direction over a square: the same of a wave at 45 degrees to it. 0 from 1.5594 cycles on.
//   cycles2  square of the cycles along the square's side
template <class F>
SHOAL_INLINE F isotropic_weight(F cycles2) {
  const F one_side = side_weight(F(0.5f) * cycles2);
  return one_side * one_side;
}

// Gradient noise: the factor by which it comes nearest to its mean over a square, as that of an isotropic wave of so
// many cycles a cell. Error: 0.1 of the best factor for a square, 0.2 for a line (test_filter_surface.cpp).
inline constexpr float kNoiseCycles2 = 0.78f * 0.78f;

}  // namespace shoal::inline SHOAL_ISA_NS
