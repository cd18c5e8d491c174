// Displaced water in the direct pass (refraction/passes/displaced_water.h).
#include "refraction/passes/displaced_water.h"

#include "raster/blocks.h"
#include "raster/fragments.h"

namespace shoal::inline SHOAL_ISA_NS {

void draw_displaced_water(const DisplacedWaterIn& in, VisibilityBuffer& direct, std::size_t region) {
  for_each_block(in.frame, region, [&](const Block& block) SHOAL_LAMBDA {
    const Ray<WideF> ray = block_rays(in.view.view, block);
    for (const WaterOptics& optics : in.water) {
      if (!is_displaced(optics)) continue;
      const ExactRay<WideF> at = displaced_ray(eye_side(optics), ray);
      const WideM crosses = at.crosses & block.in_frame;
      if (none(crosses)) continue;
      const ClipVertex<WideF> clip = project(in.view.view, at.crossing_world);
      const WideF depth = clip.z / select(crosses, clip.w, WideF(1.0f)),
                  there = WideF::load(direct.depth.data() + block.offset);
      const WideI id(kFirstWaterId + optics.water.index), there_id = WideI::load(direct.id.data() + block.offset);
      const WideM shows = crosses & in_front(depth, id, there, there_id);
      store_masked(direct.depth.data() + block.offset, depth, shows);
      store_masked(direct.id.data() + block.offset, id, shows);
    }
  });
}

}  // namespace shoal::inline SHOAL_ISA_NS
