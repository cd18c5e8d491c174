// The background that filtered waves reflect (water/rough_mirror.h), for sixteen lanes.
#pragma once

#include "shading/sky.h"
#include "water/rough_mirror.h"

namespace shoal::inline SHOAL_ISA_NS {

#if defined(SHOAL_SHARED_TEMPLATES)
// Compiled once an instruction set, in scene/rough_mirror.isa.cpp.
extern template RoughMirror<WideF> mirror_roughly(const SkyView&, const WaterBody&, bool, Vec3<WideF>,
                                                  const ExactRay<WideF>&);
#endif

}  // namespace shoal::inline SHOAL_ISA_NS
