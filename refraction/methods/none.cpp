// none: the same passes, surface and Fresnel, but rays go straight through.
//
// Source  Liu et al. 2020, Table 3, last column.
// Differs Beside the layer's edges the BVH gives the hit, as for hybrid: so its category is hybrid.
#include "refraction/methods/method.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {
struct None : StraightRays {
  static constexpr MethodCategory kCategory = MethodCategory::kHybrid;
};
}  // namespace

Method none() {
  return ray_method<None>("none", "rays go straight through the water; same surface, Fresnel and absorption",
                          "Liu et al. 2020, Table 3");
}

}  // namespace shoal::inline SHOAL_ISA_NS
