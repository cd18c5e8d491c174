// One frame, start to end.
#pragma once

#include "refraction/data/method_state.h"
#include "refraction/data/stage.h"
#include "refraction/data/targets.h"
#include "refraction/data/view_state.h"
#include "refraction/methods/kernels.h"
#include "refraction/passes/water_region.h"
#include "scene/scene_view.h"
#include "trace/ray_counts.h"
#include "trace/trace_view.h"

namespace shoal {

// What a frame reads; nothing of it changes while a frame is drawn.
struct FrameIn {
  const SceneView& scene;
  const TraceView& trace;
  const OutlineView& outlines;                         // of the bodies of water
  const std::vector<std::uint32_t>& blended_meshlets;  // of the scene, in submission order
  const FrameGrids& grids;
  const FrameKernels& kernels;
  const MethodKernels& method;
  const MethodState& state;
  Reflections reflections;
  PostSettings post;
};

// The memory of the passes, kept between frames.
struct FrameWork {
  PassBins bins, outline_bins;
  PassBins back_bins;  // the back faces of a layer
  PassBins blended_bins, blended_reflected_bins;
  BinGrid blended_regions;               // of the frame
  std::vector<FragmentLists> fragments;  // [threads]
  AlignedArray<RegionScratch> scratch;   // [threads]
  std::vector<WaterOptics> water;
  std::vector<WaterCount> counts;  // [regions]
  WaterRegions regions;
  EdgeMap edges[2];  // [WaterPassKind] of the layers
};

// What a frame counts, all samples together.
struct FrameCounts {
  std::uint64_t water_pixels = 0;
  std::uint64_t subdivision_capped = 0;  // triangles that reached the subdivision's level cap
  RayCounts rays;
  std::uint64_t fetches = 0;      // of triangles from layers, by all water pixels
  std::uint32_t max_fetches = 0;  // by one of them
};

struct FrameOut {
  Targets& targets;
  FrameWork& work;
  FrameCounts& counts;
  std::int32_t& eye_in_water;  // ViewState::eye_in_water, which the water stage sets
};

// Draws one sample of every pixel; the last sample completes the picture.
//   view  its eye_in_water is out.eye_in_water
void draw_sample(const FrameIn& in, const ViewState& view, const FrameOut& out, const Run& run);

}  // namespace shoal
