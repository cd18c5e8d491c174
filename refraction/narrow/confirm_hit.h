// Narrow phase, last step: the true ray meets the triangle that the broad phase shows at its pixel, or one of a
// neighbouring pixel that the first miss points to.
#pragma once

#include "raster/triangle_test.h"
#include "refraction/frame_data.h"

namespace shoal::inline SHOAL_ISA_NS {

struct ConfirmedHit {
  WideI id;
  WideM held;  // the ray does meet it
  WideM bare;  // neither the pixel nor a neighbour shows any triangle
};

//   ray         the true ray of each lane, starting at the water
//   own         what the visibility buffer shows at the pixel itself
//   x_px, y_px  of the pixels; lanes: which of them
// Returns the triangle that the ray meets: the pixel's own where that holds, else the nearest that holds among the
// eight neighbours', else the pixel's own after all (its point is then brought into the triangle: resolve.h).
ConfirmedHit confirm_hit(const GeometryView& g, const VisibilityBuffer& visibility, const Ray<WideF>& ray, WideI own,
                         WideI x_px, WideI y_px, WideM lanes);

}  // namespace shoal::inline SHOAL_ISA_NS
