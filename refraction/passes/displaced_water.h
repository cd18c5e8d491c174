// The displaced surfaces of the bodies of water in the direct pass.
#pragma once

#include <vector>

#include "raster/visibility.h"
#include "refraction/data/frame_grids.h"
#include "refraction/data/view_state.h"
#include "refraction/data/water_pass.h"

namespace shoal {

struct DisplacedWaterIn {
  const ViewState& view;
  const FrameGrid& frame;
  const std::vector<WaterOptics>& water;
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

// Writes depth and id of one region's pixels where a displaced surface is in front. The rays of the pixels cross the
// height field itself, so no mesh of it can differ from the surface that the refracted and reflected rays leave.
void draw_displaced_water(const DisplacedWaterIn& in, VisibilityBuffer& direct, std::size_t region);

}  // namespace shoal::inline SHOAL_ISA_NS
