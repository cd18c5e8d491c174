// From a triangle's id to what it is part of.
#pragma once

#include <cstddef>
#include <cstdint>

#include "raster/geometry.h"

namespace shoal {

// The drawable that a triangle is part of.
//   triangle_id  of the geometry: 0 to its number of triangles less 1
// Returns the index into geometry.drawables: the last drawable that starts at or before the triangle; 0 where the
// geometry has no drawables.
std::size_t drawable_of(const Geometry& geometry, std::int32_t triangle_id);

}  // namespace shoal
