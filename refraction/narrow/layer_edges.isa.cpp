// Edge detection in a layer (refraction/narrow/layer_edges.h).
#include "refraction/narrow/layer_edges.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

// Depth as drawn is linear over a plane, so its second differences are 0 there; at an edge they are the step. Steps are
// compared with a share of the nearest depth: of perspective's depth, which goes as the inverse of the distance, the
// same share of the distance.
constexpr float kMinHidingStep = 0.001f;

// A region and a pixel around it, by rows: pixel (x, y) of the region is at[y + 1][kFirst + x].
constexpr int kFirst = 4, kRow = kRegionSize + 32;
using Rows = float[kRegionSize + 2][kRow];

// Are all regions around one drawn?
bool all_drawn_around(const FrameGrid& grid, int x0, int y0, const std::int32_t* drawn) {
  if (x0 == 0 || y0 == 0 || x0 + kRegionSize >= grid.width_px || y0 + kRegionSize >= grid.height_px) return false;
  if (drawn == nullptr) return true;
  for (int y = y0 / kRegionSize - 1; y <= y0 / kRegionSize + 1; ++y)
    for (int x = x0 / kRegionSize - 1; x <= x0 / kRegionSize + 1; ++x)
      if (drawn[y * grid.regions_x + x] == 0) return false;
  return true;
}

// Pixels beyond the layer, or of regions that are not drawn, repeat the border.
void copy_rows(const VisibilityBuffer& layer, int x0, int y0, const std::int32_t* drawn, Rows& at) {
  const FrameGrid& grid = layer.grid;
  const float* depth = layer.depth.data();
  if (all_drawn_around(grid, x0, y0, drawn)) {
    for (int by = -1; by <= kRegionSize / kBlockSize; ++by)
      for (int bx = -1; bx <= kRegionSize / kBlockSize; ++bx) {
        const float* block = depth + grid.block_offset(x0 / kBlockSize + bx, y0 / kBlockSize + by);
        for (int row = 0; row < kBlockSize; ++row) {
          const int y = by * kBlockSize + row + 1;
          if (y < 0 || y >= kRegionSize + 2) continue;
          for (int column = 0; column < kBlockSize; ++column)
            at[y][kFirst + bx * kBlockSize + column] = block[row * kBlockSize + column];
        }
      }
    return;
  }
  for (int y = -1; y <= kRegionSize; ++y)
    for (int x = -1; x <= kRegionSize; ++x) {
      int px = max(min(x0 + x, grid.width_px - 1), 0), py = max(min(y0 + y, grid.height_px - 1), 0);
      if (drawn != nullptr && drawn[py / kRegionSize * grid.regions_x + px / kRegionSize] == 0)
        px = max(min(px, x0 + kRegionSize - 1), x0), py = max(min(py, y0 + kRegionSize - 1), y0);
      at[y + 1][kFirst + x] = depth[grid.slot(px, py)];
    }
}

// Sixteen pixels of a row.
SHOAL_INLINE WideM at_edge(const Rows& at, int x, int y, float min_step) {
  const auto depth = [&](int dx, int dy) SHOAL_LAMBDA { return WideF::load(&at[y + 1 + dy][kFirst + x + dx]); };
  const WideF middle = depth(0, 0), twice = middle + middle;
  WideF nearest = middle, bend(0.0f);
  const auto across = [&](int dx, int dy) SHOAL_LAMBDA {
    const WideF a = depth(-dx, -dy), b = depth(dx, dy);
    nearest = max(nearest, max(a, b));
    bend = max(bend, abs((a + b) - twice));
  };
  across(1, 0), across(0, 1), across(1, 1), across(1, -1);
  return bend > nearest * WideF(min_step);
}

}  // namespace

EdgeBlocks find_edges(const VisibilityBuffer& layer, std::size_t region, const std::int32_t* drawn, float min_step) {
  const FrameGrid& grid = layer.grid;
  const int x0 = static_cast<int>(region % static_cast<std::size_t>(grid.regions_x)) * kRegionSize;
  const int y0 = static_cast<int>(region / static_cast<std::size_t>(grid.regions_x)) * kRegionSize;
  alignas(64) Rows at;
  copy_rows(layer, x0, y0, drawn, at);
  EdgeBlocks found{};
  for (int y = 0; y < kRegionSize; y += kBlockSize)
    for (int x = 0; x < kRegionSize; x += 16) {
      WideM any_row = at_edge(at, x, y, min_step);
      for (int row = y + 1; row < y + kBlockSize; ++row) any_row = any_row | at_edge(at, x, row, min_step);
      std::uint32_t pixels = to_bits(any_row);
      for (int block = x / kBlockSize; pixels != 0; ++block, pixels >>= kBlockSize)
        if ((pixels & 0xFu) != 0) found.row[y / kBlockSize] |= static_cast<std::uint16_t>(1u << block);
    }
  return found;
}

void find_edges(const VisibilityBuffer& layer, const std::int32_t* drawn, EdgeMap& map, std::size_t region) {
  const EdgeBlocks found = find_edges(layer, region, drawn, kMinHidingStep);
  for (int row = 0; row < EdgeBlocks::kAcross; ++row) map.set(region, row, found.row[row]);
}

}  // namespace shoal::inline SHOAL_ISA_NS
