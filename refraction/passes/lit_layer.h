// The lit layer of image-space methods: lighting the refracted layer as a picture, and fetching from it.
#pragma once

#include "refraction/data/frame_grids.h"
#include "refraction/data/layer_view.h"
#include "refraction/data/region_hits.h"
#include "refraction/data/targets.h"
#include "refraction/data/view_state.h"
#include "refraction/data/water_pass.h"
#include "scene/scene_view.h"

namespace shoal {

struct LightLayerIn {
  const SceneView& scene;
  const ViewState& view;
  const FrameGrids& grids;
  const WaterOptics& optics;
  const VisibilityBuffer& refracted;
};

// What a fetch from the layer reads, for one block.
struct FetchIn {
  const SceneView& scene;
  const ViewState& view;
  const FrameGrids& grids;
  const WaterOptics& optics;
  const LayerView& layer;
  const LitLayer& lit;
};

// A place in the layer, in pixels: a texel's sample is at its index + 0.5. A place outside of the frame is clamped to
// its edge.
template <class F>
struct LayerPlace {
  F x_px, y_px;
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

// Lights one region of the refracted layer: each pixel at its own point, where the ray through flat water (of a whole
// scene: the straight ray) hits the triangle drawn there.
void light_layer(const LightLayerIn& in, LitLayer& out, std::size_t region);

// Fetches the layer, bilinear, for the lanes of a block, and absorbs each texel's light on its way from there to the
// surface. Writes the light, the triangle of the nearest texel, and, where the sample is captured, the point: mixed as
// the light is where all four texels are of one drawable, else the nearest's.
//   at  where the pixels' rays cross the surface
void fetch_layer(const FetchIn& in, const ExactRay<WideF>& at, LayerPlace<WideF> place, WideM lanes, HitBlock& hits,
                 FetchedBlock& out);

}  // namespace shoal::inline SHOAL_ISA_NS
