// A tree of boxes over the scene's opaque triangles: what the narrow phase asks where a layer cannot tell
// (refraction/narrow/nearest_hit.h).
//
// Leaves are sixteen consecutive triangles of a chunk, nodes have sixteen children: one ray is tested against all
// children of a node, or all triangles of a leaf, at once. Which boxes there are decides only what is looked at; what
// is found does not depend on them.
//
// Memory  about 4 bytes a triangle, 45 with corners.
#pragma once

#include <cstdint>

#include "core/pod_vector.h"
#include "raster/geometry.h"
#include "raster/material.h"

namespace shoal {

struct TriangleTree {
  static constexpr int kWidth = 16;
  static constexpr std::int32_t kNone = 0x7FFFFFFF;
  struct alignas(64) Node {
    float min_x[kWidth], min_y[kWidth], min_z[kWidth];  // world, m; empty places hold an inverted box
    float max_x[kWidth], max_y[kWidth], max_z[kWidth];
    std::int32_t child[kWidth];  // a node, ~ a leaf, or kNone
  };
  struct Leaf {
    std::int32_t first_triangle, triangle_count;  // at most kWidth
    bool one_sided, masked;
  };
  // Of a leaf's triangles: first corners, world, and the other two less it.
  struct alignas(64) Corners {
    float p0_x[kWidth], p0_y[kWidth], p0_z[kWidth];
    float e1_x[kWidth], e1_y[kWidth], e1_z[kWidth];
    float e2_x[kWidth], e2_y[kWidth], e2_z[kWidth];
  };
  PodVector<Node> nodes;       // the root last; none: nothing is opaque
  PodVector<Leaf> leaves;      // near each other as the tree has them
  PodVector<Corners> corners;  // of each, for scenes that are asked often; else empty, and read from the scene

  // Over all opaque chunks, masked ones with them.
  void build(const Geometry& geometry, const Materials& materials, bool with_corners);
  // Boxes and corners anew, after vertices have moved.
  void refit(const Geometry& geometry);
};

}  // namespace shoal
