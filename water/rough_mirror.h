// The mean of the background that water mirrors, over the slopes of waves that a pixel's footprint hides.
#pragma once

#include "core/math.h"
#include "core/vec_lanes.h"
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

// Slopes of a thousandth: they turn a reflected ray by less than half of the sun's width.
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

// The sky's sun, blurred: the powers cos^n of its glow become normal lobes of variance 1 / n, its disc stays as it is
// near the eye and becomes, the more so the wider the spread, a normal lobe of its variance and content.
template <class F, class Sky>
SHOAL_INLINE F blurred_sun(const Sky& sky, const Spread<F>& s, F chord2) {
  const auto lobe = [&](int i)
                        SHOAL_LAMBDA { return F(Sky::kGlow[i].height) * blurred_lobe(s, 1.0f / Sky::kGlow[i].power); };
  const F glow = (lobe(0) + lobe(1)) + (lobe(2) + lobe(3));
  // Its edge falls by smoothstep from u = 1 to u = 2.3 / 1.3 in u = (angle / radius)^2: mean and second moment.
  constexpr float kVariance = 0.3514f * Sky::kDiscRadius2, kHeight = 0.5f * 1.3846f / 0.3514f;
  const F disc = sky.template disc<F>(chord2);
  const F gone = s.variance_along / (s.variance_along + F(kVariance));
  return glow + (disc + (F(kHeight) * blurred_lobe(s, kVariance) - disc) * gone);
}

}  // namespace rough_mirror_detail

// The mean background in water, and the mean reflectance.
template <class F>
struct RoughMirror {
  Vec3<F> radiance;  // linear, the mean weighted by reflectance
  F reflectance;     // 1 where the ray is totally reflected
};

// The means, over the slopes that a pixel hides, of the reflectance and of the background in reflection.
//
//   sky        the background: shading/sky.h's SkyView, or anything with its members
//   body       of water
//   displaced  the surface is the height field: slopes count by the area that the ray sees of them, and normals are
//              not bent for a plane
//   mirrored   unit, world: the reflected direction of lanes whose surface is smooth
//   at         a ray at the water; smooth is a slope_variance of at most kLeastVariance
// Returns the means; in smooth lanes the background along `mirrored`, and at.reflectance. The scene in reflection, and
// all of the refraction, stay sharp: they follow the mean normal.
// Method: the hidden slopes have a normal distribution, represented by five points along the plane of incidence, where
//   directions spread most; at each the environment is averaged over a lobe that has the rest of the variance; the sun
//   is in closed form.
// Source: Ross, Dion and Potvin 2005, and Bruneton, Neyret and Holzschuch 2010, "Real-time realistic ocean lighting"
//   (slope distributions, the sun by its half vector). Differs: points instead of one lookup; waves do not hide others.
// Error: of the reflected light, against means over normally distributed slopes: 5 % where an axis's slopes are up to
//   0.03, 8 % (displaced: 15 %) at 0.1; of an environment 7 and 17 %, for GGX's long tails
//   (tests/refraction/test_wave_filter.cpp).
template <class F, class Sky>
__attribute__((noinline)) RoughMirror<F> mirror_roughly(const Sky& sky, const WaterBody& body, bool displaced,
                                                        Vec3<F> mirrored, const ExactRay<F>& at) {
  using namespace rough_mirror_detail;
  const MaskOf<F> rough = at.slope_variance > F(kLeastVariance);
  const Vec3<F> sharp = sky.template radiance<F>(mirrored);
  if (none(rough)) return {sharp, at.reflectance};

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
  // The environment's lobe is round. It is as wide as directions spread across the plane of incidence, but at least
  // half as wide as along it, or the points would show one by one; the points have the rest of the variance.
  const bool lobes = sky.has_environment();
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
    brought =
        brought + (lobes ? sky.template lobe<F>(direction, roughness) : sky.template gradient<F>(direction)) * reflects;
  }
  const F mean = select(at.transmitted, reflected / max(shares, F(1e-30f)), one);
  Vec3<F> seen = brought * (one / max(reflected, F(1e-30f)));

  if (sky.has_sun()) {
    const Vec3<F> to_sun = broadcast<F>(sky.to_sun_world());
    const Vec3<F> middle = reflect(at.incident, at.normal), off = to_sun - middle;
    const F chord2 = dot(off, off), side = dot(off, cross(up, along)), across2 = side * side;
    const F cosine2 = at.cos_incident * at.cos_incident;
    const Spread<F> spread = {max(chord2 - across2, F(0.0f)), across2, F(4.0f) * variance,
                              F(4.0f) * variance * cosine2};
    // Fresnel at the facets that reflect the sun along the ray.
    const F cos_half = sqrt(max(F(0.5f) - F(0.5f) * dot(at.incident, to_sun), F(0.0f)));
    const F share = fresnel_dielectric(min(cos_half, one), at.eta) / max(mean, F(1e-6f));
    const F shows = select(dot(to_sun, up) > F(0.0f), F(sky.sun_risen()), F(0.0f));
    seen = seen + broadcast<F>(sky.sun()) * (blurred_sun(sky, spread, chord2) * share * shows);
  }
  return {select<F>(rough, seen, sharp), select(rough, mean, at.reflectance)};
}

}  // namespace shoal::inline SHOAL_ISA_NS
