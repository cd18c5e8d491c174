// Wave normals that a flat plane can bear: what they refract goes through it, what they reflect comes back.
#pragma once

#include "water/optics.h"

namespace shoal::inline SHOAL_ISA_NS {

// Sine of the least angle between the plane and a ray that leaves it.
inline constexpr float kLeavingMargin = 1e-3f;

namespace valid_normal_detail {

// The normal along lifted - base, where `ray` = base + n k is unit, and lifted is the direction nearest to it whose
// component along `up` is `least`. Written without the difference of nearly equal directions.
//   base_up  dot(base, up)
template <class F>
SHOAL_INLINE Vec3<F> normal_to_lifted(Vec3<F> ray, Vec3<F> n, F k, F base_up, Vec3<F> up, F least) {
  const F ray_up = dot(ray, up);
  const F flat = sqrt(max(F(1.0f) - ray_up * ray_up, F(1e-12f)));
  const F lifted_flat = sqrt(F(1.0f) - least * least);
  const F stretch = ((ray_up - least) * (ray_up + least)) / (flat * (lifted_flat + flat));
  return normalize(up * (least - base_up) + (n - up * dot(n, up)) * k + (ray - up * ray_up) * stretch);
}

}  // namespace valid_normal_detail

// A wave normal on a flat plane of water, bent to the nearest valid one: valid is one against the ray, by which the
// reflected ray goes back to the ray's own side of the plane, and the refracted ray, where there is one, through to the
// other side, both by kLeavingMargin or half of what the plane's own normal gives, where that is less (what rounding
// takes of it not counted).
//
//   d        unit, the ray, towards the plane: dot(d, plane) < 0
//   plane    unit, the plane's normal on the ray's side
//   wave     unit, the wave's normal on the ray's side: dot(wave, plane) > 0
//   eta      n_incident / n_transmitted, in [1/3, 3]
// Returns `wave` itself where it is valid; else the normal that sends the ray off (refracts it, for an invalid
// refraction, or else reflects it) in the valid direction nearest to where `wave` sends it. That direction is in the
// plane of the plane's normal and the direction that `wave` gives. A wave that faces away counts as edge-on to the ray.
// Where mending the one direction spoils the other, `plane`.
// Differs: nearest among the directions of rays, which are seen, not among normals; both have closed forms only so.
// Error: half of the margins is met always, the direction is nearest within 1e-4 (tests/water/test_valid_normal.cpp,
// against
// a
//        search over all normals in double).
template <class F>
SHOAL_INLINE Vec3<F> valid_normal(Vec3<F> d, Vec3<F> plane, Vec3<F> wave, F eta) {
  using namespace valid_normal_detail;
  const F cos_plane = max(-dot(d, plane), F(0.0f));
  const F least_back = min(F(kLeavingMargin), F(0.5f) * cos_plane);
  const F cos2_plane = cos2_transmitted(cos_plane, eta);
  const F least_through =
      select(cos2_plane > F(0.0f), min(F(kLeavingMargin), F(0.5f) * sqrt(max(cos2_plane, F(0.0f)))), F(kLeavingMargin));
  const auto leaves = [&](Vec3<F> n, MaskOf<F>& through, MaskOf<F>& back) SHOAL_LAMBDA {
    const F cosine = -dot(d, n), cos2_t = cos2_transmitted(cosine, eta);
    const F cos_t = sqrt(max(cos2_t, F(0.0f)));
    const F along = dot(n, plane);
    // Components along the plane's normal of eta d + (eta cos - cos_t) n and d + 2 cos n.
    const F down = (eta * cosine - cos_t) * along - eta * cos_plane;
    const F up = (cosine + cosine) * along - cos_plane;
    through = (cos2_t <= F(0.0f)) | (down <= -least_through);
    back = up >= least_back;
    return cosine > F(0.0f);
  };
  MaskOf<F> through, back;
  const MaskOf<F> faces = leaves(wave, through, back);
  if (all(faces & through & back)) return wave;

  // Edge-on where it faces away.
  const F behind = max(dot(d, wave), F(0.0f));
  Vec3<F> n = select(faces, wave, normalize(wave - d * behind));
  // Refraction first: it fails where the wave leans towards the ray, reflection where it leans away.
  const F cosine = max(-dot(d, n), F(0.0f));
  const F cos_t = sqrt(max(cos2_transmitted(cosine, eta), F(0.0f)));
  const F k = eta * cosine - cos_t;
  n = select(faces & !through, normal_to_lifted(d * eta + n * k, n, k, eta * cos_plane, -plane, least_through), n);
  leaves(n, through, back);
  const F twice = F(2.0f) * max(-dot(d, n), F(0.0f));
  n = select(!back, normal_to_lifted(d + n * twice, n, twice, -cos_plane, plane, least_back), n);
  // Rounding takes a hair of the margin; half of it must be left.
  const F half = F(0.5f);
  const F cosine2 = -dot(d, n), cos2_t2 = cos2_transmitted(cosine2, eta), along2 = dot(n, plane);
  const F down2 = (eta * cosine2 - sqrt(max(cos2_t2, F(0.0f)))) * along2 - eta * cos_plane;
  const F up2 = (cosine2 + cosine2) * along2 - cos_plane;
  const MaskOf<F> valid =
      (cosine2 > F(0.0f)) & ((cos2_t2 <= F(0.0f)) | (down2 < -half * least_through)) & (up2 > half * least_back);
  return select(valid, n, plane);
}

}  // namespace shoal::inline SHOAL_ISA_NS
