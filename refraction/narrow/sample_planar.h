// What image-space methods fetch from the planar reflection layer.
#pragma once

#include "refraction/narrow/sample_place.h"

namespace shoal::inline SHOAL_ISA_NS {

// The reflected hits of a block at places of the planar reflection layer: the triangle of the nearest pixel, seen along
// the ray that the plane itself reflects at the place.
//   place  clamped to the frame;  lanes  that are wanted;  fetches  of each lane: added to
//   out    reflected_id, and reflected_position with the lanes that are aimed at it
// Source: a mirrored picture of the scene is what engines sample for water's reflection.
// Differs: the triangle is shaded at the place instead of interpolated between shaded pixels, so that no picture of the
//          reflection is lit for pixels that show none.
void sample_planar(const RasterNarrowIn& in, const LayerPlace<WideF>& place, WideM lanes, WideI& fetches,
                   HitBlock& out);

}  // namespace shoal::inline SHOAL_ISA_NS
