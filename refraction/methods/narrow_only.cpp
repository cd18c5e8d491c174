// narrow-only: the plane narrow phase on an unrefracted frame. No geometry is moved: all that the eye's straight rays
// do not see is missing, and what stands in front of the water is sampled through it.
//
// Source  Liu, Han and Fei 2020, Figs. 8 and 9 (their ablation).
// Differs As liu-2020's narrow phase: Snell's ray, and the world's planes.
#include "refraction/methods/image_space.h"
#include "refraction/narrow/plane_intersection.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {
struct NarrowOnly : StraightRays {
  static constexpr bool kWholeScene = true;

  static LayerPlace<WideF> planar_place(const SampleIn& in) { return plane_planar_place(in); }

  static LayerPlace<WideF> sample_place(const SampleIn& in) {
    const Ray<WideF> ray{in.at.crossing_world, in.at.refracted};
    return project_place(in.view(), ray.origin_world + ray.direction_world * plane_distance(in, ray));
  }
};
}  // namespace

Method narrow_only() {
  return image_space_method<NarrowOnly>("narrow-only", "plane narrow phase on an unrefracted frame",
                                        "Liu, Han and Fei 2020, Figs. 8 and 9");
}

}  // namespace shoal::inline SHOAL_ISA_NS
