// The moving parts of a scene: recorded when it is built, placed again by update_render_scene (scene/scene.h).
#pragma once

#include <vector>

#include "raster/geometry.h"
#include "scene/build/animate.h"
#include "scene/scene.h"

namespace shoal::building {

// Returns whether the animations move the vertices of a primitive of a node in world space.
//   node_moves  the result of moving_nodes
bool drawable_moves(const Scene& scene, const std::vector<char>& node_moves, std::size_t node,
                    const MeshPrimitive& mesh);

// Appends a drawable whose vertices update_render_scene writes again.
//   mesh      in the file's winding
//   mirrored  reverses the winding
void append_moving(Geometry& geometry, const MeshView& mesh, bool mirrored, Motion& motion);

// Extends the bounds of the geometry that does not move by the vertices from `first` on.
void include(Motion& motion, const Geometry& geometry, std::size_t first);

// Writes the pose's transforms into the nodes, rounded to float once.
void place_nodes(Scene& scene, const Pose& pose);

// Drops the vertices of meshes that no moving drawable and no outline of water uses.
void drop_still_vertices(Motion& motion);

}  // namespace shoal::building
