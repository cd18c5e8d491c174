// A ray against the plane of one triangle, and the change of the hit from pixel to pixel.
#pragma once

#include "core/ray.h"
#include "core/vec_lanes.h"
#include "raster/camera.h"

namespace shoal::inline SHOAL_ISA_NS {

template <class F>
struct TriangleHit {
  F t;              // hit = origin + direction t, in units of the direction's length; negative behind the origin
  F u, v;           // hit = p0 + e1 u + e2 v; not clamped to the triangle
  MaskOf<F> valid;  // the ray is not parallel to the plane, and t, u, v are finite; else they are 0
};

// Derivatives of TriangleHit's u and v by pixel.
template <class F>
struct TriangleHitDerivatives {
  F u_dx, u_dy, v_dx, v_dy;
};

// The differential of pixel_ray's rays: exact, and the same at every pixel.
template <class F>
SHOAL_INLINE RayDifferential<F> pixel_ray_differential(const View& view) {
  const Vec3<F> zero = {F(0.0f), F(0.0f), F(0.0f)};
  const Vec3<F> dx = broadcast<F>(view.ray_dx), dy = broadcast<F>(view.ray_dy);
  if (view.camera.orthographic) return {dx, dy, zero, zero};
  return {zero, zero, dx, dy};
}

// Intersects a ray with the plane of a triangle, both sides.
//
//   ray      world, direction of any length
//   p0       first corner, world;  e1, e2  the other corners less p0
// Returns the hit; TriangleHit::valid is false where the ray is parallel to the plane.
// Source: Moeller and Trumbore (1997), without culling or tests of u, v.
// Error: of the point p0 + e1 u + e2 v, of e1 u and of e2 v: 3e-7 x (distance of p0 from the ray's origin + that of the
//        origin from the world's + |e1| + |e2|) over (cosine between ray and normal x sine of the corner at p0), for
//        |u|, |v| < 5 (tests/refraction/test_exact_ray.cpp).
template <class F>
SHOAL_INLINE TriangleHit<F> intersect_triangle(Ray<F> ray, Vec3<F> p0, Vec3<F> e1, Vec3<F> e2) {
  const Vec3<F> p = cross(ray.direction_world, e2);
  const F det = dot(e1, p);
  const Vec3<F> s = ray.origin_world - p0;
  const Vec3<F> q = cross(s, e1);
  const MaskOf<F> crosses = det != F(0.0f);
  const F inv = F(1.0f) / select(crosses, det, F(1.0f));
  const F t = dot(e2, q) * inv, u = dot(s, p) * inv, v = dot(ray.direction_world, q) * inv;
  const F limit = F(3e38f), zero = F(0.0f);
  const MaskOf<F> t_finite = abs(t) < limit, u_finite = abs(u) < limit, v_finite = abs(v) < limit;
  const MaskOf<F> valid = crosses & t_finite & u_finite & v_finite;
  return {select(valid, t, zero), select(valid, u, zero), select(valid, v, zero), valid};
}

// Screen derivatives of the hit's barycentrics, by the quotient rule on u = s.(D x e2) / det, v = D.(s x e1) / det.
//
//   as intersect_triangle, with the ray's differential and the hit itself
// Returns 0 where the hit is not valid.
// Source: Igehy (1999), transfer to the hit; here in barycentrics.
// Error: 6e-5 of the largest of the four, over (cosine between ray and normal squared x sine of the corner at p0)
//        (test_exact_ray.cpp).
template <class F>
SHOAL_INLINE TriangleHitDerivatives<F> hit_derivatives(Ray<F> ray, RayDifferential<F> differential, Vec3<F> p0,
                                                       Vec3<F> e1, Vec3<F> e2, TriangleHit<F> hit) {
  const Vec3<F> p = cross(ray.direction_world, e2);
  const F det = dot(e1, p);
  const Vec3<F> s = ray.origin_world - p0;
  const Vec3<F> q = cross(s, e1);
  const F zero = F(0.0f);
  const F inv = F(1.0f) / select(hit.valid, det, F(1.0f));
  const Vec3<F> px = cross(differential.direction_dx, e2), py = cross(differential.direction_dy, e2);
  const F det_dx = dot(e1, px), det_dy = dot(e1, py);
  const F u_dx = dot(differential.origin_dx, p) + dot(s, px) - hit.u * det_dx;
  const F u_dy = dot(differential.origin_dy, p) + dot(s, py) - hit.u * det_dy;
  const F v_dx =
      dot(differential.direction_dx, q) + dot(ray.direction_world, cross(differential.origin_dx, e1)) - hit.v * det_dx;
  const F v_dy =
      dot(differential.direction_dy, q) + dot(ray.direction_world, cross(differential.origin_dy, e1)) - hit.v * det_dy;
  return {select(hit.valid, u_dx * inv, zero), select(hit.valid, u_dy * inv, zero), select(hit.valid, v_dx * inv, zero),
          select(hit.valid, v_dy * inv, zero)};
}

}  // namespace shoal::inline SHOAL_ISA_NS
