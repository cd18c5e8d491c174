// none: the scene drawn once and the water over it; rays go straight through.
//
// Source  Liu et al. 2020, Table 3, last column.
#include "refraction/methods/method.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

struct None : StraightRays {
  static constexpr MethodCategory kCategory = MethodCategory::kRaster;
  static constexpr bool kWholeScene = true;

  // What the frame without its water shows at the pixel itself.
  static void narrow(const RasterNarrowIn& in, const NarrowOut& out, std::size_t region) {
    for_each_block(in.grids.frame, region, [&](const Block& block) SHOAL_LAMBDA {
      const std::size_t at_block = block_in_region(block.x_px, block.y_px);
      if (in.interface.block[at_block].shows == 0) return;
      const WideI id = WideI::load(in.layer.id() + in.layer.grid().offset(block.x_px, block.y_px));
      id.store(out.hits[at_block].refracted_id);
    });
  }
};

}  // namespace

Method none() {
  return ray_method<None>("none", "rays go straight through the water; same surface, Fresnel and absorption",
                          "Liu et al. 2020, Table 3");
}

}  // namespace shoal::inline SHOAL_ISA_NS
