// Displaced water is no primitive of the direct pass: each pixel's ray meets the height field itself, and the nearer of
// the two shows. So no mesh of it can differ from the surface that the rays go on from.
#include "refraction/passes/displaced_water.h"

#include "raster/fragments.h"
#include "refraction/pixel_stage.h"

namespace shoal::inline SHOAL_ISA_NS {

void displaced_region(FrameData& f, std::size_t region) {
  for_each_block(f.grid, region, [&](const Block& block) SHOAL_LAMBDA {
    const Ray<WideF> ray = block_rays(f.view, block);
    for (const WaterPass& water : f.water) {
      if (!is_displaced(*water.body, water.surface)) continue;
      const ExactRay<WideF> at = displaced_ray(eye_side(water), ray);
      const WideM meets = at.crosses & block.in_frame;
      if (none(meets)) continue;
      const ClipVertex<WideF> clip = project(f.view, at.crossing_world);
      const WideF depth = clip.z / select(meets, clip.w, WideF(1.0f)),
                  there = WideF::load(f.direct.depth.data() + block.offset);
      const WideI id(kFirstWaterId + water.index), there_id = WideI::load(f.direct.id.data() + block.offset);
      const WideM shows = meets & in_front(depth, id, there, there_id);
      store_masked(f.direct.depth.data() + block.offset, depth, shows);
      store_masked(f.direct.id.data() + block.offset, id, shows);
    }
  });
}

}  // namespace shoal::inline SHOAL_ISA_NS
