// The edges of a layer: beside them the triangle that a pixel's centre shows may not be the one that its ray hits.
#pragma once

#include "raster/visibility.h"

namespace shoal::inline SHOAL_ISA_NS {

// Which blocks of a 64-pixel region have an edge.
struct EdgeBlocks {
  static constexpr int kAcross = kRegionSize / kBlockSize;
  std::uint16_t row[kAcross];          // bit i: block i has an edge within a pixel
  bool at(int x_px, int y_px) const {  // a pixel of the frame, or of the layer
    return (row[y_px / kBlockSize % kAcross] >> (x_px / kBlockSize % kAcross) & 1) != 0;
  }
};

// Finds the edges of one region of the layer's grid; pixels outside of the layer count as its border does.
//   layer  depth as drawn, larger is nearer; region  of layer.grid
// Source: a plane's depth is linear on the screen, so its second differences are 0; what counts as an edge is ours.
// Error: none in exact planes and steps (tests/refraction/test_layer_edges.cpp); steps of less than a thousandth of
//        the depth are no edges.
EdgeBlocks find_edges(const VisibilityBuffer& layer, std::size_t region);

}  // namespace shoal::inline SHOAL_ISA_NS
