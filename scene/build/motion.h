// The parts of a scene that move: noted when it is built, placed anew by update_render_scene (scene/scene.h).
#pragma once

#include <vector>

#include "raster/geometry.h"
#include "scene/build/animate.h"
#include "scene/scene.h"

namespace shoal::building {

// Does this primitive of this node change its vertices in the world?
//   node_moves  of moving_nodes
bool drawable_moves(const Scene& scene, const std::vector<char>& node_moves, std::size_t node,
                    const MeshPrimitive& mesh);

// Appends a drawable whose vertices will be written again.
//   mesh  with the file's winding, mirrored or not
void append_moving(Geometry& geometry, const MeshView& mesh, bool mirrored, Motion& motion);

// Widens the bounds of what stands still by the vertices from `first` on.
void include(Motion& motion, const Geometry& geometry, std::size_t first);

// Writes the pose's transforms into the nodes, rounded to float once.
void place_nodes(Scene& scene, const Pose& pose);

// Drops the vertices of meshes that no moving drawable and no moving body of water uses.
void forget_still_vertices(Motion& motion);

}  // namespace shoal::building
