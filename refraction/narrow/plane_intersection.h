// Liu et al.'s narrow phase: what flat water shows at a pixel is taken for a plane, and the bent ray intersects it.
#pragma once

#include "refraction/data/capture.h"
#include "refraction/narrow/sample_place.h"

namespace shoal::inline SHOAL_ISA_NS {

// Where nothing is drawn the ray counts as this long, so that its direction alone matters.
inline constexpr float kOpen_m = 1e4f;

// The distance along a ray from the surface at which it intersects the plane of the triangle that the layer shows at
// the pixel itself; where the ray goes along that plane or away from it, the distance of the point shown.
SHOAL_INLINE WideF plane_distance(const SampleIn& in, const Ray<WideF>& ray) {
  const LayerView& layer = in.narrow.layer;
  const WideI own = WideI::load(layer.id() + layer.grid().offset(in.block.x_px, in.block.y_px));
  const WideM drawn = in.lanes & is_triangle(own);
  if (none(drawn)) return WideF(kOpen_m);
  const Vec3<WideF> shown = load_plane(in.narrow.lit.position_world, in.block.offset);
  const WideF t = layer.plane_distance(ray, own, drawn);
  const WideF hit = select((t > WideF(0.0f)) & (t < WideF(kOpen_m)), t, length(shown - ray.origin_world));
  return select(drawn, hit, WideF(kOpen_m));
}

}  // namespace shoal::inline SHOAL_ISA_NS
