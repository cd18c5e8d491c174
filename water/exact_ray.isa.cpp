// The long templates of moving water for sixteen lanes: every kernel of an instruction set calls these copies.
#include "water/exact_ray.h"

namespace shoal::inline SHOAL_ISA_NS {

template WideF meet_displaced(const WaterBody&, const WaterSurface&, const Ray<WideF>&, WideF, WideM);
template Vec3<WideF> displaced_normal(const WaterBody&, const WaterSurface&, Vec3<WideF>);
template WideF surface_lift(const WaterBody&, const WaterSurface&, Vec3<WideF>);
template void bend_normal(const WaterSide&, ExactRay<WideF>&);
template ExactRay<WideF> displaced_ray(const WaterBody&, const WaterSurface&, const Ray<WideF>&, WideF,
                                       const RayDifferential<float>*);

}  // namespace shoal::inline SHOAL_ISA_NS
