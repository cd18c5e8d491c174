// Whether anything lies on the way of rays: shadow rays, which end at the first triangle found.
#pragma once

#include "core/ray.h"
#include "core/vec_lanes.h"
#include "shading/shading_view.h"
#include "trace/bvh16.h"

namespace shoal::inline SHOAL_ISA_NS {

// The rays that something blocks which casts shadows: both sides of every triangle of the BVH whose material is lit
// (docs/scenes.md), alpha-tested ones where the material keeps the point, without a footprint.
//
//   bvh    over the scene's opaque triangles
//   view   geometry and materials, for the alpha test
//   ray    world, direction of about unit length (0.5 to 2); fastest where the rays lie near each other
//   t_far  where the rays end, in lengths of the direction
//   lanes  a bit a ray that is wanted
// Returns a bit for each wanted ray that a triangle blocks between its origin and t_far.
// Error: as nearest_hits (tests/trace/test_against_embree.cpp, tests/refraction/test_shadow.cpp).
std::uint32_t blocked_rays(const Bvh16& bvh, const ShadingView& view, const Ray<WideF>& ray, WideF t_far,
                           std::uint32_t lanes);

}  // namespace shoal::inline SHOAL_ISA_NS
