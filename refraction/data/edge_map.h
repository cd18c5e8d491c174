// Where a layer has edges: a bit for each 4 x 4 block.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/blocked_image.h"

namespace shoal {

class EdgeMap {
 public:
  void resize(const FrameGrid& grid) {
    regions_x_ = grid.regions_x, blocks_x_ = grid.blocks_x, blocks_y_ = grid.blocks_y;
    rows_.resize(static_cast<std::size_t>(regions_x_) * static_cast<std::size_t>(blocks_y_));
  }

  // One row of sixteen blocks of a region; no two threads write the same region.
  //   row  of blocks within the region;  blocks  bit i: block i has an edge
  void set(std::size_t region, int row, std::uint16_t blocks) {
    const std::size_t across = static_cast<std::size_t>(regions_x_);
    rows_[((region / across) * kAcross + static_cast<std::size_t>(row)) * across + region % across] = blocks;
  }

  // No edges in a region.
  void clear(std::size_t region) {
    for (int row = 0; row < kAcross; ++row) set(region, row, 0);
  }

  // Is there an edge in a rectangle of the layer's pixels, widened to whole blocks? Both ends are included; what lies
  // outside of the layer has none.
  bool any_within(int x0_px, int y0_px, int x1_px, int y1_px) const {
    const int x0 = std::max(x0_px >> 2, 0), x1 = std::min(x1_px >> 2, blocks_x_ - 1);
    const int y0 = std::max(y0_px >> 2, 0), y1 = std::min(y1_px >> 2, blocks_y_ - 1);
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1;) {
        const int end = std::min(x1, x | (kAcross - 1));  // the last block of the rectangle in this region
        const std::uint32_t wanted = (2u << (end & (kAcross - 1))) - (1u << (x & (kAcross - 1)));
        if ((rows_[static_cast<std::size_t>(y * regions_x_ + x / kAcross)] & wanted) != 0) return true;
        x = end + 1;
      }
    return false;
  }

 private:
  static constexpr int kAcross = kRegionSize / kBlockSize;
  int regions_x_ = 0, blocks_x_ = 0, blocks_y_ = 0;
  std::vector<std::uint16_t> rows_;  // [blocks_y_][regions_x_]
};

}  // namespace shoal
