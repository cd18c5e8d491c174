#include "raster/geometry_lookup.h"

namespace shoal {

std::size_t drawable_of(std::span<const Drawable> drawables, std::int32_t triangle_id) {
  std::size_t lo = 0, hi = drawables.size();
  while (hi - lo > 1) {
    const std::size_t middle = (lo + hi) / 2;
    const bool starts_before = drawables[middle].first_triangle <= static_cast<std::uint32_t>(triangle_id);
    (starts_before ? lo : hi) = middle;
  }
  return lo;
}

}  // namespace shoal
