// Liu et al.'s narrow phase: what the flat water shows at a pixel is taken for a plane, and the bent ray meets that.
#pragma once

#include "raster/resolve.h"
#include "refraction/methods/image_space.h"

namespace shoal::inline SHOAL_ISA_NS {

// Where nothing is drawn, this far along the ray: the direction alone counts.
constexpr float kOpen_m = 1e4f;

// The distance along a ray from the surface at which it meets the plane of the triangle that the layer shows at the
// pixel itself; where the ray goes along that plane or away from it, the distance of the point shown.
SHOAL_INLINE WideF plane_look(const LookUp& l, const Ray<WideF>& ray) {
  const std::size_t offset = l.block.offset;
  const WideI own = WideI::load(l.f.refracted.id.data() + l.f.layers.offset(l.block.x_px, l.block.y_px));
  const WideM drawn = l.lanes & is_triangle(own);
  if (none(drawn)) return WideF(kOpen_m);
  const LitPoints& layer = l.f.layer;
  const Vec3<WideF> shown{WideF::load(layer.x_world.data() + offset), WideF::load(layer.y_world.data() + offset),
                          WideF::load(layer.z_world.data() + offset)};
  const WideF t = triangle_distance(l.f.geometry, ray, own, drawn);
  const WideF met = select((t > WideF(0.0f)) & (t < WideF(kOpen_m)), t, length(shown - ray.origin_world));
  return select(drawn, met, WideF(kOpen_m));
}

}  // namespace shoal::inline SHOAL_ISA_NS
