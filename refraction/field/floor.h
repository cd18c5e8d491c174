// The level floor under a body of water, for methods that know no other geometry (block_grid.cpp).
#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace shoal {

// A level plane and the triangles of one drawable that lie in it, found by place. Places are metres along the body's
// axis_x and axis_z from its origin.
struct Floor {
  float height_m = 0;  // below 0: of the floor over the body's plane
  // A grid of cells over the triangles: those of cell c are first[c] to first[c + 1] of `triangles`, in order of id.
  std::int32_t cells_x = 1, cells_z = 1;
  float min_x_m = 0, min_z_m = 0, cells_per_m_x = 0, cells_per_m_z = 0;
  std::vector<std::uint32_t> first;
  struct Triangle {
    float x[3], z[3];  // counter-clockwise from above
    std::int32_t id;
  };
  std::vector<Triangle> triangles;

  // The triangle at a place, the one of the smallest id; kNoId where there is none.
  std::int32_t at(float x_m, float z_m) const;
};

// Finds a body's floor: of every drawn, opaque drawable the triangles that are level (their corners' heights within
// 1e-4 m), at least 1 mm under the plane and not below the body's depth, in the outline's bounds and seen from above;
// those of one drawable within 1 mm of one height are a floor, and the greatest by area is the one, if it is as large
// as half of the outline. Throws NotApplicable where there is none.
Floor find_floor(const RenderScene& scene, const WaterBody& body);

}  // namespace shoal
