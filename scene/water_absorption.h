// Light that is absorbed along its way through a body of water.
#pragma once

#include "shading/absorption.h"
#include "water/body.h"

namespace shoal::inline SHOAL_ISA_NS {

// The way of a view ray in the water that leaves the scene: longer than any scene, metres.
inline constexpr float kFarAway_m = 1e6f;

// Beer-Lambert over a length of a body's water.
//   path_m  >= 0, metres
// Returns what is left of each colour.
template <class F>
SHOAL_INLINE Vec3<F> absorbed(const WaterBody& body, F path_m) {
  return transmittance(broadcast<F>(body.absorption_per_m), path_m);
}

}  // namespace shoal::inline SHOAL_ISA_NS
