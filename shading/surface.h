// Surface points, made from a material and interpolated attributes: the content of the G-buffer.
#pragma once

#include "core/vec_lanes.h"
#include "shading/material.h"
#include "shading/textures/sample.h"

namespace shoal {

// One surface point a lane. World space, linear light.
template <class F>
struct SurfaceSample {
  Vec3<F> position_world;
  Vec3<F> normal_world;  // unit, shading; towards the viewer on double-sided materials
  Vec3<F> base_color;
  F alpha;
  F metallic, roughness;  // 0 to 1
  Vec3<F> emissive;
  F f0_dielectric = F(0.04f);  // reflectance at normal incidence of the part that is not metal
  F occlusion = F(1.0f);       // share of ambient light that arrives
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

// Surface points of one material.
//   position          world, m
//   normal            world, interpolated: any length but 0 (which stays 0)
//   uv, duv_dx, duv_dy  the base colour's texture coordinates and their change over one pixel
//   vertex_color      linear RGBA; 1 where the mesh has none
//   view_direction    world, from the point towards the eye, any length
//   active            lanes that are set; the others hold no surface
// Source: glTF 2.0, 3.9 (materials): factors, texture and COLOR_0 multiply. Differs: a double-sided material's normal
// is turned by the shading normal's side, not by the triangle's. The other textures: shading/surface_maps.h.
template <class F>
SHOAL_INLINE SurfaceSample<F> make_surface(const Material& material, const Texture* textures, Vec3<F> position,
                                           Vec3<F> normal, Vec2<F> uv, Vec2<F> duv_dx, Vec2<F> duv_dy,
                                           Vec4<F> vertex_color, Vec3<F> view_direction, MaskOf<F> active) {
  SurfaceSample<F> s;
  s.position_world = position;
  s.normal_world = normalize(normal);
  if (material.double_sided)
    s.normal_world = select(dot(s.normal_world, view_direction) < F(0.0f), -s.normal_world, s.normal_world);

  const Vec4f factor = material.base_color;
  Vec4<F> color = {F(factor.x) * vertex_color.x, F(factor.y) * vertex_color.y, F(factor.z) * vertex_color.z,
                   F(factor.w) * vertex_color.w};
  if (material.base_color_texture != kNoTexture) {
    const Texture& texture = textures[static_cast<std::size_t>(material.base_color_texture)];
    const Vec4<F> texel = sample<F>(texture, material.base_color_sampler, uv, duv_dx, duv_dy, active);
    color = {color.x * texel.x, color.y * texel.y, color.z * texel.z, color.w * texel.w};
  }
  s.base_color = {color.x, color.y, color.z};
  // glTF 3.9.4: an opaque material's alpha is ignored.
  s.alpha = material.alpha_mode == AlphaMode::kOpaque ? F(1.0f) : color.w;
  s.metallic = F(material.metallic);
  s.roughness = F(material.roughness);
  s.emissive = broadcast<F>(material.emissive);
  return s;
}

// Alpha alone, for the visibility pass: the same bits as make_surface's before opaque materials ignore it.
template <class F>
SHOAL_INLINE F surface_alpha(const Material& material, const Texture* textures, Vec2<F> uv, Vec2<F> duv_dx,
                             Vec2<F> duv_dy, F vertex_alpha, MaskOf<F> active) {
  const F alpha = F(material.base_color.w) * vertex_alpha;
  if (material.base_color_texture == kNoTexture) return alpha;
  const Texture& texture = textures[static_cast<std::size_t>(material.base_color_texture)];
  return alpha * sample<F>(texture, material.base_color_sampler, uv, duv_dx, duv_dy, active).w;
}

}  // namespace shoal::inline SHOAL_ISA_NS
