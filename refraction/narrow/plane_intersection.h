// Liu et al.'s narrow phase: what flat water shows at a pixel is taken for a plane, and the bent ray intersects it.
#pragma once

#include "raster/ray_triangle.h"
#include "refraction/data/capture.h"
#include "refraction/narrow/sample_place.h"

namespace shoal::inline SHOAL_ISA_NS {

// Where nothing is drawn the ray counts as this long, so that its direction alone matters.
inline constexpr float kOpen_m = 1e4f;

// The distance along a ray at which it intersects the plane of a triangle; where it goes along that plane or away from
// it, another distance.
SHOAL_INLINE WideF plane_distance(const FetchedTriangle<WideF>& plane, const Ray<WideF>& ray, WideF otherwise) {
  const WideF t = intersect_triangle(ray, plane.p0, plane.e1, plane.e2).t;
  const WideF hit = select((t > WideF(0.0f)) & (t < WideF(kOpen_m)), t, otherwise);
  return select(plane.shown, hit, WideF(kOpen_m));
}

// The same of a refracted ray and the triangle that the layer shows at the pixel itself; otherwise, the distance of the
// point shown.
SHOAL_INLINE WideF plane_distance(const SampleIn& in, const Ray<WideF>& ray) {
  const FetchedTriangle<WideF> own = own_triangles(in);
  if (none(own.shown)) return WideF(kOpen_m);
  const Vec3<WideF> shown = load_plane(in.narrow.lit.position_world, in.block.offset);
  return plane_distance(own, ray, length(shown - ray.origin_world));
}

// The place in the planar reflection layer: the same narrow phase on the reflected ray.
SHOAL_INLINE LayerPlace<WideF> plane_planar_place(const SampleIn& in) {
  const FetchedTriangle<WideF> own = own_triangles(in);
  const Ray<WideF> ray{in.at.crossing_world, in.at.reflected};
  const Ray<WideF> flat{in.at.crossing_world, reflect(in.at.incident, in.at.plane_normal)};
  const WideF hit_m = plane_distance(own, ray, plane_distance(own, flat, WideF(kOpen_m)));
  return project_place(in.view(), ray.origin_world + mirrored_direction(in, ray.direction_world) * hit_m);
}

}  // namespace shoal::inline SHOAL_ISA_NS
