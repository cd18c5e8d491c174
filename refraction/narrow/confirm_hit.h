// Narrow phase, last step: the true ray against the triangle that the broad phase shows at its pixel, or one of a
// neighbouring pixel where the first test misses.
#pragma once

#include "raster/triangle_test.h"
#include "raster/visibility.h"

namespace shoal::inline SHOAL_ISA_NS {

struct ConfirmedHit {
  WideI id;
  WideM held;  // the ray does hit the triangle
  WideM bare;  // neither the pixel nor a neighbour shows any triangle
};

//   ray         the true ray of each lane, starting at the water
//   own         the id that the visibility buffer shows at the pixel itself
//   x_px, y_px  of the pixels, in the buffer's grid; lanes: which of them
// Returns the triangle that the ray hits: the pixel's own where that holds, else the nearest that holds among the
// eight neighbours', else the pixel's own after all (its point is then brought into the triangle: resolve.h).
ConfirmedHit confirm_hit(const GeometryView& g, const VisibilityBuffer& visibility, const Ray<WideF>& ray, WideI own,
                         WideI x_px, WideI y_px, WideM lanes);

}  // namespace shoal::inline SHOAL_ISA_NS
