// The 4 x 4 pixel blocks of a frame: sixteen pixels, one a lane, and the rays of a camera through them.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/blocked_image.h"
#include "core/ray.h"
#include "core/wide/lanes.h"
#include "raster/bin.h"
#include "raster/camera.h"

namespace shoal {

// First pixel of a 64-pixel region.
struct RegionOrigin {
  int x_px, y_px;
};

//   region  0 to grid.region_count() - 1, row by row
SHOAL_INLINE RegionOrigin region_origin(const FrameGrid& grid, std::size_t region) {
  const std::size_t across = static_cast<std::size_t>(grid.regions_x);
  return {static_cast<int>(region % across) * kRegionSize, static_cast<int>(region / across) * kRegionSize};
}

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

// Lane i of a block is pixel (i & 3, i >> 2) of it.
SHOAL_INLINE WideI block_x() { return lane_index() & WideI(3); }
SHOAL_INLINE WideI block_y() { return lane_index() >> 2; }

// One 4 x 4 block of the frame.
struct Block {
  int x_px, y_px;      // of its first pixel
  std::size_t offset;  // of its first slot in blocked buffers
  WideM in_frame;
};

//   x_px, y_px  of the block's first pixel: multiples of 4
SHOAL_INLINE Block make_block(const FrameGrid& grid, int x_px, int y_px) {
  const WideI x = WideI(x_px) + block_x(), y = WideI(y_px) + block_y();
  return {x_px, y_px, grid.block_offset(x_px >> 2, y_px >> 2),
          (x < WideI(grid.width_px)) & (y < WideI(grid.height_px))};
}

// Calls body(Block) for each block of a 64-pixel region that has pixels of the frame, row by row.
template <class Body>
SHOAL_INLINE void for_each_block(const FrameGrid& grid, std::size_t region, Body body) {
  const RegionOrigin first = region_origin(grid, region);
  const int x1 = min(first.x_px + kRegionSize, grid.width_px), y1 = min(first.y_px + kRegionSize, grid.height_px);
  for (int y = first.y_px; y < y1; y += kBlockSize)
    for (int x = first.x_px; x < x1; x += kBlockSize) body(make_block(grid, x, y));
}

// Slots in blocked buffers of sixteen pixels anywhere in the padded frame.
SHOAL_INLINE WideI pixel_slots(const FrameGrid& grid, WideI x_px, WideI y_px) {
  const WideI block = (y_px >> 2) * WideI(grid.blocks_x) + (x_px >> 2);
  return (block << 4) + ((y_px & WideI(3)) << 2) + (x_px & WideI(3));
}

// The rays through the samples of a block's pixels.
SHOAL_INLINE Ray<WideF> block_rays(const View& view, const Block& block) {
  return pixel_ray(view, to_float(WideI(block.x_px) + block_x()) + WideF(0.5f),
                   to_float(WideI(block.y_px) + block_y()) + WideF(0.5f));
}

// The lanes whose visible id is a triangle's, not of water and not kNoId.
SHOAL_INLINE WideM is_triangle(WideI id) { return (id >= WideI(0)) & (id != WideI(kNoId)); }

}  // namespace shoal::inline SHOAL_ISA_NS
