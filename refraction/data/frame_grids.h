// The grids of a frame: pixels in blocks and regions, tiles, and the same of the layers of a body of water.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/blocked_image.h"
#include "raster/bin.h"

namespace shoal {

// The grid of the refracted and the reflected layer: that of the frame, or, where a method samples the lit layer along
// bent rays, with a margin on each side. Margins are whole regions, so that a block of the frame is a block of the
// layer.
struct LayerGrid {
  FrameGrid grid;
  BinGrid tiles, regions;
  int margin_px = 0;
  // Offset of the block at a pixel of the frame.
  std::size_t offset(int x_px, int y_px) const {
    return grid.block_offset((x_px + margin_px) >> 2, (y_px + margin_px) >> 2);
  }
  // The layer's region that is a region of the frame.
  std::size_t region(const FrameGrid& frame, std::size_t of_frame) const {
    const std::size_t margin = static_cast<std::size_t>(margin_px / kRegionSize),
                      across = static_cast<std::size_t>(frame.regions_x);
    return (of_frame / across + margin) * static_cast<std::size_t>(grid.regions_x) + of_frame % across + margin;
  }
};

// Which regions of a body's layers are drawn: [regions of the layers' grid] 0: not drawn.
struct LayerRegions {
  std::vector<std::int32_t> drawn;
  std::vector<std::int32_t> behind[2];  // [WaterPassKind] the second layers
  std::vector<std::int32_t> lit;        // the lit layer of an image-space method: LitState
  void resize(const LayerGrid& layers) {
    lit.resize(layers.grid.region_count());
    drawn.resize(layers.grid.region_count());
    for (std::vector<std::int32_t>& regions : behind) regions.resize(layers.grid.region_count());
  }
};

// The margin of layers that are sampled along bent rays, pixels.
inline constexpr int kWaveMargin_px = 64;

struct FrameGrids {
  FrameGrid frame;
  BinGrid tiles;
  LayerGrid layers;
  std::size_t tile_count() const {
    return static_cast<std::size_t>(tiles.tiles_x) * static_cast<std::size_t>(tiles.tiles_y);
  }
  std::size_t layer_tile_count() const {
    return static_cast<std::size_t>(layers.tiles.tiles_x) * static_cast<std::size_t>(layers.tiles.tiles_y);
  }
};

//   tile_px          a power of two, 16 to 256
//   layer_margin_px  0 or kWaveMargin_px
inline FrameGrids make_frame_grids(int width_px, int height_px, int tile_px, int layer_margin_px) {
  FrameGrids g;
  g.frame = make_frame_grid(width_px, height_px);
  g.tiles = make_bin_grid(width_px, height_px, tile_px);
  LayerGrid& layers = g.layers;
  layers.margin_px = layer_margin_px;
  layers.grid = make_frame_grid(width_px + 2 * layer_margin_px, height_px + 2 * layer_margin_px);
  layers.tiles = make_bin_grid(layers.grid.width_px, layers.grid.height_px, tile_px);
  layers.regions = make_bin_grid(layers.grid.width_px, layers.grid.height_px, kRegionSize);
  return g;
}

}  // namespace shoal
