// Light in an absorbing medium.
#pragma once

#include "core/math.h"
#include "core/vec_lanes.h"

namespace shoal::inline SHOAL_ISA_NS {

// The share of light that is left after a path through a medium.
//   absorption_per_m  of each colour, >= 0, 1/m
//   path_m            >= 0, metres
// Returns exp(-absorption path): 1 at path 0.
// Source: Beer and Lambert's law.
// Error: relative 2e-7 (1 + absorption path) (tests/shading/test_absorption.cpp).
template <class F>
SHOAL_INLINE F transmittance(F absorption_per_m, F path_m) {
  return det_exp2(absorption_per_m * path_m * F(-1.44269504f));
}
template <class F>
SHOAL_INLINE Vec3<F> transmittance(Vec3<F> absorption_per_m, F path_m) {
  return {transmittance(absorption_per_m.x, path_m), transmittance(absorption_per_m.y, path_m),
          transmittance(absorption_per_m.z, path_m)};
}

}  // namespace shoal::inline SHOAL_ISA_NS
