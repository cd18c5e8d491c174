// Where each body of water is, and which part of the frame shows it.
#pragma once

#include "core/thread_pool.h"
#include "refraction/frame_data.h"
#include "refraction/kernels.h"

namespace shoal {

// Sets f.water (one pass a body) and f.eye_in_water for this view.
void place_water(FrameData& f, const MethodKernels& method);

// Is there a body whose surface is displaced? After place_water.
bool any_displaced(const FrameData& f);

LayerGrid make_layer_grid(const FrameGrid& frame, int tile_px, int margin_px);

// Sets f.region_of_body, f.layer_regions, f.tile_active and the pass's bounds to what the narrow phase can reach of
// this body: its visible pixels and a margin, on the fixed 64-pixel grid. Returns false where the body does not show.
bool find_region(FrameData& f, const FrameKernels& kernels, WaterPass& water, ThreadPool& pool);

// The pass that draws what the surface mirrors back to an eye under it.
WaterPass mirrored_pass(const WaterPass& refracted);

// Adds the bins' capped triangles to the frame's count.
void count_capped(FrameData& f);

}  // namespace shoal
