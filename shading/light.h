// Light on a surface: glTF's metallic-roughness material under directional, point and spot lights, and a hemisphere of
// ambient light or an environment.
// One function serves the rasterizer and the ray tracer.
#pragma once

#include "core/vec_lanes.h"
#include "shading/sky.h"
#include "shading/surface.h"

namespace shoal::inline SHOAL_ISA_NS {

// Roughness is at least this in the light of directional, point and spot lights: a perfect mirror would reflect such a
// light as one infinite pixel.
inline constexpr float kMinRoughness = 0.045f;
// An interpolated normal can face away from the viewer where the triangle's plane does not: the cosine is then this.
inline constexpr float kMinViewCosine = 1e-3f;
inline constexpr float kInversePi = 0.318309886f;

// The part of shading that does not depend on the light.
template <class F>
struct Reflectance {
  Vec3<F> diffuse;  // albedo of the Lambert part
  Vec3<F> f0;       // reflectance at normal incidence
  F alpha2;         // fourth power of the roughness
  Vec3<F> normal, view;
  F n_dot_v;         // at least kMinViewCosine
  F n_dot_v_signed;  // not clamped
};

template <class F>
SHOAL_INLINE Reflectance<F> make_reflectance(const SurfaceSample<F>& s, Vec3<F> view_direction) {
  const Vec3<F> dielectric = s.base_color * (F(1.0f) - s.metallic);
  const F f0_dielectric = s.f0_dielectric * (F(1.0f) - s.metallic);
  const Vec3<F> f0 = s.base_color * s.metallic + Vec3<F>{f0_dielectric, f0_dielectric, f0_dielectric};
  const F roughness = max(s.roughness, F(kMinRoughness));
  const F alpha = roughness * roughness;
  const F n_dot_v = dot(s.normal_world, view_direction);
  return {dielectric, f0, alpha * alpha, s.normal_world, view_direction, max(n_dot_v, F(kMinViewCosine)), n_dot_v};
}

// Radiance towards the viewer for unit irradiance on a surface facing the light: BRDF times cosine.
//   to_light  unit
// Returns 0 where the light is behind the surface.
// Source: glTF 2.0, appendix B.3 (Lambert; GGX; height-correlated Smith; Schlick). Differs: D and V share one division,
// and with h = l + v not normalized, D's 1 - (n.h)^2 (1 - a^2) is |h - n (n.h)|^2 + a^2 (n.h)^2 over |h|^2, which does
// not cancel on smooth surfaces. As in that model, a dielectric's diffuse part loses what the half vector's Fresnel
// term takes: at grazing views a white one reflects up to 1.3 times what it gets. Error: 2e-5 relative plus 1e-6
// against double (tests/shading/test_light.cpp).
template <class F>
SHOAL_INLINE Vec3<F> reflect_light(const Reflectance<F>& r, Vec3<F> to_light, F n_dot_l) {
  const F one(1.0f);
  const F l = max(n_dot_l, F(0.0f)), v = r.n_dot_v;
  const Vec3<F> half = to_light + r.view;
  const F half2 = max(dot(half, half), F(1e-12f));

  const F n_dot_half = n_dot_l + r.n_dot_v_signed;
  const Vec3<F> aside = half - r.normal * n_dot_half;
  const F spread = dot(aside, aside) + r.alpha2 * (n_dot_half * n_dot_half);
  const F rest = one - r.alpha2;
  const F smith = l * sqrt(v * v * rest + r.alpha2) + v * sqrt(l * l * rest + r.alpha2);
  const F denominator = max((spread * spread) * smith, F(1e-30f));
  const F specular = (F(0.5f * kInversePi) * l) * (r.alpha2 * (half2 * half2)) / denominator;

  // v.h of the unit vectors is half of |l + v|.
  const F grazing = max(one - F(0.5f) * sqrt(half2), F(0.0f));
  const F grazing2 = grazing * grazing, schlick = (grazing2 * grazing2) * grazing;
  const Vec3<F> fresnel = r.f0 * (one - schlick) + Vec3<F>{schlick, schlick, schlick};
  const F lambert = l * F(kInversePi);
  const Vec3<F> diffuse = r.diffuse * lambert;
  return diffuse + fresnel * (Vec3<F>{specular, specular, specular} - diffuse);
}

// Irradiance over pi of the hemisphere round a direction: the mean of above and below, weighted by how far it points
// up.
template <class F>
SHOAL_INLINE Vec3<F> ambient_toward(const Lighting& lighting, Vec3<F> direction) {
  const Vec3f half_up = lighting.up_world * 0.5f;
  const Vec3f rise = lighting.ambient_up - lighting.ambient_down;
  const F up = dot(direction, broadcast<F>(half_up)) + F(0.5f);
  return broadcast<F>(lighting.ambient_down) + broadcast<F>(rise) * up;
}

// Scale and bias (x, y) of f0: how much of a uniform environment the specular lobe reflects.
// Source: Karis 2014, "Physically Based Shading on Mobile" (the coefficients of his EnvBRDFApprox, after Lazarov 2013).
// Error: against the exact integral of the lobe up to 0.28 (roughness 1 at grazing), mostly below 0.2 and on the dark
// side. Differs: exp2(-9.28 x) is the sixteenth power of our cubic fit of exp2(-0.58 x), within 3e-4 of it
// (test_light.cpp pins the fit); the bias is not below 0.
template <class F>
SHOAL_INLINE Vec2<F> environment_brdf(F roughness, F n_dot_v) {
  const F square = F(-0.0088843583f) * n_dot_v + F(0.079645836f);
  const F root = (square * n_dot_v + F(-0.4017977f)) * n_dot_v + F(0.99999303f);
  const F root2 = root * root, root4 = root2 * root2, root8 = root4 * root4;
  const F smooth = F(1.0f) - roughness;
  const F peak = min(smooth * smooth, root8 * root8) * smooth + (F(-0.0275f) * roughness + F(0.0425f));
  const F scale = F(-1.04f) * peak + (F(-0.572f) * roughness + F(1.04f));
  const F bias = F(1.04f) * peak + (F(0.022f) * roughness + F(-0.04f));
  return {scale, max(bias, F(0.0f))};
}

// Ambient light reflected towards the viewer: an environment's (shading/environment/sample.h), or Lambert under the
// hemisphere and the specular lobe's mean of the sky round the mirrored direction, which goes from the sky itself
// (smooth) to the hemisphere's (rough).
template <class F>
SHOAL_INLINE Vec3<F> reflect_ambient(const SurfaceSample<F>& s, const Reflectance<F>& r, const Lighting& lighting) {
  const Vec3<F> mirrored = r.normal * (r.n_dot_v + r.n_dot_v) - r.view;
  if (lighting.background.kind == Background::Kind::kEnvironment) {
    Vec3<F> reflected;
    reflect_environment<F>(*lighting.background.environment,
                           {r.diffuse, r.f0, r.normal, mirrored, s.roughness, r.n_dot_v}, reflected);
    return reflected;
  }
  Vec3<F> around = ambient_toward<F>(lighting, mirrored);
  if (any(s.roughness < F(1.0f)))
    around = lerp(background_gradient<F>(lighting.background, mirrored), around, s.roughness);
  const Vec2<F> lobe = environment_brdf<F>(s.roughness, r.n_dot_v);
  const Vec3<F> specular = r.f0 * lobe.x + Vec3<F>{lobe.y, lobe.y, lobe.y};
  const Vec3<F> diffuse = r.diffuse * ambient_toward<F>(lighting, r.normal);
  return diffuse + specular * (around - diffuse);
}

// Lower bound of the squared distance to a light, in m^2: at the light itself the falloff would be infinite.
inline constexpr float kMinLightDistance2 = 1e-6f;

// Irradiance of a point or spot light of one candela at a point.
//   position_world  of the point, m
//   to_light        unit, from the point to the light; zero at the light itself
// Returns irradiance on a surface facing the light: 0 beyond its range and outside of its cone.
// Source: KHR_lights_punctual (range property; inner and outer cone angles). Differs: within 1 mm the distance is 1 mm.
// Error: 2e-6 of the brightest at that distance, against double (tests/shading/test_punctual.cpp).
template <class F>
SHOAL_INLINE F punctual_falloff(const PunctualLight& light, Vec3<F> position_world, Vec3<F>& to_light) {
  const Vec3<F> way = broadcast<F>(light.position_world) - position_world;
  const F distance2 = dot(way, way);
  to_light = normalize(way);
  const F shares = distance2 * F(light.inverse_range2);
  const F window = clamp(F(1.0f) - shares * shares, F(0.0f), F(1.0f));
  const F cosine = -dot(to_light, broadcast<F>(light.direction_world));
  const F cone = clamp(cosine * F(light.cone_scale) + F(light.cone_offset), F(0.0f), F(1.0f));
  return window * (cone * cone) / max(distance2, F(kMinLightDistance2));
}

// A sun without shadows.
struct OpenSun {
  template <class F>
  SHOAL_INLINE Vec3<F> reach(Vec3<F> irradiance, MaskOf<F>) const {
    return irradiance;
  }
};

// Radiance of surface points towards the viewer.
//   s               the surface points
//   unlit           lanes whose radiance is their base colour
//   view_direction  unit, from the point towards the eye
//   light_scale     transmittance of the path from the lights to the point (1 in air); of ambient light too
//   sun             reach(irradiance, lanes that face it) returns the part of the first directional light's irradiance
//                   that reaches the points
// Returns linear radiance; the unlit lanes' is exactly their base colour.
// Source: glTF 2.0, appendix B; KHR_materials_unlit. Error: see the parts.
template <class F, class Sun = OpenSun>
SHOAL_INLINE Vec3<F> shade(const SurfaceSample<F>& s, MaskOf<F> unlit, Vec3<F> view_direction, const Lighting& lighting,
                           Vec3<F> light_scale, const Sun& sun = {}) {
  if (all(unlit)) return s.base_color;
  const Reflectance<F> r = make_reflectance<F>(s, view_direction);
  Vec3<F> reflected = reflect_ambient<F>(s, r, lighting) * s.occlusion;
  for (const DirectionalLight& light : lighting.directional) {
    const Vec3<F> to_light = -broadcast<F>(light.direction_world);
    const F n_dot_l = dot(r.normal, to_light);
    if (none(n_dot_l > F(0.0f))) continue;
    Vec3<F> irradiance = broadcast<F>(light.irradiance);
    if (&light == lighting.directional.data()) irradiance = sun.template reach<F>(irradiance, n_dot_l > F(0.0f));
    reflected = reflected + irradiance * reflect_light<F>(r, to_light, n_dot_l);
  }
  for (const PunctualLight& light : lighting.punctual) {
    Vec3<F> to_light;
    const F falloff = punctual_falloff<F>(light, s.position_world, to_light);
    const F n_dot_l = dot(r.normal, to_light);
    if (none((n_dot_l > F(0.0f)) & (falloff > F(0.0f)))) continue;
    reflected = reflected + broadcast<F>(light.intensity) * (reflect_light<F>(r, to_light, n_dot_l) * falloff);
  }
  return select(unlit, s.base_color, s.emissive + light_scale * reflected);
}

}  // namespace shoal::inline SHOAL_ISA_NS
