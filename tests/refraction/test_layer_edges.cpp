// The edges of a layer against depths whose edges are known.
#include <catch2/catch.hpp>

#include "refraction/narrow/layer_edges.h"

using namespace shoal;

namespace {

void fill(VisibilityBuffer& layer, float (*depth_at)(int x, int y)) {
  for (int y = 0; y < layer.grid.height_px; ++y)
    for (int x = 0; x < layer.grid.width_px; ++x) layer.depth[layer.grid.slot(x, y)] = depth_at(x, y);
}

}  // namespace

TEST_CASE("layer edges: planes have none, steps have them a pixel wide on either side", "[refraction]") {
  VisibilityBuffer layer;
  layer.resize(make_frame_grid(150, 90));
  // Is any pixel of the block one for which `expected` holds?
  const auto check_blocks = [&](auto expected) {
    int edges = 0;
    for (int by = 0; by < 22; ++by)
      for (int bx = 0; bx < 37; ++bx) {
        bool wanted = false;
        for (int k = 0; k < 16; ++k) wanted = wanted || expected(4 * bx + k % 4, 4 * by + k / 4);
        const std::size_t region = static_cast<std::size_t>(by / 16 * layer.grid.regions_x + bx / 16);
        INFO(bx << ", " << by);
        REQUIRE(find_edges(layer, region).at(4 * bx, 4 * by) == wanted);
        edges += wanted;
      }
    return edges;
  };
  // A steep plane: exactly linear in float. At the layer's border it bends: what is beyond is as there.
  fill(layer, [](int x, int y) { return 0.25f + static_cast<float>(x) * 0x1p-10f + static_cast<float>(y) * 0x1p-9f; });
  check_blocks([](int x, int y) { return x == 0 || y == 0 || x == 149 || y == 89; });
  // A nearer square, across regions, before a far plane and before nothing.
  static float behind;
  for (const float far_depth : {0.25f, 0.0f}) {
    behind = far_depth;
    fill(layer, [](int x, int y) { return x >= 50 && x < 82 && y >= 20 && y < 70 ? 0.5f : behind; });
    const int edges = check_blocks([](int x, int y) {
      const bool near_square = x >= 49 && x <= 82 && y >= 19 && y <= 70;
      const bool well_inside = x >= 51 && x < 81 && y >= 21 && y < 69;
      return near_square && !well_inside;
    });
    REQUIRE(edges > 20);
  }
}
