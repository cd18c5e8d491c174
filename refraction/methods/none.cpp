// none: the same passes, surface and Fresnel, but rays go straight through.
//
// Source  Liu et al. 2020, Table 3, last column.
#include "refraction/methods/method.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {
struct None {
  static constexpr bool kFollowsWaves = false;
  // Index 1 makes the broad phase the identity.
  static BroadPhase map(const WaterBody& body, const View& view) {
    return make_broad_phase(body.origin, body.normal, 1.0f, view);
  }

  template <class F>
  SHOAL_INLINE static WaterRays<F> rays(const WaterPass& water, Ray<F> view_ray, RayDifferential<F> differential) {
    return straight_rays(water, view_ray, differential);
  }
};
}  // namespace

Method none() {
  return {"none", "rays go straight through the water; same surface, Fresnel and absorption",
          "Liu et al. 2020, Table 3", MethodStages<None>::kernels()};
}

}  // namespace shoal::inline SHOAL_ISA_NS
