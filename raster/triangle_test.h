// Whether rays meet triangles: the one test with a tolerance that every ray query shares.
#pragma once

#include "core/ray.h"
#include "core/vec_lanes.h"
#include "raster/geometry_view.h"
#include "raster/ray_triangle.h"
#include "raster/resolve.h"

namespace shoal::inline SHOAL_ISA_NS {

// Sixteen rays, each against a triangle of its own.
struct TriangleTest {
  WideF t;       // along the ray, of the triangle's plane; 0 where the ray is parallel to it
  WideM inside;  // in front of the ray's origin and within the triangle, up to rounding
};

//   ray         world, direction of any length
//   p0, e1, e2  first corner, world; the other corners less it
//   active      lanes that are tested; no other lane is inside
SHOAL_INLINE TriangleTest test_triangle(const Ray<WideF>& ray, const Vec3<WideF>& p0, const Vec3<WideF>& e1,
                                        const Vec3<WideF>& e2, WideM active) {
  constexpr float kSlack = 1e-5f;  // in barycentrics: no ray passes between two triangles that share an edge
  const TriangleHit<WideF> hit = intersect_triangle(ray, p0, e1, e2);
  const WideM inside = active & hit.valid & (hit.t > WideF(0.0f)) & (hit.u >= WideF(-kSlack)) &
                       (hit.v >= WideF(-kSlack)) & (hit.u + hit.v <= WideF(1.0f + kSlack));
  return {hit.t, inside};
}

// The same against triangles of a geometry.
//   id  of the active lanes: triangles
SHOAL_INLINE TriangleTest test_triangles(const GeometryView& g, const Ray<WideF>& ray, WideI id, WideM active) {
  Vec3<WideF> p0{}, e1{}, e2{};
  for_each_distinct(id, active, [&](std::int32_t one, WideM lanes) SHOAL_LAMBDA {
    const Geometry::TriangleRecord& r = g.triangles[one];
    const Vec3f a = g.vertices[r.vertex[0]].position_world;
    const Vec3f b = g.vertices[r.vertex[1]].position_world - a, c = g.vertices[r.vertex[2]].position_world - a;
    p0 = select<WideF>(lanes, broadcast<WideF>(a), p0);
    e1 = select<WideF>(lanes, broadcast<WideF>(b), e1);
    e2 = select<WideF>(lanes, broadcast<WideF>(c), e2);
  });
  return test_triangle(ray, p0, e1, e2, active);
}

}  // namespace shoal::inline SHOAL_ISA_NS
