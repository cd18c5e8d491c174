// The alpha test of the visibility passes.
#pragma once

#include "raster/resolve.h"
#include "shading/material_uv.h"
#include "shading/surface.h"

namespace shoal::inline SHOAL_ISA_NS {

// Tests one alpha-tested triangle where rays meet it.
//   materials, textures  of the scene
//   ray, differential    world; its change by pixel, which filters the texture
//   id                   the triangle
//   cover                the pixels that it covers
// Returns the covered pixels whose alpha is at least the material's cutoff.
// Source: glTF 2.0, 3.9.4 (alphaCutoff).
__attribute__((noinline)) inline WideM alpha_cut(const GeometryView& g, const Material* materials,
                                                 const Texture* textures, const Ray<WideF>& ray,
                                                 const RayDifferential<WideF>& differential, std::int32_t id,
                                                 WideM cover) {
  PixelAttributes<WideF> a;
  resolve_attributes(g, ray, differential, WideI(id), cover, a);
  const Material& material = materials[g.triangles[id].material];
  const UvPoint<WideF> at = map_point(g, a, material.base_color_uv);
  const WideF alpha = surface_alpha<WideF>(material, textures, at.uv, at.duv_dx, at.duv_dy, a.color.w, cover);
  return cover & (alpha >= WideF(material.alpha_cutoff));
}

}  // namespace shoal::inline SHOAL_ISA_NS
