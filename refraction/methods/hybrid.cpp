// hybrid: exact path solver, error-bounded subdivision, and the true refracted ray against the triangle that the broad
// phase found or, under waves and beside edges, against the BVH; each point is shaded once, where that ray truly hits.
//
// Source  Steel 2024 (horizontal-preserving virtual space); Liu et al. 2020 (broad and narrow phase).
// Differs From both: the solver is exact (path_solver.h), edges are split to a bound in pixels (broad_phase.h), and the
//         point is an intersection instead of a sample of a shaded picture, so no texture or edge is resampled.
#include "refraction/methods/method.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {
struct Hybrid : TrueRays {
  static constexpr MethodCategory kCategory = MethodCategory::kHybrid;
};
}  // namespace

Method hybrid() {
  return ray_method<Hybrid>(
      "hybrid", "exact solver, bounded subdivision, true ray against the primitive or, under waves, the BVH",
      "Shoal; after Steel 2024 and Liu et al. 2020");
}

}  // namespace shoal::inline SHOAL_ISA_NS
