#include "raster/bin.h"

namespace shoal {

BinGrid make_bin_grid(int width_px, int height_px, int tile_px) {
  BinGrid g;
  g.tile_px = tile_px;
  g.tile_shift = 0;
  while ((1 << g.tile_shift) < tile_px) ++g.tile_shift;
  // With many small tiles the empty bins would need more memory than the triangles. Results do not depend on tile
  // sizes.
  auto tiles = [&] {
    g.tiles_x = (width_px + g.tile_px - 1) >> g.tile_shift;
    g.tiles_y = (height_px + g.tile_px - 1) >> g.tile_shift;
    return static_cast<long long>(g.tiles_x) * g.tiles_y;
  };
  while (tiles() > 65536) {
    g.tile_px *= 2;
    ++g.tile_shift;
  }
  return g;
}

void WorkItemBins::clear() {
  packets.clear();
  large.clear();
  entries.clear();
  sorted.clear();
  triangles_in = triangles_out = subdivision_capped = 0;
}

void WorkItemBins::sort_by_tile(const BinGrid& grid) {
  const std::size_t tiles = static_cast<std::size_t>(grid.tiles_x) * static_cast<std::size_t>(grid.tiles_y);
  tile_first.resize(tiles + 1);
  for (std::size_t t = 0; t <= tiles; ++t) tile_first[t] = 0;
  for (std::size_t i = 0; i < entries.size(); ++i) ++tile_first[entries[i].tile + 1];
  for (std::size_t t = 0; t < tiles; ++t) tile_first[t + 1] += tile_first[t];
  sorted.resize(entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) sorted[tile_first[entries[i].tile]++] = entries[i];
  // The loop above moved each start to the next tile's: shift them back.
  for (std::size_t t = tiles; t > 0; --t) tile_first[t] = tile_first[t - 1];
  tile_first[0] = 0;
}

}  // namespace shoal
