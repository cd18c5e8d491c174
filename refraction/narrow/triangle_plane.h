// The plane of a triangle, for rays that are known to meet something near it.
#pragma once

#include "raster/resolve.h"

namespace shoal::inline SHOAL_ISA_NS {

// Where each ray meets the plane of a triangle, in its direction's lengths; negative behind its origin, -1 where it
// does not.
//   id  of the triangles; lanes: which of them are
__attribute__((noinline)) inline WideF triangle_plane_distance(const GeometryView& g, const Ray<WideF>& ray, WideI id,
                                                               WideM lanes) {
  WideF t(-1.0f);
  for_each_distinct(id, lanes, [&](std::int32_t one, WideM same) SHOAL_LAMBDA {
    const Geometry::TriangleRecord& r = g.triangles[one];
    const Vec3f a = g.vertices[r.vertex[0]].position_world;
    const Vec3f e1 = g.vertices[r.vertex[1]].position_world - a, e2 = g.vertices[r.vertex[2]].position_world - a;
    const TriangleHit<WideF> hit =
        intersect_triangle(ray, broadcast<WideF>(a), broadcast<WideF>(e1), broadcast<WideF>(e2));
    t = select(same & hit.valid, hit.t, t);
  });
  return t;
}

}  // namespace shoal::inline SHOAL_ISA_NS
