// A layer that is not drawn, filled from the hits of the rays: blended materials are composited in front of it.
#pragma once

#include "raster/visibility.h"
#include "refraction/data/frame_grids.h"
#include "refraction/data/region_hits.h"
#include "refraction/data/view_state.h"
#include "refraction/data/water_pass.h"

namespace shoal {

struct LayerFromHitsIn {
  const ViewState& view;
  const FrameGrids& grids;
  const WaterOptics& optics;
  const WaterInterface& interface;
  const HitBlock* hits;  // of the region, with triangles and positions
  WaterPassKind kind;
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

// Ids and depths of one region's blocks that show water.
void layer_from_hits(const LayerFromHitsIn& in, VisibilityBuffer& out, std::size_t region);

}  // namespace shoal::inline SHOAL_ISA_NS
