// A material's other textures on a surface: metallic and roughness, normals, occlusion, emission.
#pragma once

#include "raster/resolve.h"
#include "shading/material_uv.h"
#include "shading/surface.h"

namespace shoal::inline SHOAL_ISA_NS {

// Reflectance of a dielectric in air at normal incidence. 1.5 gives exactly the 0.04 of glTF's appendix B.
// Source: KHR_materials_ior: ((ior - 1) / (ior + 1))^2; an ior of 0 gives 1.
SHOAL_INLINE float dielectric_f0(float ior) {
  if (ior == 1.5f) return 0.04f;
  const float r = (ior - 1.0f) / (ior + 1.0f);
  return r * r;
}

// A normal out of a tangent frame.
//   normal      unit, world; tangent: any length, world, 0 where there is none; bitangent = cross(normal, tangent) h
//   texel       of the normal map, 0 to 1
//   scale       of its x and y
// Returns a unit vector; `normal` where the texel is no direction.
// Source: glTF 2.0, 3.9.3 (normalTexture) and 3.7.2.1 (tangent frame). Differs: like the specification's own text, the
// tangent is not made orthogonal to the interpolated normal. Error: 1e-6 (tests/shading/test_surface_maps.cpp).
template <class F>
SHOAL_INLINE Vec3<F> mapped_normal(Vec3<F> normal, Vec3<F> tangent, F handedness, Vec4<F> texel, float scale) {
  const F two(2.0f), one(1.0f);
  const F x = (texel.x * two - one) * F(scale), y = (texel.y * two - one) * F(scale), z = texel.z * two - one;
  const Vec3<F> t = normalize(tangent);
  const Vec3<F> b = cross(normal, t) * handedness;
  const Vec3<F> n = t * x + b * y + normal * z;
  const F length2 = dot(n, n);
  return select(length2 > F(1e-12f), normalize(n), normal);
}

// Applies the maps of a material that has any.
//   a       attributes of the pixels
//   s       the surface that make_surface returned for them; changed
//   active  lanes that are set; the others hold no surface
// Source: glTF 2.0, 3.9.2 to 3.9.4; KHR_materials_ior.
SHOAL_INLINE void apply_maps(const GeometryView& g, const Material& material, const Texture* textures,
                             const PixelAttributes<WideF>& a, Vec3<WideF> view_direction, WideM active,
                             SurfaceSample<WideF>& s) {
  const auto texel = [&](const MaterialMap& map) SHOAL_LAMBDA {
    const UvPoint<WideF> at = map_point(g, a, map.uv);
    return sample<WideF>(textures[static_cast<std::size_t>(map.texture)], map.sampler, at.uv, at.duv_dx, at.duv_dy,
                         active);
  };
  s.f0_dielectric = WideF(dielectric_f0(material.ior));
  if (material.metallic_roughness.texture != kNoTexture) {
    const Vec4<WideF> t = texel(material.metallic_roughness);
    s.roughness = s.roughness * t.y;
    s.metallic = s.metallic * t.z;
  }
  if (material.normal.texture != kNoTexture && g.tangents != nullptr) {
    const Vec4<WideF> t = texel(material.normal);
    const Vec3<WideF> n = mapped_normal<WideF>(a.normal_world, a.tangent_world, a.handedness, t, material.normal_scale);
    // As make_surface turns the normal of a double-sided material.
    const WideM away = dot(a.normal_world, view_direction) < WideF(0.0f);
    s.normal_world = material.double_sided ? select<WideF>(away, -n, n) : n;
  }
  if (material.occlusion.texture != kNoTexture) {
    const WideF strength(material.occlusion_strength), one(1.0f);
    s.occlusion = one + strength * (texel(material.occlusion).x - one);
  }
  if (material.emission.texture != kNoTexture) {
    const Vec4<WideF> t = texel(material.emission);
    s.emissive = s.emissive * Vec3<WideF>{t.x, t.y, t.z};
  }
}

}  // namespace shoal::inline SHOAL_ISA_NS
