// Rays towards the sun, through the water above a point.
#pragma once

#include "shading/shading_view.h"
#include "trace/bvh16.h"
#include "trace/ray_counts.h"

namespace shoal {

// The context of ShadowRays::blocked. All three outlive the frame.
struct TracedShadows {
  const ShadingView* view = nullptr;
  const Bvh16* bvh = nullptr;   // over the opaque triangles
  RayCounts* counts = nullptr;  // shadow rays are added here
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

// ShadowRays::blocked by rays towards the sun; under a plane of water along the refracted way to the plane, then on in
// the air.
//   context  a TracedShadows
// The water's plane bends the way, its waves do not (docs/decisions/0008).
// Error: none but within 1 mm of a shadow's edge, against rays in double (tests/refraction/test_shadow.cpp).
std::uint32_t sun_blocked(const void* context, const ShadowQuery& query, const SunBend* bend, std::uint32_t lanes);

}  // namespace shoal::inline SHOAL_ISA_NS
