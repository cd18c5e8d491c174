// Geometry: world-space triangles in submission order, cut into meshlets.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace shoal {

inline constexpr int kMeshletVertices = 64;
inline constexpr int kMeshletTriangles = 128;
inline constexpr std::uint32_t kNoTriangle = 0xFFFFFFFFu;

// A vertex for the pixel stages: half a cache line.
struct VertexRecord {
  Vec3f position_world;
  Vec3f normal_world;  // unit
  Vec2f uv;
};

// Consecutive triangles of one drawable, at most kMeshletTriangles over at most kMeshletVertices vertices.
struct Meshlet {
  std::uint32_t first_triangle = 0;  // global id; the k-th triangle of the meshlet is first_triangle + k
  std::uint32_t first_vertex = 0;    // a multiple of 16
  std::uint32_t first_index = 0;     // into Geometry::corner0/1/2, a multiple of 16
  std::uint16_t triangle_count = 0, vertex_count = 0;
  std::uint32_t material = 0;
  Vec3f bounds_min_world, bounds_max_world;
  float longest_edge_m = 0;
};

// One glTF primitive of one node: the unit of "object" in the metrics.
struct Drawable {
  std::uint32_t node = 0;
  std::uint32_t primitive = 0;
  std::uint32_t material = 0;
  std::uint32_t first_triangle = 0, triangle_count = 0;
  bool drawn = true;  // false for a water outline's own mesh
};

struct Geometry {
  // Vertices, sixteen-padded a meshlet (a meshlet's padding repeats its last vertex). Positions twice: planar for the
  // front end, in records for the pixel stages.
  std::vector<float> x_world, y_world, z_world;
  std::vector<VertexRecord> vertices;
  std::vector<Vec4f> colors;    // a vertex's COLOR_0 (linear RGBA); empty when nothing has any
  std::vector<Vec2f> uvs1;      // the second set of texture coordinates; empty when nothing has any
  std::vector<Vec4f> tangents;  // world, unit along +u, w the bitangent's sign; empty when nothing has any

  // A meshlet's triangles by meshlet-local vertex number, one array a corner, sixteen-padded a meshlet (padding is
  // degenerate).
  std::vector<std::uint8_t> corner0, corner1, corner2;

  // By global triangle id, for the pixel stages.
  struct TriangleRecord {
    std::uint32_t vertex[3];  // into vertices
    std::uint32_t material;
  };
  std::vector<TriangleRecord> triangles;

  std::vector<Meshlet> meshlets;    // in submission order, drawn drawables only
  std::vector<Drawable> drawables;  // in submission order
};

// An indexed mesh part to append, already in world space.
struct MeshView {
  const Vec3f* positions_world = nullptr;
  const Vec3f* normals_world = nullptr;   // unit
  const Vec2f* uvs = nullptr;             // may be null
  const Vec4f* colors = nullptr;          // may be null
  const Vec2f* uvs1 = nullptr;            // may be null
  const Vec4f* tangents_world = nullptr;  // may be null; xyz unit along +u, w 1 or -1: b = cross(n, t) w
  const std::uint32_t* indices = nullptr;
  std::uint32_t vertex_count = 0, index_count = 0;
  std::uint32_t node = 0, primitive = 0, material = 0;
  bool drawn = true;
};

// Appends a drawable and its meshlets. Triangles keep their order; ids go on from those already there.
void append_mesh(Geometry& geometry, const MeshView& mesh);

}  // namespace shoal
