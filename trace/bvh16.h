// A bounding volume hierarchy over a scene's triangles, sixteen children wide; trace/traversal.h traverses it.
//
// Nodes have sixteen children, leaves sixteen triangles near each other: all boxes of either are tested at once. The
// boxes decide only which triangles are tested; the hit that is found does not depend on them.
//
// Memory  about 12 bytes a triangle, 67 with corners (tests/trace/test_bvh16.cpp).
// Source  Wald, Benthin and Boulos 2008, "Getting rid of packets": nodes as wide as the registers.
#pragma once

#include <cstdint>

#include "core/pod_vector.h"
#include "core/thread_pool.h"
#include "raster/geometry.h"
#include "shading/material.h"

namespace shoal {

struct Bvh16 {
  static constexpr int kWidth = 16;
  static constexpr std::int32_t kNone = 0x7FFFFFFF;
  // Boxes are grown by these parts of their own size and of their coordinates: by more than the slack of the triangle
  // test (raster/triangle_test.h) and the rounding of the box test.
  static constexpr float kGrowthOfSize = 2e-5f, kGrowthOfCoordinates = 2e-6f;
  static constexpr int kMaxLevels = 68;  // of nodes, for every scene
  // Boxes, world, m, by axis; empty places hold an inverted one.
  struct alignas(64) Boxes {
    float lo[3][kWidth], hi[3][kWidth];
  };
  struct alignas(64) Node {
    Boxes boxes;
    std::int32_t child[kWidth];  // a node, ~ a leaf, or kNone
  };
  struct alignas(64) Leaf {
    std::int32_t id[kWidth];  // of the triangles; kNone: an empty place
  };
  struct alignas(64) Corners {
    float p0[3][kWidth], e1[3][kWidth], e2[3][kWidth];  // first corners, world, and the other two less it
  };
  struct Kinds {
    std::uint16_t present, one_sided, alpha_tested, casts_shadow;  // a bit a triangle
  };
  PodVector<Node> nodes;       // the root last; none: no triangle is of the content
  PodVector<Leaf> leaves;      // in the order of the hierarchy, near ones together
  PodVector<Kinds> kinds;      // of the leaves
  PodVector<Corners> corners;  // the same, for scenes with many queries; else empty, and read from the scene

  // kOpaque: everything drawn that is not blended, alpha-tested triangles included.
  enum class Content : std::uint8_t { kOpaque, kBlended };

  // Builds over all triangles of one content. The result does not depend on the threads.
  //   with_corners  keeps the corners of the triangles: faster queries for more memory
  void build(const Geometry& geometry, const Materials& materials, Content content, bool with_corners,
             ThreadPool& pool);
  // Computes boxes and corners anew after vertices have moved.
  void refit(const Geometry& geometry, ThreadPool& pool);
};

// The corners of a leaf's triangles; empty places hold those of the first.
SHOAL_INLINE void find_corners(const Geometry::TriangleRecord* triangles, const VertexRecord* vertices,
                               const Bvh16::Leaf& leaf, Bvh16::Corners& out) {
  for (int k = 0; k < Bvh16::kWidth; ++k) {
    const std::uint32_t* corner = triangles[leaf.id[k] != Bvh16::kNone ? leaf.id[k] : leaf.id[0]].vertex;
    const Vec3f p0 = vertices[corner[0]].position_world;
    const Vec3f e1 = vertices[corner[1]].position_world - p0, e2 = vertices[corner[2]].position_world - p0;
    out.p0[0][k] = p0.x, out.p0[1][k] = p0.y, out.p0[2][k] = p0.z;
    out.e1[0][k] = e1.x, out.e1[1][k] = e1.y, out.e1[2][k] = e1.z;
    out.e2[0][k] = e2.x, out.e2[1][k] = e2.y, out.e2[2][k] = e2.z;
  }
}

}  // namespace shoal
