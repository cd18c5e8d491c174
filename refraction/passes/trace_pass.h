// The one stage of a traced method: every pixel of a region by rays alone.
#pragma once

#include <vector>

#include "refraction/data/frame_grids.h"
#include "refraction/data/method_state.h"
#include "refraction/data/targets.h"
#include "refraction/data/view_state.h"
#include "refraction/data/water_pass.h"
#include "scene/scene_view.h"
#include "shading/post.h"
#include "trace/path.h"
#include "trace/ray_counts.h"
#include "trace/trace_view.h"

namespace shoal {

struct TraceIn {
  const SceneView& scene;
  const TraceView& trace;
  const ViewState& view;
  const FrameGrids& grids;
  const std::vector<WaterOptics>& water;
  const MethodState& state;
  bool reflects_scene;  // --reflections: reflected rays hit the scene
  PostSettings post;
};
struct TraceOut {
  VisibilityBuffer& direct;  // ids, and where the sample is captured depths, as the direct pass would leave them
  GBuffer& gbuffer;          // written where the sample is captured, as the two below
  HitPoints& hits;
  InterfaceTarget& interface;
  LitBuffer& lit;
  std::uint8_t* srgb8;
  RayCounts& counts;            // added to
  std::uint64_t& water_pixels;  // added to, from all threads
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

// Traces the pixels of one region of the frame.
void trace_region(const TraceIn& in, const TraceLimits& limits, const TraceOut& out, std::size_t region);

}  // namespace shoal::inline SHOAL_ISA_NS
