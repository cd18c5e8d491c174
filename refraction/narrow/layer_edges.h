// Where a layer has edges, and how near what stands there is: rays that pass in front of all of it are not hidden by
// anything that the layer shows, nor by what its samples have only just missed.
//
// Cost: 2.6 to 5.3 ms for both layers of a 1920 x 1080 frame on two threads (stage water.edges of `--json`), only where
//       waves bend rays.
#pragma once

#include "core/blocked_image.h"
#include "raster/visibility.h"

namespace shoal {

struct LayerEdges {
  // Rows of the layer's padded size: the nearest depth within a pixel of it where that much is not one smooth surface,
  // 0 (infinitely far) where it is.
  AlignedArray<float> pixel;
  AlignedArray<float> block;  // the nearest of each 4 x 4, rows of blocks
  int stride = 0, blocks_x = 0;
  void resize(const FrameGrid& grid) {
    stride = grid.regions_x * kRegionSize, blocks_x = grid.blocks_x;
    pixel.resize(grid.pixel_slots());
    block.resize(grid.block_count());
  }
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

// Fills one 64-pixel region of the layer's grid; outside of the layer counts as its border does.
//   layer  depth as drawn, larger is nearer; region  of layer.grid
// Source: a plane's depth is linear on the screen, so its second differences are 0; what counts as an edge is ours.
// Error: none in exact planes and steps (tests/refraction/test_triangle_tree.cpp); steps of less than a thousandth of
//        the depth are no edges.
void find_edges(const VisibilityBuffer& layer, LayerEdges& edges, std::size_t region);

}  // namespace shoal::inline SHOAL_ISA_NS
