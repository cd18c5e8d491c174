// Blended materials of the direct pass (refraction/passes/blend_direct.h): straight view rays.
#include "refraction/passes/blend_direct.h"

#include "refraction/passes/blend_region.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {
struct DirectBlend {
  const FrameData& f;
  const WaterPass* around_eye;

  WideM lanes(const Block& block) const { return block.in_frame; }
  BlendRays rays(const Block& block, WideM&) const {
    return {block_rays(f.view, block), pixel_ray_differential<WideF>(f.view)};
  }
  const WaterPass* lit_in() const { return around_eye; }
  const WaterBody* absorbs() const { return around_eye != nullptr ? around_eye->body : nullptr; }
  static constexpr bool kFromSurface = false;
};
}  // namespace

void blend_direct_region(FrameData& f, std::size_t region, int thread) {
  const WaterPass* around_eye = f.eye_in_water >= 0 ? &f.water[static_cast<std::size_t>(f.eye_in_water)] : nullptr;
  blend_region(f, f.direct, f.blended.direct, DirectBlend{f, around_eye}, region, thread);
}

}  // namespace shoal::inline SHOAL_ISA_NS
