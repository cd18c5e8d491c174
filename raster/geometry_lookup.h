// From a triangle's id to what it is part of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "raster/geometry.h"

namespace shoal {

// The drawable that a triangle is part of.
//   drawables    of the geometry, in the order of their triangles
//   triangle_id  of the geometry: 0 to its number of triangles less 1
// Returns the index into drawables: the last drawable that starts at or before the triangle; 0 where there are none.
std::size_t drawable_of(std::span<const Drawable> drawables, std::int32_t triangle_id);
inline std::size_t drawable_of(const Geometry& geometry, std::int32_t triangle_id) {
  return drawable_of(geometry.drawables, triangle_id);
}

}  // namespace shoal
