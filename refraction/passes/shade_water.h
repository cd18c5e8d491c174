// The light of the water pixels of one body: what its refracted and reflected rays show, by Fresnel.
#pragma once

#include "refraction/data/frame_grids.h"
#include "refraction/data/pixel_rays.h"
#include "refraction/data/targets.h"
#include "refraction/data/view_state.h"
#include "scene/scene_view.h"
#include "trace/path.h"
#include "trace/trace_view.h"

namespace shoal {

// Rays that cross a secondary water interface, another body or a crest of the same: a shared stage, outside of the
// methods, that traces them on.
struct SecondaryIn {
  const SceneView& scene;
  const TraceView& trace;
  const ViewState& view;
  const FrameGrids& grids;
  const WaterOptics& optics;
  const WaterInterface& interface;
  const HitBlock* hits;
  bool refracted;                   // the method's refracted rays have hits (an image-space method's have not)
  PixelRaysFunction rays;           // refracted, of the method
  PixelRaysFunction own_reflected;  // a method's own reflected rays, or null
  const void* options;
  bool reflects_scene;  // --reflections: the paths' reflected rays hit the scene
};
struct SecondaryOut {
  SecondaryBlock* light;
  HitPoints& hits;  // written where the sample is captured
};

struct ShadeWaterIn {
  const SceneView& scene;
  const ViewState& view;
  const FrameGrids& grids;
  const WaterOptics& optics;
  const WaterInterface& interface;
  const HitBlock* hits;
  const FetchedBlock* fetched;  // of an image-space method, else null
  const SecondaryBlock* secondary;
  const BlendLayer* blended_refracted;  // null in a scene without blended materials
  const BlendLayer* blended_reflected;
  PixelRaysFunction rays;           // refracted, of the method
  PixelRaysFunction own_reflected;  // a method's own reflected rays, or null
  const void* options;
  bool misses;  // the method may find nothing where there is something
};
struct ShadeWaterOut {
  WaterLight& light;
  HitPoints& hits;  // written where the sample is captured
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

void trace_secondary_interfaces(const SecondaryIn& in, const SecondaryOut& out, std::size_t region);

void shade_water(const ShadeWaterIn& in, const ShadeWaterOut& out, std::size_t region);

}  // namespace shoal::inline SHOAL_ISA_NS
