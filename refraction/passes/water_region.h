// Where each body of water is seen from the eye, and which part of its layers is drawn.
#pragma once

#include <vector>

#include "refraction/data/edge_map.h"
#include "refraction/data/frame_grids.h"
#include "refraction/data/view_state.h"
#include "refraction/data/water_pass.h"
#include "refraction/passes/interface_pass.h"

namespace shoal {

struct PlaceWaterIn {
  std::span<const PlacedWater> water;
  const View& view;
  BroadPhase (*map)(const WaterBody&, const View&);  // of the method
  Reflections reflections;                           // of every surface
  Reflections total;                                 // of surfaces whose mirror is total, where the others reflect the
                                                     // background alone
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
  std::vector<std::uint8_t> of_body;  // [regions of the frame] 1: shows the body, or borders on water pixels
  LayerRegions layers;
  std::vector<std::int32_t> tile_active;  // [tiles of the layers] 1: overlaps such a region
  void resize(const FrameGrids& grids) {
    of_body.resize(grids.frame.region_count());
    layers.resize(grids.layers);
    tile_active.resize(grids.layer_tile_count());
  }
};

struct FindRegionIn {
  const FrameGrids& grids;
  const ViewState& view;
  const WaterOptics& optics;
  const std::vector<WaterCount>& counts;  // [regions of the frame]
  bool whole_layer;                       // the layer may be sampled anywhere: all of it is drawn
  int widened;                            // regions that the layers reach beyond the body's own on each side
};
struct FindRegionOut {
  WaterRegions& regions;
  WaterPass& refracted;  // the body's refracted pass, bounded by the regions
};
// Finds what the narrow phase can reach of a body: its visible pixels and a margin, on the fixed 64-pixel grid. Returns
// the number of its pixels; where that is 0 nothing is written.
std::uint64_t find_region(const FindRegionIn& in, const FindRegionOut& out);

// Does a tile of the layers overlap a marked region?
//   regions  [regions of the layers] 0: not marked
bool tile_overlaps(const LayerGrid& layers, const std::vector<std::int32_t>& regions, std::size_t tile);

// The regions whose second layer is wanted: drawn ones with an edge in them or near.
//   drawn  [regions of the layers] 0: not drawn;  behind  [the same] written: 1: wanted
void find_behind_regions(const LayerGrid& layers, const std::vector<std::int32_t>& drawn, const EdgeMap& edges,
                         std::vector<std::int32_t>& behind);

// The planar reflection pass of the same body and bounds: the eye's side of the plane, mirrored.
WaterPass reflected_pass(const WaterPass& refracted);

}  // namespace shoal
