// The displaced surface of the water as rays meet it: the height field itself, inside of the body's outline.
#pragma once

#include "core/ray.h"
#include "water/body.h"
#include "water/intersect_surface.h"

namespace shoal::inline SHOAL_ISA_NS {

SHOAL_INLINE bool is_displaced(const WaterBody& body, const WaterSurface* surface) {
  return surface != nullptr && body.surface.geometry == WaterGeometry::kDisplaced;
}

// A direction along the body's axes: x, the height over the plane, z.
template <class F>
SHOAL_INLINE Vec3<F> along_axes(const WaterBody& body, Vec3<F> v) {
  return {dot(v, broadcast<F>(body.axis_x)), dot(v, broadcast<F>(body.normal)), dot(v, broadcast<F>(body.axis_z))};
}
template <class F>
SHOAL_INLINE Vec3<F> on_body(const WaterBody& body, Vec3<F> position_world) {
  return along_axes(body, position_world - broadcast<F>(body.origin));
}

// Part of a ray, in its direction's lengths; empty where from > to.
template <class F>
struct Stretch {
  F from, to;
};

// What of a ray is over (or under) one triangle of an outline, seen along the plane's normal, and a millionth of its
// sides and of the distance beyond, more than rounding: no ray passes between two triangles.
//   corner  three, counter-clockwise seen from +normal
template <class F>
SHOAL_INLINE Stretch<F> over_triangle(const Vec3f* corner, Vec3f normal, const Ray<F>& ray, Stretch<F> of) {
  for (int k = 0; k < 3; ++k) {
    const Vec3f a = corner[k], edge = corner[k == 2 ? 0 : k + 1] - a;
    const Vec3<F> inwards = broadcast<F>(cross(normal, edge));
    const Vec3<F> from_a = ray.origin_world - broadcast<F>(a);
    const F slack = (abs(from_a.x) + abs(from_a.y) + abs(from_a.z)) * F(1e-6f * length(edge));
    const F inside = dot(from_a, inwards) + (slack + F(1e-6f * dot(edge, edge)));
    const F gain = dot(ray.direction_world, inwards);
    const MaskOf<F> enters = gain > F(0.0f), leaves = gain < F(0.0f);
    const F t = -inside / select(enters | leaves, gain, F(1.0f));
    of.from = select(enters, max(of.from, t), of.from);
    of.to = select(leaves, min(of.to, t), select(enters | (inside >= F(0.0f)), of.to, F(-1.0f)));
  }
  return of;
}

// Where a ray first meets the displaced surface of a body, inside of the outline.
//
//   t_min  >= 0, in the direction's lengths; lanes: the rays that are wanted
// Returns t, infinity where it does not; error as intersect_surface.
template <class F>
__attribute__((noinline)) F meet_displaced(const WaterBody& body, const WaterSurface& surface, const Ray<F>& ray,
                                           F t_min, MaskOf<F> lanes) {
  const Vec3<F> origin = on_body(body, ray.origin_world), direction = along_axes(body, ray.direction_world);
  F first = F(kInfinity);
  for (std::size_t i = 0; i + 2 < body.outline.size(); i += 3) {
    const Stretch<F> over = over_triangle(body.outline.data() + i, body.normal, ray, Stretch<F>{t_min, F(3e38f)});
    const MaskOf<F> some = lanes & (over.from <= over.to) & (over.from < first);
    if (none(some)) continue;
    first = min(first, intersect_surface(surface, origin, direction, over.from, over.to, some));
  }
  return first;
}

// The surface's normal over a point near it, on the plane normal's side.
template <class F>
__attribute__((noinline)) Vec3<F> displaced_normal(const WaterBody& body, const WaterSurface& surface,
                                                   Vec3<F> position_world) {
  const Vec3<F> p = on_body(body, position_world);
  const SurfacePoint<F> at = surface_at<F>(surface, p.x, p.z);
  return surface_normal<F>(broadcast<F>(body.axis_x), broadcast<F>(body.normal), broadcast<F>(body.axis_z), at.slope_x,
                           at.slope_z);
}

// How far along the surface's normal a ray must start that leaves a point of the surface, so that it starts on the side
// that it goes to: the point's own distance from the surface, and what rounding may hide of it.
//   In units of u = 2^-24, size the sum of the point's coordinates relative to the body's origin and of the world's:
//   each coordinate on the body's axes is off by 8 u size (a difference, three products, two sums, the point's own
//   rounding); two of them move the height by slope_bound times that, the third is the height itself; the surface's own
//   arithmetic adds 4e-6 of its bound (water/noise.h). The lifted point is rounded alike: twice that.
template <class F>
__attribute__((noinline)) F surface_lift(const WaterBody& body, const WaterSurface& surface, Vec3<F> position_world) {
  const Vec3<F> p = on_body(body, position_world);
  const F gap = p.y - surface_at<F>(surface, p.x, p.z).height_m;
  const F size = (abs(p.x) + abs(p.y) + abs(p.z)) +
                 (abs(position_world.x) + abs(position_world.y) + abs(position_world.z)) +
                 F(abs(body.origin.x) + abs(body.origin.y) + abs(body.origin.z));
  const float slope = surface.slope_bound, u = 0x1p-24f;
  const F rounding = size * F(2.0f * 8.0f * u * (1.0f + 1.5f * slope)) + F(2.0f * 4e-6f * surface.height_bound_m);
  // Along a slanting normal: 1 / cosine.
  return (abs(gap) + rounding) * F(sqrt(1.0f + slope * slope));
}

#if defined(SHOAL_SHARED_TEMPLATES)
// Compiled once an instruction set, in water/exact_ray.isa.cpp.
extern template WideF meet_displaced(const WaterBody&, const WaterSurface&, const Ray<WideF>&, WideF, WideM);
extern template Vec3<WideF> displaced_normal(const WaterBody&, const WaterSurface&, Vec3<WideF>);
extern template WideF surface_lift(const WaterBody&, const WaterSurface&, Vec3<WideF>);
#endif

}  // namespace shoal::inline SHOAL_ISA_NS
