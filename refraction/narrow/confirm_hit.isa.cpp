// Narrow phase, last step (refraction/narrow/confirm_hit.h).
#include "refraction/narrow/confirm_hit.h"

#include "raster/blocks.h"

namespace shoal::inline SHOAL_ISA_NS {

ConfirmedHit confirm_hit(const GeometryView& g, const VisibilityBuffer& visibility, const Ray<WideF>& ray, WideI own,
                         WideI x_px, WideI y_px, WideM lanes) {
  const WideM drawn = lanes & (own >= WideI(0)) & (own != WideI(kNoId));
  WideM missing = lanes;
  if (any(drawn)) missing = lanes & !test_triangles(g, ray, own, drawn).inside;
  if (none(missing)) return {own, lanes, mask_from_bits(0)};
  WideM shown = drawn;
  WideI best = own;
  WideF best_t(3e38f);
  const WideI x_last(visibility.grid.width_px - 1), y_last(visibility.grid.height_px - 1);
  for (int i = 0; i < 9; ++i) {
    if (i == 4) continue;
    const WideI x = x_px + WideI(i % 3 - 1), y = y_px + WideI(i / 3 - 1);
    const WideM there = missing & (x >= WideI(0)) & (x <= x_last) & (y >= WideI(0)) & (y <= y_last);
    const WideI id = gather(visibility.id.data(), pixel_slots(visibility.grid, x, y), there, WideI(kNoId));
    shown = shown | (there & is_triangle(id));
    const WideM candidate = there & is_triangle(id) & (id != own) & (id != best);
    if (none(candidate)) continue;
    const TriangleTest test = test_triangles(g, ray, id, candidate);
    const WideM better = test.inside & (test.t < best_t);
    best = select(better, id, best);
    best_t = select(better, test.t, best_t);
  }
  return {best, (lanes & !missing) | (missing & (best_t < WideF(3e38f))), lanes & !shown};
}

}  // namespace shoal::inline SHOAL_ISA_NS
