// Where each body of water is seen from the eye, and which part of its layers is drawn.
#pragma once

#include <vector>

#include "refraction/data/frame_grids.h"
#include "refraction/data/view_state.h"
#include "refraction/data/water_pass.h"
#include "refraction/passes/interface_pass.h"

namespace shoal {

struct PlaceWaterIn {
  std::span<const PlacedWater> water;
  const View& view;
  BroadPhase (*map)(const WaterBody&, const View&);  // of the method
  bool reflects_scene;                               // --reflections: every surface reflects the scene
  bool whole_scene;                                  // the method's layer is the whole scene without water
};
struct PlaceWaterOut {
  std::vector<WaterOptics>& optics;  // one a body, whether it shows or not
  std::int32_t& eye_in_water;        // index of the first body that the eye is in, or -1
};
void place_water(const PlaceWaterIn& in, const PlaceWaterOut& out);

// Is there a body whose surface is displaced?
bool any_displaced(const std::vector<WaterOptics>& water);

// Which parts of frame and layers belong to a body.
struct WaterRegions {
  std::vector<std::uint8_t> of_body;      // [regions of the frame] 1: shows the body, or borders on water pixels
  std::vector<std::uint8_t> layer;        // [regions of the layers] 1: drawn
  std::vector<std::uint8_t> tile_active;  // [tiles of the layers] 1: overlaps such a region
  void resize(const FrameGrids& grids) {
    of_body.resize(grids.frame.region_count());
    layer.resize(grids.layers.grid.region_count());
    tile_active.resize(grids.layer_tile_count());
  }
};

struct FindRegionIn {
  const FrameGrids& grids;
  const ViewState& view;
  const WaterOptics& optics;
  const std::vector<WaterCount>& counts;  // [regions of the frame]
  bool whole_layer;                       // an image-space method may sample the layer anywhere: all of it is drawn
};
struct FindRegionOut {
  WaterRegions& regions;
  WaterPass& refracted;  // the body's refracted pass, bounded by the regions
};
// Finds what the narrow phase can reach of a body: its visible pixels and a margin, on the fixed 64-pixel grid. Returns
// the number of its pixels; where that is 0 nothing is written.
std::uint64_t find_region(const FindRegionIn& in, const FindRegionOut& out);

// The planar reflection pass of the same body and bounds: the eye's side of the plane, mirrored.
WaterPass reflected_pass(const WaterPass& refracted);

}  // namespace shoal
