// The method-independent kernels of one ISA.
#include "refraction/kernels.h"

#include "raster/visibility.h"
#include "refraction/passes/front_ends.h"
#include "refraction/passes/blend_direct.h"
#include "refraction/passes/displaced_water.h"
#include "shading/shadow/shadow_pass.h"
#include "refraction/pixel_stage.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

void direct_front_end(FrameData& f, std::size_t work_item) {
  opaque_work_item(f, DirectProgram{f.view, f.frustum}, f.direct_pass, work_item);
}

void water_front_end(FrameData& f) {
  const DirectProgram program{f.view, f.frustum};
  for (std::size_t body = 0; body + 1 < f.outline_first_meshlet.size(); ++body) {
    const std::uint32_t first = f.outline_first_meshlet[body];
    const bool displaced = is_displaced(*f.water[body].body, f.water[body].surface);  // kernels_displaced.cpp
    FrontEnd<DirectProgram>(f.water_geometry, program, f.direct_pass, f.water_bins.work_items[body])
        .run(first, displaced ? first : f.outline_first_meshlet[body + 1],
             kFirstWaterId + static_cast<std::int32_t>(body));
  }
}

void refracted_front_end(FrameData& f, const WaterPass& water, std::size_t work_item) {
  opaque_work_item(f, RefractedProgram{{water, f.view}}, water.pass, work_item);
}

void mirrored_front_end(FrameData& f, const WaterPass& water, std::size_t work_item) {
  opaque_work_item(f, MirroredProgram{{water, f.view}}, water.pass, work_item);
}

void blended_front_end(FrameData& f, const WaterPass* water, std::size_t work_item) {
  if (water == nullptr) {
    blended_work_item(f, DirectProgram{f.view, f.frustum}, f.direct_pass, false, work_item);
  } else if (water->mirrored) {
    blended_work_item(f, MirroredProgram{{*water, f.view}}, water->pass, true, work_item);
  } else {
    blended_work_item(f, RefractedProgram{{*water, f.view}}, water->pass, true, work_item);
  }
}

// Where straight view rays meet the triangle.
std::uint32_t direct_alpha(const FrameData& f, const WaterPass*, std::int32_t id, int x_px, int y_px,
                           std::uint32_t cover) {
  return alpha_bits(f, block_rays(f.view, make_block(f.grid, x_px, y_px)), pixel_ray_differential<WideF>(f.view), id,
                    cover);
}

// Where the mirrored ray meets it; the mirrored layer is what flat water shows, whatever its waves do.
std::uint32_t mirrored_alpha(const FrameData& f, const WaterPass* water, std::int32_t id, int x_px, int y_px,
                             std::uint32_t cover) {
  const Ray<WideF> ray = block_rays(f.view, make_block(f.grid, x_px, y_px));
  const ExactRay<WideF> hit = exact_ray(water->optics, ray);
  const RayDifferential<WideF> at = at_crossing(ray, pixel_ray_differential<WideF>(f.view), hit);
  return alpha_bits(f, {hit.crossing_world, hit.reflected}, reflected_differential(at, hit), id, cover);
}

// The pass's alpha test as the tile's rasterizer takes it.
struct PassAlpha {
  static constexpr bool kTests = true;
  const FrameData& f;
  const WaterPass* water;
  AlphaTest test;
  WideM operator()(std::int32_t id, int x_px, int y_px, WideM cover) const {
    // Of the frame: the layers of a body have a margin.
    const int margin = water != nullptr ? f.layers.margin_px : 0;
    return mask_from_bits(test(f, water, id, x_px - margin, y_px - margin, to_bits(cover)));
  }
};

void draw_tile(FrameData& f, VisibilityBuffer& out, AlphaTest alpha, const WaterPass* water, const PassBins* early,
               std::size_t tile) {
  const BinGrid& tiles = water != nullptr ? f.layers.tiles : f.bin_grid;
  const int size = tiles.tile_px;
  const int x0 = static_cast<int>(tile % static_cast<std::size_t>(tiles.tiles_x)) * size;
  const int y0 = static_cast<int>(tile / static_cast<std::size_t>(tiles.tiles_x)) * size;
  const PassAlpha pass_alpha{f, water, alpha};
  TileRaster<PassAlpha> raster(out, pass_alpha, x0, y0, min(x0 + size, out.grid.width_px),
                               min(y0 + size, out.grid.height_px));
  raster.clear();
  if (early != nullptr)
    for (const WorkItemBins& work_item : early->work_items) raster.draw(work_item, static_cast<std::uint32_t>(tile));
  for (const WorkItemBins& work_item : f.bins.work_items) raster.draw(work_item, static_cast<std::uint32_t>(tile));
}

std::uint8_t water_in_region(const FrameData& f, std::int32_t body, std::size_t region, std::uint32_t& pixels) {
  std::uint8_t flags = 0;
  for_each_block(f.grid, region, [&](const Block& block) SHOAL_LAMBDA {
    const WideM here = (WideI::load(f.direct.id.data() + block.offset) == WideI(kFirstWaterId + body)) & block.in_frame;
    const std::uint32_t bits = to_bits(here);
    if (bits == 0) return;
    pixels += static_cast<std::uint32_t>(__builtin_popcount(bits));
    flags |= 1;
    if (block.x_px % kRegionSize == 0) flags |= 2;
    if (block.x_px % kRegionSize == kRegionSize - kBlockSize) flags |= 4;
    if (block.y_px % kRegionSize == 0) flags |= 8;
    if (block.y_px % kRegionSize == kRegionSize - kBlockSize) flags |= 16;
  });
  return flags;
}

}  // namespace

FrameKernels make_frame_kernels() {
  return {&direct_front_end,  &water_front_end,     &refracted_front_end, &mirrored_front_end, &draw_tile,
          &direct_alpha,      &mirrored_alpha,      &water_in_region,     &shadow_front_end,   &draw_shadow_tile,
          &blended_front_end, &blend_direct_region, &displaced_region};
}

}  // namespace shoal::inline SHOAL_ISA_NS
