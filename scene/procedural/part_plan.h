// Fits a scene to a number of triangles: it selects parts and the level of detail of each.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <vector>

#include "scene/procedural/mesh_builder.h"
#include "scene/scene.h"

namespace shoal {

// Adds a part to a builder at a level of detail, 1 the coarsest; a higher level never has fewer triangles.
using PartFn = void (*)(PartBuilder& b, int level);

struct Part {
  const char* name;
  PartFn add;
  std::vector<Mat4> places;      // one copy at each
  double share;                  // of the triangles, for all copies together
  bool always;                   // false: included only where enough triangles remain
  const char* plural = nullptr;  // name of the copies' parent node where it is not the name and an s
};

// Returns the matrices of upright copies at some points.
std::vector<Mat4> places_at(std::initializer_list<Vec3f> at);
inline std::vector<Mat4> placed_once() { return {kIdentity4}; }

// Adds a mesh and a node for each part, or, for several copies, a node for each below a common parent. The triangles
// add up to about `triangles`.
//   parts   in order of importance; one that is not `always` is left out where the triangles do not suffice
//   filler  always included, with one copy; it uses the triangles that the other parts leave over
void add_parts(Scene& scene, const std::vector<Part>& parts, const Part& filler, std::uint64_t triangles);

}  // namespace shoal
