// A scene as parts with a level of detail each: which parts come, and how finely, for a number of triangles.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <vector>

#include "scene/procedural/mesh_builder.h"
#include "scene/scene.h"

namespace shoal {

// Adds the part at a level, 1 the coarsest; more levels never mean fewer triangles.
using PartFn = void (*)(PartBuilder& b, int level);

struct Part {
  const char* name;
  PartFn add;
  std::vector<Mat4> places;      // a copy stands at each
  double share;                  // of what is to be handed out, for all copies together
  bool always;                   // else only when there are triangles to spare
  const char* plural = nullptr;  // of the copies' parent node, where it is not the name and an s
};

// Upright copies.
std::vector<Mat4> places_at(std::initializer_list<Vec3f> at);
inline std::vector<Mat4> placed_once() { return {kIdentity4}; }

// Adds a mesh and a node a part, or a node a copy below one for them all, so that the triangles add up to about
// `triangles`.
//   parts   in order of importance: as soon as one that is not `always` cannot be had it is left out
//   filler  always there, and last: takes what the others leave over. It has one place
void add_parts(Scene& scene, const std::vector<Part>& parts, const Part& filler, std::uint64_t triangles);

}  // namespace shoal
