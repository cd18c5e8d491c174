// The second layer of a view: at each pixel the nearest triangle behind the one that is visible.
//
// Source  Everitt 2001 (depth peeling), one layer.
// Differs Exact: fragments are ordered by (depth, id), and the visible triangle itself, which may be drawn in pieces,
// is
//         not behind itself.
#pragma once

#include "raster/fragments.h"

namespace shoal::inline SHOAL_ISA_NS {

// Receives the covered blocks of a TileRaster.
//   AlphaTest  as TileRaster's
template <class AlphaTest>
class BehindCollector {
 public:
  static constexpr bool kTests = AlphaTest::kTests;
  //   nearest  the visible triangles;  behind  of the same grid, cleared
  SHOAL_INLINE BehindCollector(const VisibilityBuffer& nearest, VisibilityBuffer& behind, const AlphaTest& alpha)
      : nearest_(nearest), behind_(behind), alpha_(alpha) {}

  SHOAL_INLINE WideM operator()(std::int32_t id, int x_px, int y_px, WideM cover) const {
    return alpha_(id, x_px, y_px, cover);
  }

  __attribute__((noinline)) void fragment(std::int32_t triangle, int block_col, int block_row, WideM cover,
                                          WideF depth) const {
    const std::size_t at = nearest_.grid.block_offset(block_col, block_row);
    const WideI id(triangle), visible = WideI::load(nearest_.id.data() + at);
    const WideF visible_depth = WideF::load(nearest_.depth.data() + at);
    float* depth_at = behind_.depth.data() + at;
    std::int32_t* id_at = behind_.id.data() + at;
    const WideM kept = cover & (id != visible) & in_front(visible_depth, visible, depth, id) &
                       in_front(depth, id, WideF::load(depth_at), WideI::load(id_at));
    if (none(kept)) return;
    store_masked(depth_at, depth, kept);
    store_masked(id_at, id, kept);
  }

 private:
  const VisibilityBuffer& nearest_;
  VisibilityBuffer& behind_;
  const AlphaTest& alpha_;
};

}  // namespace shoal::inline SHOAL_ISA_NS
