// A tree of boxes over the scene's opaque triangles: what the narrow phase asks (refraction/narrow/nearest_hit.h).
//
// Nodes have sixteen children, leaves sixteen triangles near each other: all boxes of either are tested at once. Which
// boxes there are decides only what is looked at; what is found does not depend on them.
//
// Memory  about 46 bytes a triangle.
#pragma once

#include <cstdint>

#include "core/pod_vector.h"
#include "core/thread_pool.h"
#include "raster/geometry.h"
#include "raster/material.h"

namespace shoal {

struct TriangleTree {
  static constexpr int kWidth = 16;
  static constexpr std::int32_t kNone = 0x7FFFFFFF;
  static constexpr int kMostLevels = 68;  // of nodes, whatever the scene
  // Boxes, world, m, by axis; empty places hold an inverted one.
  struct alignas(64) Boxes {
    float lo[3][kWidth], hi[3][kWidth];
  };
  struct alignas(64) Node {
    Boxes boxes;
    std::int32_t child[kWidth];  // a node, ~ a leaf, or kNone
  };
  struct alignas(64) Leaf {
    float p0[3][kWidth], e1[3][kWidth], e2[3][kWidth];  // first corners, world, and the other two less it
    std::int32_t id[kWidth];                            // of the triangles; kNone: an empty place
  };
  struct Kinds {
    std::uint16_t there, one_sided, masked;  // a bit a triangle
  };
  PodVector<Node> nodes;   // the root last; none: nothing is opaque
  PodVector<Leaf> leaves;  // near each other as the tree has them
  PodVector<Kinds> kinds;  // of the leaves

  // Over all opaque triangles, masked ones with them.
  void build(const Geometry& geometry, const Materials& materials, ThreadPool& pool);
  // Boxes and corners anew, after vertices have moved.
  void refit(const Geometry& geometry, ThreadPool& pool);
};

}  // namespace shoal
