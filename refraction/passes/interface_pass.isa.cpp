// The interface stage (refraction/passes/interface_pass.h).
#include "refraction/passes/interface_pass.h"

#include "refraction/data/capture.h"
#include "scene/rough_mirror.h"
#include "shading/sky.h"

namespace shoal::inline SHOAL_ISA_NS {

WaterCount count_water(const VisibilityBuffer& direct, std::int32_t body, std::size_t region) {
  WaterCount count;
  for_each_block(direct.grid, region, [&](const Block& block) SHOAL_LAMBDA {
    const WideM here = (WideI::load(direct.id.data() + block.offset) == WideI(kFirstWaterId + body)) & block.in_frame;
    const std::uint32_t bits = to_bits(here);
    if (bits == 0) return;
    count.pixels += static_cast<std::uint32_t>(__builtin_popcount(bits));
    count.flags |= 1;
    if (block.x_px % kRegionSize == 0) count.flags |= 2;
    if (block.x_px % kRegionSize == kRegionSize - kBlockSize) count.flags |= 4;
    if (block.y_px % kRegionSize == 0) count.flags |= 8;
    if (block.y_px % kRegionSize == kRegionSize - kBlockSize) count.flags |= 16;
  });
  return count;
}

void find_interface(const InterfaceIn& in, const InterfaceOut& out, std::size_t region) {
  const WaterSide side = eye_side(in.optics);
  const bool filtered = side.pixel != nullptr;
  for_each_block(in.frame, region, [&](const Block& block) SHOAL_LAMBDA {
    InterfaceBlock& to = out.interface.block[block_in_region(block.x_px, block.y_px)];
    const WideM here =
        (WideI::load(in.direct.id.data() + block.offset) == WideI(kFirstWaterId + in.optics.water.index)) &
        block.in_frame;
    to.shows = static_cast<std::uint16_t>(to_bits(here));
    if (none(here)) return;
    ExactRay<WideF> at = exact_ray(side, block_rays(in.view.view, block));
    if (filtered) {
      const RoughMirror<WideF> mirror = mirror_roughly<WideF>(SkyView{in.scene.background()}, in.optics.body(),
                                                              is_displaced(in.optics), at.reflected, at);
      at.reflectance = mirror.reflectance;
      interface_detail::put(to, InterfaceBlock::kBackground, mirror.radiance);
    }
    store_interface(at, to);
    if (!in.view.capture) return;
    store_interface_target(out.target, block.offset, at, here);
    store_water(out.gbuffer, out.hits, block.offset, at.crossing_world, at.normal,
                roughness_of_waves(at.slope_variance), here);
  });
}

}  // namespace shoal::inline SHOAL_ISA_NS
