// Rays of sixteen pixels into the scene.
#pragma once

#include "refraction/pixel_stage.h"

namespace shoal::inline SHOAL_ISA_NS {

// The triangle that each ray meets first between t_near and t_far (in the direction's lengths); kNoId where there is
// none.
//   differential  of the rays: what cut-out textures are filtered by
// Source: Wald et al. 2014 (Embree), robust mode. Differs: Embree tells the triangle alone; the point is
// ray_triangle's. Error: a ray within rounding of an edge may be given the neighbour, on another ISA another one
// (DESIGN 3); elsewhere
//        the triangle is that of rays in double (tests/refraction/test_ray_traced.cpp).
WideI first_hits(const FrameData& f, const Ray<WideF>& ray, const RayDifferential<WideF>& differential, float t_near,
                 WideF t_far, WideM lanes);

// Which of the points are in the sun's shadow, by rays towards it; under a plane of water along the refracted way to
// the plane, then on in the air.
//   position, facet  world; of the triangle, unit, either side
//   water            the body that the points lie in, or null
// Returns the lanes whose way is blocked. The water's plane bends the way, its waves do not (docs/decisions/0008).
// Error: none but within 1 mm of a shadow's edge, against rays in double (tests/refraction/test_shadow.cpp).
WideM sun_blocked(const FrameData& f, const WaterPass* water, Vec3<WideF> position, Vec3<WideF> facet, WideM lanes);

// The light of blended triangles that rays pass, the nearer ones' share off, and what they let through.
struct SeenThrough {
  Vec3<WideF> light{WideF(0.0f), WideF(0.0f), WideF(0.0f)};
  WideF keep{1.0f};
};

// Of the triangles between t_near (and the origin) and the end, by (distance, id), all of them.
//   end_t, end_id  where the rays end, in their directions' lengths, and what is there: of what is as far as it, the
//                  smaller id is in front
//   medium         the body of water that the rays run through, or null: light is absorbed over its own path
// Nothing, and at no cost, in a scene without blended materials.
// Source, error: as refraction/passes/blend_region.h.
SeenThrough seen_through(const FrameData& f, const Ray<WideF>& ray, const RayDifferential<WideF>& differential,
                         float t_near, WideF end_t, WideI end_id, const WaterPass* medium, WideM lanes);

SHOAL_INLINE void fill_packet(RayPacket& packet, const Ray<WideF>& ray, float t_near, WideF t_far) {
  ray.origin_world.x.store(packet.origin_x), ray.origin_world.y.store(packet.origin_y);
  ray.origin_world.z.store(packet.origin_z);
  ray.direction_world.x.store(packet.direction_x), ray.direction_world.y.store(packet.direction_y);
  ray.direction_world.z.store(packet.direction_z);
  WideF(t_near).store(packet.t_near);
  t_far.store(packet.t_far);
}

// Adds to the frame's counts, from any thread. Exact (tests/refraction/test_ray_traced.cpp).
void count_rays(const FrameData& f, RayCounts::Kind kind, std::uint64_t rays);

}  // namespace shoal::inline SHOAL_ISA_NS
