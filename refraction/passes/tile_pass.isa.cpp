// Bins to visibility (refraction/passes/tile_pass.h).
#include "refraction/passes/tile_pass.h"

#include <cstring>

#include "raster/behind.h"
#include "shading/shade_hits.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

// The pass's alpha test in the form that the tile's rasterizer calls.
struct PassAlpha {
  static constexpr bool kTests = true;
  const TilePassIn& in;
  WideM operator()(std::int32_t id, int x_px, int y_px, WideM cover) const {
    return mask_from_bits(in.alpha_test(in.alpha, id, x_px - in.margin_px, y_px - in.margin_px, to_bits(cover)));
  }
};

template <class Alpha>
SHOAL_INLINE void draw_bins(const TilePassIn& in, const Alpha& alpha, VisibilityBuffer& out, std::size_t tile) {
  const int size = in.tiles.tile_px;
  const int x0 = static_cast<int>(tile % static_cast<std::size_t>(in.tiles.tiles_x)) * size;
  const int y0 = static_cast<int>(tile / static_cast<std::size_t>(in.tiles.tiles_x)) * size;
  TileRaster<Alpha> raster(out, alpha, x0, y0, min(x0 + size, out.grid.width_px), min(y0 + size, out.grid.height_px));
  raster.clear();
  if (in.first != nullptr)
    for (const WorkItemBins& work_item : in.first->work_items) raster.draw(work_item, static_cast<std::uint32_t>(tile));
  for (const WorkItemBins& work_item : in.bins.work_items) raster.draw(work_item, static_cast<std::uint32_t>(tile));
}

}  // namespace

void draw_tile(const TilePassIn& in, VisibilityBuffer& out, std::size_t tile) {
  draw_bins(in, PassAlpha{in}, out, tile);
}

void draw_tile_over(const TilePassIn& in, const VisibilityBuffer& under, VisibilityBuffer& out, std::size_t tile) {
  const int size = in.tiles.tile_px;
  const int x0 = static_cast<int>(tile % static_cast<std::size_t>(in.tiles.tiles_x)) * size;
  const int y0 = static_cast<int>(tile / static_cast<std::size_t>(in.tiles.tiles_x)) * size;
  const int x1 = min(x0 + size, out.grid.width_px), y1 = min(y0 + size, out.grid.height_px);
  const std::size_t row = static_cast<std::size_t>((x1 + 3) / 4 - x0 / 4) * kBlockPixels;
  for (int by = y0 / 4; by < (y1 + 3) / 4; ++by) {
    const std::size_t at = out.grid.block_offset(x0 / 4, by);
    std::memcpy(out.depth.data() + at, under.depth.data() + at, row * sizeof(float));
    std::memcpy(out.id.data() + at, under.id.data() + at, row * sizeof(std::int32_t));
  }
  const PassAlpha alpha{in};
  TileRaster<PassAlpha> raster(out, alpha, x0, y0, x1, y1);
  raster.start_over();
  for (const WorkItemBins& work_item : in.bins.work_items) raster.draw(work_item, static_cast<std::uint32_t>(tile));
}

void draw_tile_behind(const TilePassIn& in, const VisibilityBuffer& nearest, VisibilityBuffer& out, std::size_t tile) {
  const PassAlpha alpha{in};
  draw_bins(in, BehindCollector(nearest, out, alpha), out, tile);
}

std::uint32_t direct_alpha_test(const AlphaTestIn& in, std::int32_t id, int x_px, int y_px, std::uint32_t cover) {
  return alpha_bits(in.shading, block_rays(in.view, make_block(in.frame, x_px, y_px)),
                    pixel_ray_differential<WideF>(in.view), id, cover);
}

std::uint32_t refracted_alpha_test(const AlphaTestIn& in, std::int32_t id, int x_px, int y_px, std::uint32_t cover) {
  WaterOptics still = *in.optics;
  still.water.surface = nullptr;
  InterfaceBlock interface;
  store_interface(exact_ray(eye_side(still), block_rays(in.view, make_block(in.frame, x_px, y_px))), interface);
  interface.shows = 0xFFFFu;
  HitBlock no_hits;
  WideI(kNoId).store(no_hits.refracted_id);
  const PixelRays<WideF> rays =
      refracted_rays(in.refracted, {in.view, in.frame, still, x_px, y_px, interface, no_hits, in.options});
  return alpha_bits(in.shading, rays.ray, rays.differential, id, cover);
}

std::uint32_t reflected_alpha_test(const AlphaTestIn& in, std::int32_t id, int x_px, int y_px, std::uint32_t cover) {
  const Ray<WideF> ray = block_rays(in.view, make_block(in.frame, x_px, y_px));
  const ExactRay<WideF> hit = exact_ray(in.optics->exact, ray);
  const RayDifferential<WideF> at = at_crossing(ray, pixel_ray_differential<WideF>(in.view), hit);
  return alpha_bits(in.shading, {hit.crossing_world, hit.reflected}, reflected_differential(at, hit), id, cover);
}

}  // namespace shoal::inline SHOAL_ISA_NS
