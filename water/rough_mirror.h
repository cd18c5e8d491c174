// What water mirrors of the background where the pixel's footprint hides waves: the mean over their slopes.
#pragma once

#include "shading/sky.h"
#include "water/exact_ray.h"

namespace shoal::inline SHOAL_ISA_NS {

// Roughness whose lobe has the waves' spread: alpha^2 is twice an axis's slope variance, the roughness alpha's root.
//   slope_variance  both axes together
// Source: Beckmann's distribution has alpha^2 / 2 along each axis (Heitz 2014, "Understanding the masking-shadowing
// function", section 5.3); GGX, which has no variance, is given the same alpha, as in Olano and Baker 2010.
template <class F>
SHOAL_INLINE F roughness_of_waves(F slope_variance) {
  return min(sqrt(sqrt(slope_variance)), F(1.0f));
}

// Slopes of a thousandth: a mirrored ray moves by less than half of the sun's width.
inline constexpr float kLeastVariance = 1e-6f;

namespace rough_mirror_detail {

// Gauss and Hermite's five points, for a normal distribution of variance 1.
inline constexpr int kPoints = 5;
inline constexpr float kPlaces[kPoints] = {0.0f, -1.35562618f, 1.35562618f, -2.85697001f, 2.85697001f};
inline constexpr float kShares[kPoints] = {0.533333333f, 0.222075922f, 0.222075922f, 0.0112574113f, 0.0112574113f};

// Mirrored directions are spread by twice the slopes along the plane of incidence, by twice their cosine's part across.
template <class F>
struct Spread {
  F along2, across2;  // squared offsets from the middle
  F variance_along, variance_across;
};

// A round normal lobe of height 1 blurred by the spread.
template <class F>
SHOAL_INLINE F blurred_lobe(const Spread<F>& s, float variance) {
  const F along = F(variance) + s.variance_along, across = F(variance) + s.variance_across;
  const F power = s.along2 / along + s.across2 / across;
  // Narrow lobes end near the sun: beyond, the power of two is exactly 0.
  if (all(power > F(210.0f))) return F(0.0f);
  return F(variance) / sqrt(along * across) * det_exp2(F(-0.72134752f) * power);
}

// The sun of shading/sky.h, blurred: its glow's powers cos^n as normal lobes of variance 1 / n, its disc as what it is
// near the eye and, the more so the wider the spread, as a normal lobe of its variance and content.
template <class F>
SHOAL_INLINE F blurred_sun(const Spread<F>& s, F chord2) {
  const F glow = (F(0.004f) * blurred_lobe(s, 1.0f / 8.0f) + F(0.010f) * blurred_lobe(s, 1.0f / 64.0f)) +
                 (F(0.03f) * blurred_lobe(s, 1.0f / 512.0f) + F(0.08f) * blurred_lobe(s, 1.0f / 2048.0f));
  // Its edge falls by smoothstep from u = 1 to u = 2.3 / 1.3 in u = (angle / radius)^2: mean and second moment.
  constexpr float kRadius2 = 0.004651f * 0.004651f, kVariance = 0.3514f * kRadius2, kHeight = 0.5f * 1.3846f / 0.3514f;
  const F disc = sky_detail::smooth(F(2.3f) - chord2 * F(1.3f / kRadius2));
  const F gone = s.variance_along / (s.variance_along + F(kVariance));
  return glow + (disc + (F(kHeight) * blurred_lobe(s, kVariance) - disc) * gone);
}

}  // namespace rough_mirror_detail

// The mean, over the slopes that a pixel hides, of reflectance and of the background that is mirrored.
//
//   at         a ray at the water; where its slope_variance is at most kLeastVariance nothing changes
//   displaced  the surface is the height field: slopes count as the ray sees them, and are not bent for a plane
//   mirrored   unit; the ray's own mirrored direction, for those lanes
// Returns what is mirrored of the background, weighted by reflectance; at.reflectance becomes the mean (1 where totally
// reflected). What is mirrored of the scene, and all that is refracted, stays sharp, along the mean normal.
// How: the hidden slopes as a normal distribution. Five points of it along the plane of incidence, where directions
//   spread most; the environment at each by a lobe of what is left, so that both together have the variance; the sun in
//   closed form.
// Source: Ross, Dion and Potvin 2005, and Bruneton, Neyret and Holzschuch 2010, "Real-time realistic ocean lighting"
// (slope
//   distributions, the sun by its half vector). Differs: points instead of one lookup, no waves in front of others.
// Error: of what is reflected, against means over normally distributed slopes: 5 % where an axis's slopes are up to
//   0.03, 8 % (displaced: 15 %) at 0.1; of an environment 7 and 17 %, for GGX's long tails
//   (tests/refraction/test_wave_filter.cpp).
template <class F>
__attribute__((noinline)) Vec3<F> mirror_roughly(const Background& background, const WaterBody& body, bool displaced,
                                                 Vec3<F> mirrored, ExactRay<F>& at) {
  using namespace rough_mirror_detail;
  const MaskOf<F> rough = at.slope_variance > F(kLeastVariance);
  const Vec3<F> sharp = background_radiance<F>(background, mirrored);
  if (none(rough)) return sharp;

  // Slopes along the plane of incidence.
  const F one(1.0f);
  const Vec3<F> normal = broadcast<F>(body.normal);
  const Vec3<F> up = select<F>(dot(at.wave_normal, normal) < F(0.0f), -normal, normal);
  const Vec3<F> level = at.incident - up * dot(at.incident, up);
  const F level2 = dot(level, level);
  const MaskOf<F> slants = level2 > F(1e-8f);
  const Vec3<F> along = select<F>(slants, level * (one / sqrt(select(slants, level2, one))), broadcast<F>(body.axis_x));
  const Vec3<F> steep = at.wave_normal * (one / max(dot(at.wave_normal, up), F(1e-3f)));
  const F variance = F(0.5f) * at.slope_variance;
  // The environment's lobe is round: as wide as directions spread across, not less than half of along, points alone
  // would be seen; the points have the rest.
  const bool lobes = background.kind == Background::Kind::kEnvironment;
  const F lobe = lobes ? max(at.cos_incident, F(0.5f)) : F(0.0f);
  const F roughness = roughness_of_waves(at.slope_variance * (lobe * lobe));
  const F spacing = sqrt(variance * max(one - lobe * lobe, F(0.0f)));

  F shares(0.0f), reflected(0.0f);
  Vec3<F> brought = broadcast<F>(Vec3f{0, 0, 0});
  for (int i = 0; i < kPoints; ++i) {
    const Vec3<F> facet = steep - along * (spacing * F(kPlaces[i]));
    Vec3<F> n = normalize(facet);
    F share(kShares[i]);
    if (displaced)
      share = share * max(-dot(at.incident, facet), F(0.0f));
    else
      n = valid_normal<F>(at.incident, up, n, at.eta);
    const F reflects = share * fresnel_dielectric(clamp(-dot(at.incident, n), F(0.0f), one), at.eta);
    const Vec3<F> direction = reflect(at.incident, n);
    shares = shares + share;
    reflected = reflected + reflects;
    brought = brought + (lobes ? environment_lobe<F>(*background.environment, direction, roughness)
                               : background_gradient<F>(background, direction)) *
                            reflects;
  }
  const F mean = select(at.transmitted, reflected / max(shares, F(1e-30f)), one);
  Vec3<F> seen = brought * (one / max(reflected, F(1e-30f)));

  const Vec3f sun = background.sun;
  if (background.kind == Background::Kind::kSky && (sun.x != 0.0f || sun.y != 0.0f || sun.z != 0.0f)) {
    const Vec3<F> to_sun = broadcast<F>(background.to_sun_world);
    const Vec3<F> middle = reflect(at.incident, at.normal), off = to_sun - middle;
    const F chord2 = dot(off, off), side = dot(off, cross(up, along)), across2 = side * side;
    const F cosine2 = at.cos_incident * at.cos_incident;
    const Spread<F> spread = {max(chord2 - across2, F(0.0f)), across2, F(4.0f) * variance,
                              F(4.0f) * variance * cosine2};
    // By the facets that send it here.
    const F cos_half = sqrt(max(F(0.5f) - F(0.5f) * dot(at.incident, to_sun), F(0.0f)));
    const F share = fresnel_dielectric(min(cos_half, one), at.eta) / max(mean, F(1e-6f));
    const F shows = select(dot(to_sun, up) > F(0.0f), F(sky_detail::above_horizon(background.to_sun_world.y)), F(0.0f));
    seen = seen + broadcast<F>(sun) * (blurred_sun(spread, chord2) * share * shows);
  }
  at.reflectance = select(rough, mean, at.reflectance);
  return select<F>(rough, seen, sharp);
}

}  // namespace shoal::inline SHOAL_ISA_NS
