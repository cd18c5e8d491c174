// Narrow phase under waves: what does a ray meet that the waves bent away from flat water's?
//
// The refracted layer is the scene as flat water shows it. A point of the bent ray has its place there by the same map
// that geometry was drawn with, so the ray is followed across the layer, pixel by pixel, until it goes behind what is
// drawn; there the true ray is tested against the triangle itself and its neighbours (confirm_hit.h). Where it meets
// none of them it has passed behind an edge, and goes on.
#pragma once

#include "refraction/narrow/confirm_hit.h"

namespace shoal::inline SHOAL_ISA_NS {

// A layer of a body's water that rays are followed through.
struct Layer {
  const VisibilityBuffer& visibility;
  const WaterPass& water;
  bool mirrored;  // drawn by mirrored_position, else by WaterPass::map
};

//   ray         the true ray of each lane, from the water, unit direction
//   own         what the layer shows at the lanes' own pixels
// Returns the triangle that each ray meets, kNoId where it leaves the scene. Where the layer does not tell (what the
// ray meets is hidden in it, or outside of the frame) the surface that the ray was last in front of, or else the one
// that hides it.
// Source: the march McGuire and Mara 2014, section 3; the test at its end is ours. Differs: across virtual space, where
// the
//         bent ray is straight by parts; what it meets is a triangle, not a depth.
// Error: where the layer tells, none but at silhouettes. How often it does not is measured (docs/QUALITY.md), and
// bounded
//        by tests/refraction/test_floor_under_waves.cpp and test_displaced.cpp.
WideI march_hit(const FrameData& f, const Layer& layer, const Ray<WideF>& ray, WideI own, WideM lanes);

}  // namespace shoal::inline SHOAL_ISA_NS
