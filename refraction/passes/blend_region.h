// Blended materials over one region: fragments in exact order, shaded where the pass's rays hit their triangles, and
// composited front to back into a layer that lies over whatever is behind.
//
// Source  Porter and Duff 1984 (over, not premultiplied: glTF 2.0, 3.9.4). Fragments: raster/fragments.h.
// Error   as the sum of its terms: with n layers, 3 n 2^-24 of the largest colour (tests/refraction/test_blend.cpp).
#pragma once

#include "raster/fragments.h"
#include "raster/pass_bins.h"
#include "refraction/data/frame_grids.h"
#include "refraction/data/pixel_rays.h"
#include "scene/scene_view.h"
#include "scene/water_absorption.h"
#include "shading/shade_hits.h"
#include "shading/transparency.h"

namespace shoal::inline SHOAL_ISA_NS {

// One block's sorted fragments onto its layer. Returns false where the region need not be drawn again for it.
//
//   Pass  lanes(block): the samples of the pass; rays(block, lanes): their rays, less any lanes that have none;
//         lit_in(): the water that dims the fragments' light, or null; absorbs(): the water between a ray's origin and
//         the fragments, or null; kFromSurface: the rays start at the water, and what is behind their origin belongs to
//         the pass on the other side.
// A triangle that follows itself in a sample's order (pieces that overlap after snapping) counts once.
template <class Pass>
__attribute__((noinline)) bool blend_block(const SceneView& scene, FragmentLists& lists, int index, BlendLayer& layer,
                                           const Pass& pass, const Block& block) {
  WideM here = pass.lanes(block);
  if (none(here)) return continue_block(lists, index, here);
  const FragmentLayer* layers = lists.of_block(index);
  BlendLanes sum = load_layer(layer, block);
  const PixelRays<WideF> rays = pass.rays(block, here);
  WideI last = WideI::load(lists.taken[static_cast<std::size_t>(index)].id);
  for (int n = 0; n < lists.count[index]; ++n) {
    const WideI id = WideI::load(layers[n].id);
    WideM lanes = here & is_triangle(id) & (id != last) & (sum.transmittance > WideF(0.0f));
    last = id;
    if (none(lanes)) continue;
    ShadedLanes s;
    shade_hits(scene.shading, rays.ray, rays.differential, id, lanes, pass.lit_in(), s);
    if constexpr (Pass::kFromSurface) lanes = lanes & (s.t > WideF(0.0f));
    Vec3<WideF> light = s.radiance;
    if (pass.absorbs() != nullptr)
      light = light * absorbed(*pass.absorbs(), max(s.t * length(rays.ray.direction_world), WideF(0.0f)));
    const WideF alpha = clamp(s.surface.alpha, WideF(0.0f), WideF(1.0f));
    sum.light = select<WideF>(lanes, sum.light + light * (sum.transmittance * alpha), sum.light);
    sum.transmittance = select(lanes, sum.transmittance * (WideF(1.0f) - alpha), sum.transmittance);
  }
  store_layer(layer, block, sum);
  return continue_block(lists, index, here & (sum.transmittance > WideF(0.0f)));
}

// The blended bins over one region of the frame.
//   opaque  visibility that the fragments must be in front of
template <class Pass>
void blend_region(const SceneView& scene, const FrameGrids& grids, const PassBins& bins, VisibilityBuffer& opaque,
                  const Pass& pass, BlendLayer& layer, FragmentLists& lists, std::size_t region) {
  // A body's layers may have a margin; regions and blocks are the same.
  const int margin = Pass::kFromSurface ? grids.layers.margin_px : 0;
  const std::size_t cell = Pass::kFromSurface ? grids.layers.region(grids.frame, region) : region;
  bool empty = true;
  for (const WorkItemBins& work_item : bins.work_items)
    empty = empty && work_item.tile_first[cell] == work_item.tile_first[cell + 1];
  if (empty) return;

  const RegionOrigin origin = region_origin(grids.frame, region);
  const FragmentCollector collector(lists, opaque);
  for (bool first = true, again = true; again; first = false) {
    start_round(lists, first);
    TileRaster<FragmentCollector> raster(opaque, collector, origin.x_px + margin, origin.y_px + margin,
                                         min(origin.x_px + kRegionSize, grids.frame.width_px) + margin,
                                         min(origin.y_px + kRegionSize, grids.frame.height_px) + margin);
    for (const WorkItemBins& work_item : bins.work_items) raster.draw(work_item, static_cast<std::uint32_t>(cell));
    again = false;
    for_each_block(grids.frame, region, [&](const Block& block) SHOAL_LAMBDA {
      const int index =
          ((block.y_px - origin.y_px) >> 2) * (kRegionSize / kBlockSize) + ((block.x_px - origin.x_px) >> 2);
      if (lists.count[index] != 0 && blend_block(scene, lists, index, layer, pass, block)) again = true;
    });
  }
}

}  // namespace shoal::inline SHOAL_ISA_NS
