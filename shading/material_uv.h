// The texture coordinates that one of a material's textures is read with.
#pragma once

#include "raster/resolve.h"
#include "shading/textures/uv_map.h"

namespace shoal::inline SHOAL_ISA_NS {

// Chooses and transforms one of a pixel's two sets of coordinates.
//   g    the geometry; without a second set, that set is (0, 0)
//   a    the pixels' attributes, of that geometry
//   map  which set, and its transform
SHOAL_INLINE UvPoint<WideF> map_point(const GeometryView& g, const PixelAttributes<WideF>& a, const UvMap& map) {
  UvPoint<WideF> p{a.uv, a.duv_dx, a.duv_dy};
  if (map.set == 1) {
    const Vec2<WideF> zero = broadcast<WideF>(Vec2f{0, 0});
    p = g.uvs1 != nullptr ? UvPoint<WideF>{a.uv1, a.duv1_dx, a.duv1_dy} : UvPoint<WideF>{zero, zero, zero};
  }
  return map.transformed ? transform_uv<WideF>(map, p) : p;
}

}  // namespace shoal::inline SHOAL_ISA_NS
