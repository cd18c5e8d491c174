// Fetches from the planar reflection layer (refraction/narrow/sample_planar.h).
#include "refraction/narrow/sample_planar.h"

#include "raster/ray_triangle.h"

namespace shoal::inline SHOAL_ISA_NS {

void sample_planar(const RasterNarrowIn& in, const LayerPlace<WideF>& place, WideM lanes, WideI& fetches,
                   HitBlock& out) {
  constexpr float kOpen_m = 1e4f;  // where nothing is drawn the direction alone matters
  const FrameGrid& frame = in.grids.frame;
  const WideF half(0.5f);
  const WideF x = clamp(place.x_px, half, WideF(static_cast<float>(frame.width_px)) - half),
              y = clamp(place.y_px, half, WideF(static_cast<float>(frame.height_px)) - half);
  const ExactRay<WideF> flat = exact_ray(in.optics.exact, pixel_ray(in.view.view, x, y));
  const Ray<WideF> ray{flat.crossing_world, flat.reflected};
  const WideM seen = lanes & flat.crosses;
  const FetchedTriangle<WideF> triangle =
      in.layer.fetch<WideF>(LayerSlice::kNearest, to_int_trunc(x), to_int_trunc(y), seen, fetches);
  const TriangleHit<WideF> hit = intersect_triangle(ray, triangle.p0, triangle.e1, triangle.e2);
  const WideM on_plane = triangle.shown & hit.valid & (hit.t > WideF(0.0f));
  const WideF t = select(on_plane, hit.t, WideF(kOpen_m));
  triangle.id.store(out.reflected_id);
  store3(out.reflected_position, ray.origin_world + ray.direction_world * t);
  out.reflected_aimed = static_cast<std::uint16_t>(to_bits(seen));
}

}  // namespace shoal::inline SHOAL_ISA_NS
