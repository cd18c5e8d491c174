// Pointers into a geometry, so that kernels touch no container.
#pragma once

#include <cstdint>

#include "raster/draw_state.h"
#include "raster/geometry.h"

namespace shoal {

struct GeometryView {
  const float *x_world = nullptr, *y_world = nullptr, *z_world = nullptr;
  const std::uint8_t* corner[3] = {};
  const Meshlet* meshlets = nullptr;
  const VertexRecord* vertices = nullptr;
  const Vec4f* colors = nullptr;  // null: the geometry has none
  const Geometry::TriangleRecord* triangles = nullptr;
  const DrawState* draw_states = nullptr;  // by material
  const Vec2f* uvs1 = nullptr;             // null: the geometry has none
  const Vec4f* tangents = nullptr;         // null: the geometry has none
};

// Views a geometry.
//   geometry     must outlive the view and must not grow meanwhile
//   draw_states  one a material of the geometry; must outlive the view
// Returns the view; optional vertex arrays that are empty become null.
inline GeometryView view_of(const Geometry& geometry, const DrawState* draw_states) {
  GeometryView view;
  view.x_world = geometry.x_world.data();
  view.y_world = geometry.y_world.data();
  view.z_world = geometry.z_world.data();
  view.corner[0] = geometry.corner0.data();
  view.corner[1] = geometry.corner1.data();
  view.corner[2] = geometry.corner2.data();
  view.meshlets = geometry.meshlets.data();
  view.vertices = geometry.vertices.data();
  view.colors = geometry.colors.empty() ? nullptr : geometry.colors.data();
  view.triangles = geometry.triangles.data();
  view.draw_states = draw_states;
  view.uvs1 = geometry.uvs1.empty() ? nullptr : geometry.uvs1.data();
  view.tangents = geometry.tangents.empty() ? nullptr : geometry.tangents.data();
  return view;
}

}  // namespace shoal
