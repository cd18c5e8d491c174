// The interface stage: where each water pixel's view ray crosses the surface, and the rays that continue from there.
#pragma once

#include "raster/visibility.h"
#include "refraction/data/frame_grids.h"
#include "refraction/data/targets.h"
#include "refraction/data/view_state.h"
#include "refraction/data/water_pass.h"
#include "scene/scene_view.h"

namespace shoal {

struct InterfaceIn {
  const SceneView& scene;
  const ViewState& view;
  const FrameGrid& frame;
  const WaterOptics& optics;
  const VisibilityBuffer& direct;  // which pixels show the body
};
struct InterfaceOut {
  WaterInterface& interface;  // of the region
  // Written where the sample is captured: the interface, and what the G-buffer and the hit buffers hold of it.
  InterfaceTarget& target;
  GBuffer& gbuffer;
  HitPoints& hits;
};

// What the stage that counts water pixels finds in one region.
struct WaterCount {
  std::uint32_t pixels = 0;
  // Bit 0: some pixel shows the body; bits 1 to 4: some within 4 px of the left, right, top, bottom side do.
  std::uint8_t flags = 0;
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

// The water pixels of a body in one region of the frame.
WaterCount count_water(const VisibilityBuffer& direct, std::int32_t body, std::size_t region);

// The interface of one region's water pixels. Fresnel's reflectance is the mean over the waves that a pixel hides.
void find_interface(const InterfaceIn& in, const InterfaceOut& out, std::size_t region);

}  // namespace shoal::inline SHOAL_ISA_NS
