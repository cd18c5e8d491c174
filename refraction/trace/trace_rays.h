// Rays of sixteen pixels into the scene.
#pragma once

#include "refraction/pixel_stage.h"

namespace shoal::inline SHOAL_ISA_NS {

// The triangle that each ray meets first between t_near and t_far (in the direction's lengths); kNoId where there is
// none.
//   differential  of the rays: what cut-out textures are filtered by
WideI first_hits(const FrameData& f, const Ray<WideF>& ray, const RayDifferential<WideF>& differential, float t_near,
                 WideF t_far, WideM lanes);

// Which of the points are in the sun's shadow, by rays towards it; under a plane of water along the refracted way to
// the plane, then on in the air.
//   position, facet  world; of the triangle, unit, either side
//   water            the body that the points lie in, or null
WideM sun_blocked(const FrameData& f, const WaterPass* water, Vec3<WideF> position, Vec3<WideF> facet, WideM lanes);

// Adds to the frame's counts, from any thread.
void count_rays(const FrameData& f, RayCounts::Kind kind, std::uint64_t rays);

}  // namespace shoal::inline SHOAL_ISA_NS
