// Blended materials over one region: fragments in exact order, shaded where the pass's rays meet their triangles, and
// composited front to back into a layer that lies over whatever is behind.
//
// Source  Porter and Duff 1984 (over, not premultiplied: glTF 2.0, 3.9.4). Fragments: raster/fragments.h.
// Error   as the sum of its terms: with n layers, 3 n 2^-24 of the largest colour (tests/refraction/test_blend.cpp).
#pragma once

#include "refraction/pixel_stage.h"

namespace shoal::inline SHOAL_ISA_NS {

struct BlendRays {
  Ray<WideF> ray;
  RayDifferential<WideF> differential;
};

// The light of a layer and what it lets through.
struct BlendLanes {
  Vec3<WideF> light{WideF(0.0f), WideF(0.0f), WideF(0.0f)};
  WideF keep{1.0f};
};

SHOAL_INLINE BlendLanes load_layer(const BlendLayer& layer, const Block& block) {
  if (layer.filled[block.offset / kBlockPixels] == 0) return {};
  return {{WideF::load(layer.red.data() + block.offset), WideF::load(layer.green.data() + block.offset),
           WideF::load(layer.blue.data() + block.offset)},
          WideF::load(layer.keep.data() + block.offset)};
}
SHOAL_INLINE void store_layer(BlendLayer& layer, const Block& block, const BlendLanes& v) {
  v.light.x.store(layer.red.data() + block.offset);
  v.light.y.store(layer.green.data() + block.offset);
  v.light.z.store(layer.blue.data() + block.offset);
  v.keep.store(layer.keep.data() + block.offset);
  layer.filled[block.offset / kBlockPixels] = 1;
}

// Lays a layer over what is behind it.
//   lanes    that have the layer
//   covered  the share of the lane that hits something; null: it is not asked for
SHOAL_INLINE void lay_over(const BlendLayer& layer, const Block& block, WideM lanes, Vec3<WideF>& behind,
                           WideF* covered) {
  if (layer.filled[block.offset / kBlockPixels] == 0) return;
  const BlendLanes over = load_layer(layer, block);
  behind = select<WideF>(lanes, over.light + behind * over.keep, behind);
  if (covered == nullptr) return;
  const WideF one(1.0f);
  *covered = select(lanes, one - over.keep * (one - *covered), *covered);
}

// One block's sorted fragments onto its layer. Returns false where the region need not be drawn again for it.
//
//   Pass  lanes(block): which samples are the pass's; rays(block, lanes) of those, less any that have none; lit_in():
//   the water that dims the
//         fragments' light, or null; absorbs(): the water between a ray's origin and them, or null; kFromSurface: the
//         rays start at the water, and what is behind their origin belongs to the pass on the other side.
// A triangle that follows itself in a sample's order (pieces that overlap after snapping) counts once.
template <class Pass>
__attribute__((noinline)) bool blend_block(FrameData& f, FragmentLists& lists, int index, BlendLayer& layer,
                                           const Pass& pass, const Block& block) {
  WideM here = pass.lanes(block);
  if (none(here)) return continue_block(lists, index, here);
  const FragmentLayer* layers = lists.of_block(index);
  BlendLanes sum = load_layer(layer, block);
  const BlendRays rays = pass.rays(block, here);
  WideI last = WideI::load(lists.taken[static_cast<std::size_t>(index)].id);
  for (int n = 0; n < lists.count[index]; ++n) {
    const WideI id = WideI::load(layers[n].id);
    WideM lanes = here & is_triangle(id) & (id != last) & (sum.keep > WideF(0.0f));
    last = id;
    if (none(lanes)) continue;
    ShadedLanes s;
    shade_hits(f, rays.ray, rays.differential, id, lanes, pass.lit_in(), s);
    if constexpr (Pass::kFromSurface) lanes = lanes & (s.t > WideF(0.0f));
    Vec3<WideF> light = s.radiance;
    if (pass.absorbs() != nullptr)
      light = light * absorbed(*pass.absorbs(), max(s.t * length(rays.ray.direction_world), WideF(0.0f)));
    const WideF alpha = clamp(s.surface.alpha, WideF(0.0f), WideF(1.0f));
    sum.light = select<WideF>(lanes, sum.light + light * (sum.keep * alpha), sum.light);
    sum.keep = select(lanes, sum.keep * (WideF(1.0f) - alpha), sum.keep);
  }
  store_layer(layer, block, sum);
  return continue_block(lists, index, here & (sum.keep > WideF(0.0f)));
}

// The blended bins over one region.
//   opaque  visibility that the fragments must be in front of
template <class Pass>
void blend_region(FrameData& f, VisibilityBuffer& opaque, BlendLayer& layer, const Pass& pass, std::size_t region,
                  int thread) {
  // A body's layers may have a margin; regions and blocks are the same.
  const int margin = Pass::kFromSurface ? f.layers.margin_px : 0;
  const std::size_t cell = Pass::kFromSurface ? f.layers.region(f.grid, region) : region;
  bool empty = true;
  for (const WorkItemBins& work_item : f.blended.bins.work_items) empty = empty && work_item.tile_first[cell] == work_item.tile_first[cell + 1];
  if (empty) return;

  FragmentLists& lists = f.blended.lists[static_cast<std::size_t>(thread)];
  const int x0 = static_cast<int>(region % static_cast<std::size_t>(f.grid.regions_x)) * kRegionSize;
  const int y0 = static_cast<int>(region / static_cast<std::size_t>(f.grid.regions_x)) * kRegionSize;
  const FragmentCollector collector(lists, opaque);
  for (bool first = true, again = true; again; first = false) {
    start_round(lists, first);
    TileRaster<FragmentCollector> raster(opaque, collector, x0 + margin, y0 + margin,
                                         min(x0 + kRegionSize, f.grid.width_px) + margin,
                                         min(y0 + kRegionSize, f.grid.height_px) + margin);
    for (const WorkItemBins& work_item : f.blended.bins.work_items) raster.draw(work_item, static_cast<std::uint32_t>(cell));
    again = false;
    for_each_block(f.grid, region, [&](const Block& block) SHOAL_LAMBDA {
      const int index = ((block.y_px - y0) >> 2) * (kRegionSize / kBlockSize) + ((block.x_px - x0) >> 2);
      if (lists.count[index] != 0 && blend_block(f, lists, index, layer, pass, block)) again = true;
    });
  }
}

}  // namespace shoal::inline SHOAL_ISA_NS
