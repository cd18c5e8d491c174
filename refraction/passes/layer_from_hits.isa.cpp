// A layer filled from hits (refraction/passes/layer_from_hits.h).
#include "refraction/passes/layer_from_hits.h"

namespace shoal::inline SHOAL_ISA_NS {

void layer_from_hits(const LayerFromHitsIn& in, VisibilityBuffer& out, std::size_t region) {
  const bool reflected = in.kind == WaterPassKind::kReflected;
  for_each_block(in.grids.frame, region, [&](const Block& block) SHOAL_LAMBDA {
    const std::size_t at_block = block_in_region(block.x_px, block.y_px);
    if (in.interface.block[at_block].shows == 0) return;
    const HitBlock& hits = in.hits[at_block];
    const WideI id = WideI::load(reflected ? hits.reflected_triangle : hits.refracted_triangle);
    const Vec3<WideF> position = load3(reflected ? hits.reflected_position : hits.refracted_position);
    const Vec3<WideF> image =
        reflected ? mirrored_position(in.optics.exact, position) : virtual_position(in.optics.map, position);
    const ClipVertex<WideF> clip = project(in.view.view, image);
    const WideM seen = is_triangle(id) & (clip.w > WideF(0.0f));
    const WideF depth = select(seen, clip.z / select(seen, clip.w, WideF(1.0f)), WideF(0.0f));
    const std::size_t at = in.grids.layers.offset(block.x_px, block.y_px);
    depth.store(out.depth.data() + at);
    id.store(out.id.data() + at);
  });
}

}  // namespace shoal::inline SHOAL_ISA_NS
