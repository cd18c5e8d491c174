// Light at a smooth dielectric interface. eta is n_incident / n_transmitted, always.
#pragma once

#include "core/vec_lanes.h"

namespace shoal::inline SHOAL_ISA_NS {

template <class F>
struct Refraction {
  Vec3<F> direction;  // unit; where not valid, along the surface
  F cos_transmitted;  // >= 0; 0 where not valid
  MaskOf<F> valid;    // not totally reflected
};

// Square of the transmitted cosine; negative beyond the critical angle.
// Written so that nothing cancels for eta < 1, and for eta > 1 only what must: near the critical angle.
template <class F>
SHOAL_INLINE F cos2_transmitted(F cos_incident, F eta) {
  const F scaled = eta * cos_incident;
  return (F(1.0f) - eta) * (F(1.0f) + eta) + scaled * scaled;
}

// Mirror image of a direction.
//   d  any length;  n  unit
template <class F>
SHOAL_INLINE Vec3<F> reflect(Vec3<F> d, Vec3<F> n) {
  return d - n * (F(2.0f) * dot(d, n));
}

// Snell's law.
//
//   d    unit, towards the surface
//   n    unit, against d: dot(d, n) <= 0 (what rounding makes positive counts as 0)
//   eta  n_incident / n_transmitted, in [1/3, 3]; 1 returns d up to rounding
// Returns the transmitted direction. Beyond the critical angle valid is false and the direction tangential; at it both
// formulas meet.
// Error: direction within 1.6e-6 where cos_transmitted > 0.5, and within 1.6e-6 / cos_transmitted down to 1e-3, towards
//        the critical angle, where the function itself is that steep (tests/water/test_optics.cpp).
template <class F>
SHOAL_INLINE Refraction<F> refract(Vec3<F> d, Vec3<F> n, F eta) {
  const F cos_i = max(-dot(d, n), F(0.0f));
  const F cos2_t = cos2_transmitted(cos_i, eta);
  const MaskOf<F> valid = cos2_t >= F(0.0f);
  const F cos_t = sqrt(max(cos2_t, F(0.0f)));
  const Vec3<F> tangent = d + n * cos_i;
  return {normalize(tangent * eta - n * cos_t), cos_t, valid};
}

// Exact reflectance of unpolarised light.
//
//   cos_incident  in [0, 1], on the incident side
//   eta           n_incident / n_transmitted, in [1/3, 3]
// Returns the share of power reflected, in [0, 1]: 1 beyond the critical angle, 0 for eta 1.
// Source: Fresnel's equations; with both numerators divided out by Snell's law,
//         r_s = (eta^2 - 1) / (eta cos_i + cos_t)^2,
//         r_p = (1 - eta^2) ((1 + eta^2) cos_i^2 - eta^2) / (cos_i + eta cos_t)^2,
//         which cancel nowhere but at Brewster's angle, where r_p is 0.
// Error: relative 6e-7 for eta < 1; for eta > 1 absolute 1.3e-6 / cos_t (test_optics.cpp).
template <class F>
SHOAL_INLINE F fresnel_dielectric(F cos_incident, F eta) {
  const F cos2_t = cos2_transmitted(cos_incident, eta);
  const F cos_t = sqrt(max(cos2_t, F(0.0f)));
  const F eta2 = eta * eta, contrast = (F(1.0f) - eta) * (F(1.0f) + eta);
  const F sum_s = eta * cos_incident + cos_t, sum_p = cos_incident + eta * cos_t;
  const F r_s = contrast / max(sum_s * sum_s, F(1e-30f));
  const F r_p = contrast * ((F(1.0f) + eta2) * cos_incident * cos_incident - eta2) / max(sum_p * sum_p, F(1e-30f));
  const F reflectance = min(F(0.5f) * (r_s * r_s + r_p * r_p), F(1.0f));
  return select(cos2_t > F(0.0f), reflectance, select(eta == F(1.0f), F(0.0f), F(1.0f)));
}

// Schlick's approximation, with the cosine on the thin side, where it belongs: from the dense side that is cos_t.
//   as fresnel_dielectric
// Source: Schlick (1994), eq. 15.
template <class F>
SHOAL_INLINE F fresnel_schlick(F cos_incident, F eta) {
  const F cos2_t = cos2_transmitted(cos_incident, eta);
  const F cosine = select(eta > F(1.0f), sqrt(max(cos2_t, F(0.0f))), cos_incident);
  const F normal = (eta - F(1.0f)) / (eta + F(1.0f)), r0 = normal * normal;
  const F c = F(1.0f) - cosine, c2 = c * c;
  return r0 + (F(1.0f) - r0) * (c2 * c2 * c);
}

}  // namespace shoal::inline SHOAL_ISA_NS
