// none: the same passes, surface and Fresnel, but rays go straight through.
//
// Source  Liu et al. 2020, Table 3, last column.
#include "refraction/methods/method.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {
struct None : StraightRays {};
}  // namespace

Method none() {
  return {"none", "rays go straight through the water; same surface, Fresnel and absorption",
          "Liu et al. 2020, Table 3", MethodStages<None>::kernels()};
}

}  // namespace shoal::inline SHOAL_ISA_NS
