// narrow-only: the plane narrow phase on an unrefracted frame. No geometry is moved: all that the eye's straight rays
// do not see is missing, and what stands in front of the water is found through it.
//
// Source  Liu, Han and Fei 2020, Figs. 8 and 9 (their ablation).
// Differs As liu-2020's narrow phase: Snell's ray, and the world's planes.
#include "refraction/narrow/plane_intersection.h"
#include "refraction/methods/image_space.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {
struct NarrowOnly : StraightRays {
  static constexpr bool kShadesBefore = true, kWholeScene = true;

  static LayerPlace look(const LookUp& l) {
    const Ray<WideF> ray{l.at.crossing_world, l.at.refracted};
    return project_place(l.f.view, ray.origin_world + ray.direction_world * plane_look(l, ray));
  }
};
}  // namespace

Method narrow_only() {
  return {"narrow-only", "plane narrow phase on an unrefracted frame", "Liu, Han and Fei 2020, Figs. 8 and 9",
          ShadeBeforeStages<NarrowOnly>::kernels()};
}

}  // namespace shoal::inline SHOAL_ISA_NS
