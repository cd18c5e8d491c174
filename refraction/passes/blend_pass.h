// Blended materials: glass and the like, exact for any order of their triangles.
//
// They never enter the opaque visibility buffers. Their meshlets go through the front ends of the same passes (direct,
// refracted, planar reflection) into bins of their own; each sample's fragments in front of what the pass shows are
// sorted by (depth, id) and composited front to back into the pass's BlendLayer. Shading lays the layers over what is
// behind: the refracted and reflected ones over what those rays show, the direct one over the opaque scene or the
// water. Each fragment's light is absorbed along its own way through the water.
//
// Depth, ids, G-buffer and hit buffers stay those of the opaque scene and the water. Blended materials cast no shadow.
// A scene without any pays a branch a stage.
#pragma once

#include "raster/fragments.h"
#include "raster/pass_bins.h"
#include "refraction/data/frame_grids.h"
#include "refraction/data/method_state.h"
#include "refraction/data/pixel_rays.h"
#include "refraction/data/view_state.h"
#include "scene/scene_view.h"
#include "shading/transparency.h"

namespace shoal {

struct BlendDirectIn {
  const SceneView& scene;
  const ViewState& view;
  const FrameGrids& grids;
  const PassBins& bins;
};
struct BlendWaterIn {
  const SceneView& scene;
  const ViewState& view;
  const FrameGrids& grids;
  const PassBins& bins;
  const WaterPass& pass;
  const WaterInterface& interface;  // of the region
  const HitBlock* hits;             // the same
  PixelRaysFunction refracted;      // the rays that the method's pixels follow
  const void* options;              // of the method
};
struct BlendOut {
  VisibilityBuffer& opaque;  // that the fragments must be in front of; it is not written
  BlendLayer& layer;
  FragmentLists& lists;  // of the thread
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

// One region of the direct pass, and of a body's pass.
void blend_direct(const BlendDirectIn& in, const BlendOut& out, std::size_t region);
void blend_water(const BlendWaterIn& in, const BlendOut& out, std::size_t region);

}  // namespace shoal::inline SHOAL_ISA_NS
