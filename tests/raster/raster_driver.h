// The pipeline as a user of the library drives it: a geometry, a vertex program, tiles, visible ids.
// docs/tutorials/programs.md walks through it; the raster tests use it too.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "raster/front_end.h"
#include "raster/geometry_view.h"
#include "raster/visibility.h"

namespace shoal_test {

using namespace shoal;

// A pass over the whole frame, pixel (0, 0) top left.
inline PassSettings whole_frame(int width_px, int height_px, Vec2f centre_px, int tile_px) {
  PassSettings pass;
  pass.width_px = width_px, pass.height_px = height_px;
  pass.centre_px = centre_px;
  pass.grid = make_bin_grid(width_px, height_px, tile_px);
  pass.x_max = width_px - 1, pass.y_max = height_px - 1;
  return pass;
}

// Meshlets through the vertex program into bins, `per_work_item` meshlets a work item.
//   draw_states  one a material
template <class Program>
std::vector<WorkItemBins> bin_geometry(const Geometry& g, const std::vector<DrawState>& draw_states,
                                       const Program& program, const PassSettings& pass, std::uint32_t per_work_item) {
  const GeometryView view = view_of(g, draw_states.data());
  const std::uint32_t meshlets = static_cast<std::uint32_t>(g.meshlets.size());
  std::vector<WorkItemBins> work_items((meshlets + per_work_item - 1) / per_work_item);
  for (std::uint32_t i = 0; i < work_items.size(); ++i) {
    const std::uint32_t first = i * per_work_item;
    FrontEnd<Program>(view, program, pass, work_items[i]).run(first, std::min(first + per_work_item, meshlets), kNoId);
  }
  return work_items;
}

// Bins to visible ids and depths. `alpha` cuts pixels of alpha-tested materials (KeepAll: none).
template <class AlphaTest>
void draw_tiles(const std::vector<WorkItemBins>& work_items, const PassSettings& pass, const AlphaTest& alpha,
                VisibilityBuffer& out) {
  const BinGrid& grid = pass.grid;
  out.resize(make_frame_grid(pass.width_px, pass.height_px));
  for (int ty = 0; ty < grid.tiles_y; ++ty)
    for (int tx = 0; tx < grid.tiles_x; ++tx) {
      const int x0 = tx * grid.tile_px, y0 = ty * grid.tile_px;
      TileRaster<AlphaTest> raster(out, alpha, x0, y0, std::min(x0 + grid.tile_px, pass.width_px),
                                   std::min(y0 + grid.tile_px, pass.height_px));
      raster.clear();
      for (const WorkItemBins& bins : work_items) raster.draw(bins, static_cast<std::uint32_t>(ty * grid.tiles_x + tx));
    }
}

}  // namespace shoal_test
