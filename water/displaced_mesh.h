// The displaced surface as a mesh: three bands of distance, each twice as fine as the one behind it.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "water/surface_data.h"

namespace shoal {

// In the body's own coordinates: x and z along the plane's axes from its origin, y the height over the plane; metres.
struct DisplacedMeshView {
  Vec3f eye{0, 0, 0};
  float range_m = 100;  // Li's d: bands end at range / 4 and range / 2; cells beyond the range are left out
  float cell_m = 1;     // cells of the farthest band have sides of this at most (and 1/256 of the body at least)
  // Inside is x n.x + y n.y + z n.z + n.w >= 0. None: nothing is culled.
  std::vector<Vec4f> frustum;
};

struct DisplacedMesh {
  std::vector<Vec3f> positions;
  std::vector<Vec2f> slopes;           // derivatives of the height along the axes, at the positions
  std::vector<std::uint32_t> indices;  // three a triangle, counter-clockwise seen from above
};

// The surface over a rectangle of the plane.
//
//   surface  prepared for this time
//   extent   metres; of no area: an empty mesh
//   view     see there; range_m and cell_m more than 0
// Returns vertices that lie exactly on the surface, at most once at each place. No cracks: an edge inside of the mesh
// belongs to two triangles, with the same two vertices. A cell of the farthest band is of one band as a whole, by the
// distance of its middle from the eye; culled are such cells, where the box of their greatest heights is outside.
// Source: Li et al., section 2.2. Differs: they say nothing of cracks; here the coarser of two cells has the finer
// one's
//         vertices on its side, in a fan about its middle.
DisplacedMesh displaced_mesh(const WaterSurface& surface, const PlaneExtent& extent, const DisplacedMeshView& view);

}  // namespace shoal
