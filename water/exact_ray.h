// One ray at a water interface: where it crosses the surface, how it continues refracted and reflected, and how all of
// that changes from pixel to pixel (ray differentials, for texture filtering).
#pragma once

#include "core/ray.h"
#include "water/displaced_surface.h"
#include "water/filter_surface.h"
#include "water/optics.h"
#include "water/valid_normal.h"

namespace shoal::inline SHOAL_ISA_NS {

// One side of a water interface, as a ray meets it that comes from there.
struct WaterSide {
  Vec3f plane_origin;
  Vec3f normal;   // unit, towards the side that the ray comes from
  float eta = 1;  // n_incident / n_transmitted
  // The body and its surface at this time, where the water moves; null: the plane is flat.
  const WaterBody* body = nullptr;
  const WaterSurface* surface = nullptr;
  float t_near = 0;  // a displaced surface is searched from there on, in lengths of the ray's direction
  // The differential of the eye's rays, where waves are filtered over the pixel; null: waves as they are.
  const RayDifferential<float>* pixel = nullptr;
};
SHOAL_INLINE WaterSide water_side(const WaterBody& body, const WaterSurface* surface, bool from_below) {
  return {body.origin, from_below ? -body.normal : body.normal, from_below ? body.ior : 1.0f / body.ior, &body,
          surface};
}

// True where a surface reflects the scene on the side that a ray comes from, whatever --reflections says: from within
// the water, and from the denser side (ior below 1), where reflection can be total (docs/decisions/0003).
SHOAL_INLINE bool always_reflects_scene(bool from_below, float eta) { return from_below || eta > 1.0f; }

template <class F>
struct ExactRay {
  F t;  // of the crossing along the view ray, in its direction's lengths (perspective: view depth)
  Vec3<F> crossing_world;
  Vec3<F> incident;       // unit, the view ray's direction
  Vec3<F> plane_normal;   // unit, on the ray's side
  Vec3<F> normal;         // the surface's, unit, against the ray
  Vec3<F> wave_normal;    // the same before it was bent for the plane
  F slope_variance;       // of waves that the pixel's footprint hides (water/filter_surface.h), else 0
  F height_m;             // of the surface over the plane, along the body's normal: of moving water, else 0
  F cos_incident;         // >= 0
  F cos_transmitted;      // >= 0; 0 where totally reflected
  F eta;                  // n_incident / n_transmitted
  F reflectance;          // exact Fresnel, 1 where totally reflected
  Vec3<F> refracted;      // unit; tangential where totally reflected
  Vec3<F> reflected;      // unit
  MaskOf<F> crosses;      // the ray meets the plane in front of the eye
  MaskOf<F> transmitted;  // not totally reflected
};

// The pixel's footprint on a body's plane, along its axes: as where the ray meets the plane, however the waves lie
// there. Rays along the plane have a long one, but a finite one.
//   incident  unit;  t  in lengths of the ray's direction
template <class F>
SHOAL_INLINE Footprint<F> pixel_footprint(const WaterBody& body, const RayDifferential<float>& pixel, Vec3<F> incident,
                                          F t) {
  const Vec3<F> axis_x = broadcast<F>(body.axis_x), axis_z = broadcast<F>(body.axis_z);
  const Vec3<F> up = broadcast<F>(body.normal);
  const F fall = dot(incident, up);
  const F inv_fall = F(1.0f) / select(abs(fall) > F(1e-6f), fall, F(1e-6f));
  const auto side = [&](Vec3f d_origin, Vec3f d_direction, F& x, F& z) SHOAL_LAMBDA {
    const Vec3<F> moved = broadcast<F>(d_origin) + broadcast<F>(d_direction) * t;
    const Vec3<F> on_plane = moved - incident * (dot(moved, up) * inv_fall);
    constexpr float kEndless_m = 1e6f;
    x = clamp(dot(on_plane, axis_x), F(-kEndless_m), F(kEndless_m));
    z = clamp(dot(on_plane, axis_z), F(-kEndless_m), F(kEndless_m));
  };
  Footprint<F> p;
  side(pixel.origin_dx, pixel.direction_dx, p.ax, p.az);
  side(pixel.origin_dy, pixel.direction_dy, p.bx, p.bz);
  return p;
}

// The waves at a crossing (incident, t, crossing_world): as they are, or as the eye's pixel sees them.
template <class F>
SHOAL_INLINE FilteredPoint<F> waves_at(const WaterBody& body, const WaterSurface& surface,
                                       const RayDifferential<float>* pixel, const ExactRay<F>& at) {
  const Vec3<F> p = on_body(body, at.crossing_world);
  if (pixel == nullptr) return {surface_at<F>(surface, p.x, p.z), F(0.0f)};
  return filtered_surface_at<F>(surface, p.x, p.z, pixel_footprint(body, *pixel, at.incident, at.t));
}

// The waves' normal at the crossing, bent to one that the plane can bear (water/valid_normal.h).
template <class F>
__attribute__((noinline)) void bend_normal(const WaterSide& side, ExactRay<F>& out) {
  const WaterBody& body = *side.body;
  const Vec3<F> axis_x = broadcast<F>(body.axis_x), axis_z = broadcast<F>(body.axis_z);
  const FilteredPoint<F> waves = waves_at(body, *side.surface, side.pixel, out);
  const SurfacePoint<F>& at = waves.mean;
  const Vec3<F> up = surface_normal<F>(axis_x, broadcast<F>(body.normal), axis_z, at.slope_x, at.slope_z);
  const bool from_above = dot(side.normal, body.normal) > 0.0f;
  out.height_m = at.height_m;
  out.slope_variance = waves.slope_variance;
  out.wave_normal = from_above ? up : -up;
  out.normal = valid_normal<F>(out.incident, out.plane_normal, out.wave_normal, out.eta);
}

// From a ray that meets the surface with a normal (incident, normal, eta) to the rays that go on, and their shares.
template <class F>
SHOAL_INLINE void go_on_from(ExactRay<F>& out) {
  out.cos_incident = clamp(-dot(out.incident, out.normal), F(0.0f), F(1.0f));
  const Refraction<F> refraction = refract(out.incident, out.normal, out.eta);
  out.refracted = refraction.direction;
  out.cos_transmitted = refraction.cos_transmitted;
  out.transmitted = refraction.valid;
  out.reflected = reflect(out.incident, out.normal);
  out.reflectance = fresnel_dielectric(out.cos_incident, out.eta);
}

// A ray at a point where it meets the displaced surface of a body, from the side that it meets; its true normal, not
// bent.
//
//   t      meet_displaced; where infinite, the ray does not cross
//   pixel  of an eye's ray, to filter waves over; where the filtered normal faces away from the ray, its own stays
// Returns all of ExactRay, with the surface's tangent plane for the plane.
template <class F>
__attribute__((noinline)) ExactRay<F> displaced_ray(const WaterBody& body, const WaterSurface& surface,
                                                    const Ray<F>& ray, F t,
                                                    const RayDifferential<float>* pixel = nullptr) {
  ExactRay<F> out;
  out.crosses = t < F(3e38f);
  out.t = select(out.crosses, t, F(0.0f));
  out.crossing_world = ray.origin_world + ray.direction_world * out.t;
  out.incident = normalize(ray.direction_world);
  const Vec3<F> p = on_body(body, out.crossing_world);
  const SurfacePoint<F> at = surface_at<F>(surface, p.x, p.z);
  const auto normal_of = [&](const SurfacePoint<F>& s) SHOAL_LAMBDA {
    return surface_normal<F>(broadcast<F>(body.axis_x), broadcast<F>(body.normal), broadcast<F>(body.axis_z), s.slope_x,
                             s.slope_z);
  };
  Vec3<F> up = normal_of(at);
  const MaskOf<F> below = dot(ray.direction_world, up) > F(0.0f);
  out.slope_variance = F(0.0f);
  if (pixel != nullptr) {
    const FilteredPoint<F> waves = waves_at(body, surface, pixel, out);
    const Vec3<F> mean = normal_of(waves.mean);
    const MaskOf<F> faces = (dot(ray.direction_world, mean) > F(0.0f)) ^ !below;
    up = select<F>(faces, mean, up);
    out.slope_variance = waves.slope_variance;
  }
  out.wave_normal = out.normal = out.plane_normal = select<F>(below, -up, up);
  out.height_m = at.height_m;
  out.eta = select(below, F(body.ior), F(1.0f / body.ior));
  go_on_from(out);
  return out;
}
template <class F>
SHOAL_INLINE ExactRay<F> displaced_ray(const WaterSide& side, const Ray<F>& ray) {
  const F t = meet_displaced(*side.body, *side.surface, ray, F(side.t_near), F(0.0f) == F(0.0f));
  return displaced_ray(*side.body, *side.surface, ray, t, side.pixel);
}

// Follows a ray to the plane of the water, or to its displaced surface.
//
//   side  the plane, seen from where the ray comes from
//   ray   direction of any length but 0
// Returns all of ExactRay. Where `crosses` is false the ray is parallel to the plane, goes away from it or starts
// behind it: t is 0, the crossing the origin, and the directions are finite but meaningless.
// Error: crossing 2e-7 of the coordinates' size over cos_incident; refracted 6e-7 over cos_transmitted; reflected 1e-6
//        (tests/refraction/test_exact_ray.cpp).
template <class F>
SHOAL_INLINE ExactRay<F> exact_ray(const WaterSide& side, Ray<F> ray) {
  if (side.surface != nullptr && is_displaced(*side.body, side.surface)) return displaced_ray(side, ray);
  ExactRay<F> out;
  const Vec3<F> n = broadcast<F>(side.normal);
  const F height = dot(ray.origin_world - broadcast<F>(side.plane_origin), n);
  const F approach = -dot(ray.direction_world, n);
  out.crosses = (approach > F(0.0f)) & (height >= F(0.0f));
  const F t = height / select(out.crosses, approach, F(1.0f));
  out.crosses = out.crosses & (t < F(3e38f));
  out.t = select(out.crosses, t, F(0.0f));
  out.crossing_world = ray.origin_world + ray.direction_world * out.t;
  out.incident = normalize(ray.direction_world);
  out.plane_normal = out.normal = out.wave_normal = n;
  out.slope_variance = out.height_m = F(0.0f);
  out.eta = F(side.eta);
  if (side.surface != nullptr) bend_normal(side, out);
  go_on_from(out);
  return out;
}

// Differentials of the unit direction and of the crossing, before the interface.
//
//   ray, differential  the view ray and its own differential (pixel_ray_differential)
//   hit                exact_ray of it; where it does not cross, all derivatives are 0
// Source: Igehy (1999), eqs. 3 and 10-12. Differs: moving water's normals count as constant within a pixel's footprint,
// for every method and the reference alike, so no shape operator appears.
template <class F>
SHOAL_INLINE RayDifferential<F> at_crossing(Ray<F> ray, RayDifferential<F> differential, const ExactRay<F>& hit) {
  const F zero = F(0.0f);
  const F approach = dot(ray.direction_world, hit.plane_normal);
  const F inv_approach = select(hit.crosses, F(1.0f), zero) / select(hit.crosses, approach, F(1.0f));
  const F len = length(ray.direction_world);
  const F inv_length = select(hit.crosses, F(1.0f), zero) / select(hit.crosses, len, F(1.0f));
  const F on = select(hit.crosses, F(1.0f), zero);
  const auto origin = [&](Vec3<F> d_origin, Vec3<F> d_direction) {
    const Vec3<F> moved = d_origin + d_direction * hit.t;
    return (moved - ray.direction_world * (dot(moved, hit.plane_normal) * inv_approach)) * on;
  };
  const auto direction = [&](Vec3<F> d_direction) {
    return (d_direction - hit.incident * dot(hit.incident, d_direction)) * inv_length;
  };
  return {origin(differential.origin_dx, differential.direction_dx),
          origin(differential.origin_dy, differential.direction_dy), direction(differential.direction_dx),
          direction(differential.direction_dy)};
}

// Differential of the refracted ray (crossing_world, refracted).
//   crossing  at_crossing
// Returns it, finite everywhere: next to the critical angle, where it grows without bound, cos_transmitted counts as at
// least 1e-3. Where the ray is totally reflected, or does not cross, it means nothing.
// Error: relative 6e-5 for cos_transmitted above 0.05 and cos_incident above 0.02 (test_exact_ray.cpp).
template <class F>
SHOAL_INLINE RayDifferential<F> refracted_differential(RayDifferential<F> crossing, const ExactRay<F>& hit) {
  const F cos_t = max(hit.cos_transmitted, F(1e-3f));
  // T = eta d + (eta c - c_t) n with c = -d.n and c_t dc_t = eta^2 c dc.
  const F gain = hit.eta - hit.eta * hit.eta * hit.cos_incident / cos_t;
  const auto direction = [&](Vec3<F> d) { return d * hit.eta - hit.normal * (dot(d, hit.normal) * gain); };
  return {crossing.origin_dx, crossing.origin_dy, direction(crossing.direction_dx), direction(crossing.direction_dy)};
}

// Differential of the reflected ray (crossing_world, reflected).
template <class F>
SHOAL_INLINE RayDifferential<F> reflected_differential(RayDifferential<F> crossing, const ExactRay<F>& hit) {
  return {crossing.origin_dx, crossing.origin_dy, reflect(crossing.direction_dx, hit.normal),
          reflect(crossing.direction_dy, hit.normal)};
}

#if defined(SHOAL_SHARED_TEMPLATES)
// Compiled once an instruction set, in water/exact_ray.isa.cpp.
extern template void bend_normal(const WaterSide&, ExactRay<WideF>&);
extern template ExactRay<WideF> displaced_ray(const WaterBody&, const WaterSurface&, const Ray<WideF>&, WideF,
                                              const RayDifferential<float>*);
#endif

}  // namespace shoal::inline SHOAL_ISA_NS
