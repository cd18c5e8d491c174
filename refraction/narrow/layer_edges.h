// The edges of a layer: beside them the triangle that a pixel's centre shows may not be the one that its ray hits.
#pragma once

#include "raster/visibility.h"
#include "refraction/data/edge_map.h"

namespace shoal::inline SHOAL_ISA_NS {

// Which blocks of a 64-pixel region have an edge.
struct EdgeBlocks {
  static constexpr int kAcross = kRegionSize / kBlockSize;
  std::uint16_t row[kAcross];          // bit i: block i has an edge within a pixel
  bool at(int x_px, int y_px) const {  // a pixel of the frame, or of the layer
    return (row[y_px / kBlockSize % kAcross] >> (x_px / kBlockSize % kAcross) & 1) != 0;
  }
};

// Finds the edges of one region of the layer's grid; pixels outside of the layer, and of regions that are not drawn,
// count as the border does.
//   layer   depth as drawn, larger is nearer;  region  of layer.grid
//   drawn   [regions] 0: not drawn; null: all regions around this one are
//   min_step  of an edge, as a share of the depth
// Source: a plane's depth is linear on the screen, so its second differences are 0; what counts as an edge is ours.
// Error: none in exact planes and steps (tests/refraction/test_layer_edges.cpp); smaller steps are no edges.
EdgeBlocks find_edges(const VisibilityBuffer& layer, std::size_t region, const std::int32_t* drawn = nullptr,
                      float min_step = 0.001f);

// The same into a map, of edges that may hide something from a bent ray: steps of 0.1 % of the depth. Larger
// ones alone would cost less and miss more: at 0.4 %, 0.34 instead of 0.30 % wrong objects in the pool.
void find_edges(const VisibilityBuffer& layer, const std::int32_t* drawn, EdgeMap& map, std::size_t region);

}  // namespace shoal::inline SHOAL_ISA_NS
