// A tree of boxes over the scene's opaque triangles: what the narrow phase asks where a layer cannot tell
// (refraction/narrow/nearest_hit.h).
//
// Leaves are sixteen consecutive triangles of a chunk, nodes have sixteen children: one ray is tested against all
// children of a node, or all triangles of a leaf, at once. Which boxes there are decides only what is looked at; what is
// found does not depend on them.
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
  PodVector<Node> nodes;  // the root last; none: nothing is opaque
  PodVector<Leaf> leaves;

  // Over all opaque chunks, masked ones with them.
  void build(const Geometry& geometry, const Materials& materials);
  // The boxes anew, after vertices have moved.
  void refit(const Geometry& geometry);
};

}  // namespace shoal
