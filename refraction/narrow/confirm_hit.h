// Narrow phase, last step: the true ray meets the triangle that the broad phase shows at its pixel, or one of a
// neighbouring pixel that the first miss points to.
#pragma once

#include "raster/resolve.h"
#include "refraction/frame_data.h"

namespace shoal::inline SHOAL_ISA_NS {

// Sixteen rays, each against a triangle of its own.
struct TriangleTest {
  WideF t;       // of the triangle's plane; 0 where the ray is parallel to it
  WideM inside;  // in front of the ray's origin and within the triangle, up to rounding
};

//   p0, e1, e2  first corner, world; the other corners less it
SHOAL_INLINE TriangleTest test_triangle(const Ray<WideF>& ray, const Vec3<WideF>& p0, const Vec3<WideF>& e1,
                                        const Vec3<WideF>& e2, WideM active) {
  constexpr float kSlack = 1e-5f;  // in barycentrics: shared edges must not fall between two triangles
  const TriangleHit<WideF> hit = intersect_triangle(ray, p0, e1, e2);
  const WideM inside = active & hit.valid & (hit.t > WideF(0.0f)) & (hit.u >= WideF(-kSlack)) &
                       (hit.v >= WideF(-kSlack)) & (hit.u + hit.v <= WideF(1.0f + kSlack));
  return {hit.t, inside};
}

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

struct ConfirmedHit {
  WideI id;
  WideM held;  // the ray does meet it
  WideM bare;  // neither the pixel nor a neighbour shows any triangle
};

//   ray         the true ray of each lane, starting at the water
//   own         what the visibility buffer shows at the pixel itself
//   x_px, y_px  of the pixels; lanes: which of them
// Returns the triangle that the ray meets: the pixel's own where that holds, else the nearest that holds among the
// eight neighbours', else the pixel's own after all (its point is then brought into the triangle: resolve.h).
ConfirmedHit confirm_hit(const GeometryView& g, const VisibilityBuffer& visibility, const Ray<WideF>& ray, WideI own,
                         WideI x_px, WideI y_px, WideM lanes);

}  // namespace shoal::inline SHOAL_ISA_NS
