// Steel's broad phase: positions along the plane are kept, and the apparent depth is found by some steps of a fixed
// point on its ratio to the true one.
//
// Source  Steel 2024, virtual_depth and refracted_virt_pos.
// Differs |depth| everywhere (the listing's start has it signed), and any index. From the denser side the fixed point
//         takes roots of negative numbers, and in an orthographic view there is no eye: there it is the exact map.
#pragma once

#include "refraction/broad/broad_phase.h"

namespace shoal::inline SHOAL_ISA_NS {

class FixedPointMap {
 public:
  //   exact  the plane, seen from the eye; must outlive the map
  //   steps  of the fixed point, >= 1
  FixedPointMap(const BroadPhase& exact, int steps)
      : bp_(exact), steps_(steps), exact_(bp_.orthographic || !bp_.eye_is_thin || bp_.path.identity) {}

  // Where a world position appears, straight behind its foot on the plane.
  //   world  finite
  // Error: as the source's, in float 2e-6 of the coordinates' size (tests/refraction/test_published_maps.cpp). The
  //        source itself is off the exact depth by up to 0.4 % for d <= 20 eye heights, 0.02 to 3 of them deep.
  template <class F>
  SHOAL_INLINE Vec3<F> position(Vec3<F> world) const {
    if (exact_) return virtual_position(bp_, world);
    const Vec3<F> n = broadcast<F>(bp_.far_normal), from_eye = world - broadcast<F>(bp_.eye_world);
    const F far_m = far_distance(bp_, world), depth = abs(far_m), horizontal = length(from_eye - n * dot(from_eye, n));
    // An eye on the plane itself looks from a little above it.
    const F height = F(max(bp_.eye_distance_m, 1e-6f)), ior = F(bp_.path.ratio), m = F(bp_.path.m);
    const F x = horizontal / (depth + F(3.0f) * height);
    F ratio = ior * (x * x + F(1.0f));
    for (int i = 0; i < steps_; ++i) {
      const F oblique = horizontal / (depth / ratio + height);
      ratio = sqrt(m * oblique * oblique + ior * ior);
    }
    // In front of the plane the source goes on with the same ratio.
    return world + n * (far_m / ratio - far_m);
  }

  // A box that holds the images of a world box: the ratio is never below n.
  void bounds(Vec3f lo, Vec3f hi, Vec3f& out_lo, Vec3f& out_hi) const {
    if (exact_) return virtual_bounds(bp_, lo, hi, out_lo, out_hi);
    const BoxDistances box = box_distances(bp_, lo, hi);
    lifted_bounds(bp_, lo, hi, min(box.far_lo_m, 0.0f), max(box.far_hi_m, 0.0f) * bp_.path.inv_ratio, out_lo, out_hi);
  }

 private:
  const BroadPhase& bp_;
  int steps_;
  bool exact_;
};

}  // namespace shoal::inline SHOAL_ISA_NS
