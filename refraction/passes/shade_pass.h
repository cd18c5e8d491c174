// Resolve, light and post, fused: a region of the frame from visible ids to 8-bit pixels while it is in cache.
#pragma once

#include "refraction/data/frame_grids.h"
#include "refraction/data/targets.h"
#include "refraction/data/view_state.h"
#include "refraction/data/water_pass.h"
#include "scene/scene_view.h"
#include "shading/post.h"

namespace shoal {

struct ShadeIn {
  const SceneView& scene;
  const ViewState& view;
  const FrameGrids& grids;
  const VisibilityBuffer& direct;
  const WaterLight& water;           // of the pixels that show water
  const BlendLayer* blended_direct;  // null in a scene without blended materials
  PostSettings post;
};
struct ShadeOut {
  GBuffer& gbuffer;     // the resolved surfaces, written where the sample is captured
  LitBuffer& lit;       // the sum over the samples so far, or, after the last one, their mean; empty where not kept
  std::uint8_t* srgb8;  // RGB rows, written with the last sample
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

void shade(const ShadeIn& in, const ShadeOut& out, std::size_t region);

}  // namespace shoal::inline SHOAL_ISA_NS
