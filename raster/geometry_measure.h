// The size of a mesh once it is cut into meshlets, so that a builder can reserve exactly, and the extent of a meshlet
// (raster/geometry.cpp).
#pragma once

#include <cstddef>

#include "raster/geometry.h"

namespace shoal {

struct GeometrySize {
  std::size_t vertices = 0, corners = 0, triangles = 0, meshlets = 0, drawables = 0;
};

// Adds what append_mesh(geometry, mesh) would append. Reads indices, vertex_count, index_count and drawn only.
void measure_mesh(const MeshView& mesh, GeometrySize& size);

// Reserves room for `size` more in every array; the colours' too when `with_colors`.
void reserve_geometry(Geometry& geometry, const GeometrySize& size, bool with_colors);

// Bounds and longest edge of a meshlet whose vertices and corners are in place.
void measure_meshlet(const Geometry& geometry, Meshlet& meshlet);

}  // namespace shoal
