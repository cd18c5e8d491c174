// The raw view of a geometry and its materials that the front end and the pixel stages take.
#pragma once

#include "raster/front_end.h"
#include "raster/geometry.h"
#include "shading/material.h"

namespace shoal {

// Both must outlive the view and must not grow meanwhile. Optional vertex arrays that are empty become null.
inline GeometryView view_of(const Geometry& geometry, const Materials& materials) {
  return {geometry.x_world.data(),
          geometry.y_world.data(),
          geometry.z_world.data(),
          {geometry.corner0.data(), geometry.corner1.data(), geometry.corner2.data()},
          geometry.meshlets.data(),
          geometry.vertices.data(),
          geometry.colors.empty() ? nullptr : geometry.colors.data(),
          geometry.triangles.data(),
          materials.materials.data(),
          materials.textures.data(),
          geometry.uvs1.empty() ? nullptr : geometry.uvs1.data(),
          geometry.tangents.empty() ? nullptr : geometry.tangents.data()};
}

}  // namespace shoal
