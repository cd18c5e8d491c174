// Rays of sixteen lanes into the scene: first hits, traced shadows, and the blended triangles on their way.
#pragma once

#include "raster/blocks.h"
#include "scene/scene_view.h"
#include "trace/ray_counts.h"
#include "trace/trace_view.h"

namespace shoal {

// The context of ShadowRays::blocked. All three outlive the frame.
struct TracedShadows {
  const ShadingView* view = nullptr;
  const RayQueries* rays = nullptr;
  RayCounts* counts = nullptr;  // shadow rays are added here
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

// The triangle that each ray hits first between t_near and t_far (in lengths of the direction); kNoId where there is
// none.
//   differential  of the rays: the footprint of alpha-tested textures
// Source: Wald et al. 2014 (Embree), robust mode. Differs: Embree finds the triangle alone; the hit is computed by
//         raster/ray_triangle.h.
// Error: a ray within rounding of an edge may be given the neighbour, and on another instruction set another one;
//        elsewhere the triangle is that of rays in double (tests/refraction/test_ray_traced.cpp).
WideI first_hits(const RayQueries& rays, const ShadingView& view, const Ray<WideF>& ray,
                 const RayDifferential<WideF>& differential, float t_near, WideF t_far, WideM lanes);

// ShadowRays::blocked by rays towards the sun; under a plane of water along the refracted way to the plane, then on in
// the air.
//   context  a TracedShadows
// The water's plane bends the way, its waves do not (docs/decisions/0008).
// Error: none but within 1 mm of a shadow's edge, against rays in double (tests/refraction/test_shadow.cpp).
std::uint32_t sun_blocked(const void* context, const ShadowQuery& query, const SunBend* bend, std::uint32_t lanes);

// The light of blended triangles on the way of a ray, less the share that nearer ones absorb, and what they transmit.
struct SeenThrough {
  Vec3<WideF> light{WideF(0.0f), WideF(0.0f), WideF(0.0f)};
  WideF transmittance{1.0f};
};

// Where rays end, and the water that they run through.
struct PathSegment {
  float t_near;            // in lengths of the direction
  WideF end_t;             // the same
  WideI end_id;            // what is there: of a blended triangle as far as it, the smaller id is in front
  std::int32_t body = -1;  // that absorbs the light on its way; -1: none
};

// Composites all blended triangles between t_near (and the origin) and the end, by (distance, id).
// Source, error: as refraction/passes/blend_region.h.
SeenThrough seen_through(const RayQueries& rays, const SceneView& scene, const Ray<WideF>& ray,
                         const RayDifferential<WideF>& differential, const PathSegment& segment, WideM lanes);

SHOAL_INLINE void fill_packet(RayPacket& packet, const Ray<WideF>& ray, float t_near, WideF t_far) {
  ray.origin_world.x.store(packet.origin_x), ray.origin_world.y.store(packet.origin_y);
  ray.origin_world.z.store(packet.origin_z);
  ray.direction_world.x.store(packet.direction_x), ray.direction_world.y.store(packet.direction_y);
  ray.direction_world.z.store(packet.direction_z);
  WideF(t_near).store(packet.t_near);
  t_far.store(packet.t_far);
}

}  // namespace shoal::inline SHOAL_ISA_NS
