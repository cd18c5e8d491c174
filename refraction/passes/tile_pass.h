// Bins to visibility, tile by tile, and the alpha tests of the passes.
#pragma once

#include "raster/pass_bins.h"
#include "raster/visibility.h"
#include "refraction/data/frame_grids.h"
#include "refraction/data/pixel_rays.h"
#include "shading/shading_view.h"

namespace shoal {

// What an alpha test reads.
struct AlphaTestIn {
  const ShadingView& shading;
  const View& view;
  const FrameGrid& frame;
  const WaterOptics* optics;    // of a water pass, else null
  PixelRaysFunction refracted;  // of a refracted pass: the rays that the method's pixels follow
  const void* options;          // of the method
};
// The covered pixels (bit i: lane i of the block at x_px, y_px of the frame) that the material of an alpha-tested
// triangle keeps where the pass's rays hit it.
using AlphaTestFunction = std::uint32_t (*)(const AlphaTestIn&, std::int32_t id, int x_px, int y_px,
                                            std::uint32_t cover);

struct TilePassIn {
  const PassBins* first;  // drawn before the others, or null
  const PassBins& bins;
  const BinGrid& tiles;
  int margin_px;  // of the pass's grid around the frame
  AlphaTestFunction alpha_test;
  AlphaTestIn alpha;
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

// Clears one tile and draws the bins into it.
void draw_tile(const TilePassIn& in, VisibilityBuffer& out, std::size_t tile);

// The bins over a tile that is drawn already.
//   under  copied to `out`, of the same grid, before the bins are drawn
void draw_tile_over(const TilePassIn& in, const VisibilityBuffer& under, VisibilityBuffer& out, std::size_t tile);

// Bins into the second layer: `first` and `bins`.
//   nearest  the tile as draw_tile left it
void draw_tile_behind(const TilePassIn& in, const VisibilityBuffer& nearest, VisibilityBuffer& out, std::size_t tile);

// Where straight view rays hit the triangle.
std::uint32_t direct_alpha_test(const AlphaTestIn&, std::int32_t id, int x_px, int y_px, std::uint32_t cover);
// Where the rays hit it that the method's pixels follow through flat water: the layer shows flat water's view of the
// scene, whatever the waves are.
std::uint32_t refracted_alpha_test(const AlphaTestIn&, std::int32_t id, int x_px, int y_px, std::uint32_t cover);
// Where the rays hit it that flat water reflects.
std::uint32_t reflected_alpha_test(const AlphaTestIn&, std::int32_t id, int x_px, int y_px, std::uint32_t cover);

}  // namespace shoal::inline SHOAL_ISA_NS
