// Places in the lit layer, and what an image-space method may read to find them.
#pragma once

#include "refraction/data/category.h"
#include "refraction/passes/lit_layer.h"

namespace shoal::inline SHOAL_ISA_NS {

// What sample_place may read for sixteen pixels.
struct SampleIn {
  const RasterNarrowIn& narrow;
  const Block& block;
  Ray<WideF> view_ray;
  const ExactRay<WideF>& at;  // where it crosses the surface, waves included
  WideM lanes;                // that sample: water, not totally reflecting
  WideI& fetches;             // of each lane: added to

  const View& view() const { return narrow.view.view; }
  const WaterOptics& optics() const { return narrow.optics; }
  template <class Options>
  const Options& options() const {
    return narrow.state.options_as<Options>();
  }
};

// The triangles that the layer shows at the pixels themselves.
SHOAL_INLINE FetchedTriangle<WideF> own_triangles(const SampleIn& in) {
  return in.narrow.layer.fetch<WideF>(LayerSlice::kNearest, WideI(in.block.x_px) + block_x(),
                                      WideI(in.block.y_px) + block_y(), in.lanes, in.fetches);
}

// A direction above the plane as the planar reflection layer sees it: mirrored in the plane.
SHOAL_INLINE Vec3<WideF> mirrored_direction(const SampleIn& in, const Vec3<WideF>& direction) {
  return reflect(direction, in.at.plane_normal);
}

// The pixels' own places.
SHOAL_INLINE LayerPlace<WideF> own_place(int x_px, int y_px) {
  return {to_float(WideI(x_px) + block_x()) + WideF(0.5f), to_float(WideI(y_px) + block_y()) + WideF(0.5f)};
}

// Where a point of the layer's space projects to; behind the eye, far off.
SHOAL_INLINE LayerPlace<WideF> project_place(const View& view, Vec3<WideF> p) {
  const ClipVertex<WideF> clip = project(view, p);
  const WideF inverse_w = WideF(1.0f) / max(clip.w, WideF(1e-6f));
  return {clip.x * inverse_w + WideF(view.centre_px.x), clip.y * inverse_w + WideF(view.centre_px.y)};
}

SHOAL_INLINE LayerPlace<WideF> select_place(WideM m, LayerPlace<WideF> a, LayerPlace<WideF> b) {
  return {select(m, a.x_px, b.x_px), select(m, a.y_px, b.y_px)};
}

}  // namespace shoal::inline SHOAL_ISA_NS
