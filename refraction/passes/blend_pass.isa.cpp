// Blended materials of the passes (refraction/passes/blend_pass.h).
#include "refraction/passes/blend_pass.h"

#include "refraction/passes/blend_region.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

// Straight view rays.
struct DirectBlend {
  const BlendDirectIn& in;

  WideM lanes(const Block& block) const { return block.in_frame; }
  PixelRays<WideF> rays(const Block& block, WideM&) const {
    return {block_rays(in.view.view, block), pixel_ray_differential<WideF>(in.view.view)};
  }
  const LightMedium* lit_in() const {
    return in.view.eye_in_water >= 0 ? &in.scene.light_media[in.view.eye_in_water] : nullptr;
  }
  const WaterBody* absorbs() const {
    return in.view.eye_in_water >= 0 ? in.scene.water[static_cast<std::size_t>(in.view.eye_in_water)].body : nullptr;
  }
  static constexpr bool kFromSurface = false;
};

// The method's refracted rays, or, of a planar reflection pass, the surface's reflected ones.
struct WaterBlend {
  const BlendWaterIn& in;

  bool reflected() const { return in.pass.kind == WaterPassKind::kReflected; }
  const InterfaceBlock& interface(const Block& block) const {
    return in.interface.block[block_in_region(block.x_px, block.y_px)];
  }
  WideM lanes(const Block& block) const { return mask_from_bits(interface(block).shows); }
  PixelRays<WideF> rays(const Block& block, WideM& here) const {
    const PixelRaysIn of{in.view.view,
                         in.grids.frame,
                         *in.pass.optics,
                         block.x_px,
                         block.y_px,
                         interface(block),
                         in.hits[block_in_region(block.x_px, block.y_px)],
                         in.options};
    if (reflected()) return reflected_rays(of, load_interface(of.interface));
    here = here & mask_from_bits(of.interface.transmitted);
    return refracted_rays(in.refracted, of);
  }
  // The far side's pass is in the water where the eye is not, the reflected one where it is.
  bool in_water() const { return reflected() == in.pass.optics->exact.eye_below; }
  const LightMedium* lit_in() const {
    return in_water() ? &in.scene.light_media[in.pass.optics->water.index] : nullptr;
  }
  const WaterBody* absorbs() const { return in_water() ? &in.pass.optics->body() : nullptr; }
  static constexpr bool kFromSurface = true;
};

}  // namespace

void blend_direct(const BlendDirectIn& in, const BlendOut& out, std::size_t region) {
  blend_region(in.scene, in.grids, in.bins, out.opaque, DirectBlend{in}, out.layer, out.lists, region);
}

void blend_water(const BlendWaterIn& in, const BlendOut& out, std::size_t region) {
  blend_region(in.scene, in.grids, in.bins, out.opaque, WaterBlend{in}, out.layer, out.lists, region);
}

}  // namespace shoal::inline SHOAL_ISA_NS
