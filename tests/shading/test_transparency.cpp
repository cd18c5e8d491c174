// A layer of blended fragments: stored and loaded as it was, and laid over what is behind against double precision.
#include "shading/transparency.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>

using namespace shoal;

namespace {

BlendLayer empty_layer(const FrameGrid& grid) {
  BlendLayer layer;
  layer.resize(grid);
  std::fill_n(layer.filled.data(), layer.filled.size(), std::uint8_t{0});
  return layer;
}
WideF ramp(float first, float step) { return to_float(lane_index()) * WideF(step) + WideF(first); }

}  // namespace

TEST_CASE("a blended layer changes the blocks that were stored, and lays light over what is behind") {
  const FrameGrid grid = make_frame_grid(70, 20);
  BlendLayer layer = empty_layer(grid);
  const Block block = make_block(grid, 68, 4), other = make_block(grid, 64, 4);
  CHECK(to_bits(block.in_frame) == 0x3333u);  // two columns of four

  BlendLanes stored;
  stored.light = {ramp(0.0f, 0.1f), ramp(1.0f, 0.2f), ramp(2.0f, 0.3f)};
  stored.transmittance = ramp(0.0f, 1.0f / 16);
  store_layer(layer, block, stored);
  const BlendLanes loaded = load_layer(layer, block), nothing = load_layer(layer, other);
  const WideM lanes = mask_from_bits(0x00FFu);
  Vec3<WideF> behind{WideF(3.0f), WideF(2.0f), WideF(1.0f)}, untouched = behind;
  WideF covered(0.25f), untouched_cover = covered;
  lay_over(layer, block, lanes, behind, &covered);
  lay_over(layer, other, lanes, untouched, &untouched_cover);
  for (int i = 0; i < 16; ++i) {
    CHECK(extract(loaded.light.z, i) == extract(stored.light.z, i));
    CHECK(extract(loaded.transmittance, i) == extract(stored.transmittance, i));
    CHECK(extract(nothing.light.x, i) == 0.0f);
    CHECK(extract(nothing.transmittance, i) == 1.0f);
    CHECK(extract(untouched.x, i) == 3.0f);
    CHECK(extract(untouched_cover, i) == 0.25f);
    const double t = i / 16.0;
    CHECK(extract(behind.x, i) == Approx(i < 8 ? 0.1 * i + 3 * t : 3).margin(1e-6));
    CHECK(extract(behind.y, i) == Approx(i < 8 ? 1 + 0.2 * i + 2 * t : 2));
    CHECK(extract(covered, i) == Approx(i < 8 ? 1 - t * 0.75 : 0.25));
  }
  lay_over(layer, block, lanes, behind, nullptr);
}
