#include "raster/geometry.h"

#include <algorithm>
#include <cmath>

#include "raster/geometry_measure.h"

namespace shoal {
namespace {

std::size_t round_up_16(std::size_t n) { return (n + 15) & ~std::size_t{15}; }

// Greedy cut of a triangle list into meshlets, in file order. A vertex's slot holds the number of the meshlet that used
// it last and its place there, so that no slot is cleared when a meshlet begins.
class MeshletCutter {
 public:
  explicit MeshletCutter(std::uint32_t vertex_count) : slots_(vertex_count, 0) {}

  // Starts a meshlet at triangle `first`; returns its triangle count.
  //   local    receives meshlet-local vertex numbers, three a triangle (kMeshletTriangles * 3)
  //   globals  receives the meshlet's vertices in order of first use (kMeshletVertices)
  int cut(const std::uint32_t* indices, std::size_t first, std::size_t triangle_count, std::uint8_t* local,
          std::uint32_t* globals, int& vertex_count) {
    ++epoch_;
    const std::size_t end = std::min(triangle_count, first + std::size_t{kMeshletTriangles});
    int vertices = 0;
    std::size_t t = first;
    for (; t < end; ++t) {
      const std::uint32_t* corner = indices + 3 * t;
      if (vertices > kMeshletVertices - 3 && vertices + count_new(corner) > kMeshletVertices) break;
      for (int k = 0; k < 3; ++k) {
        std::uint32_t& slot = slots_[corner[k]];
        if (slot >> kLocalBits != epoch_) {
          slot = epoch_ << kLocalBits | static_cast<std::uint32_t>(vertices);
          globals[vertices++] = corner[k];
        }
        *local++ = static_cast<std::uint8_t>(slot & (kMeshletVertices - 1));
      }
    }
    vertex_count = vertices;
    if (epoch_ == kLastEpoch) {
      std::fill(slots_.begin(), slots_.end(), 0u);
      epoch_ = 0;
    }
    return static_cast<int>(t - first);
  }

 private:
  static constexpr int kLocalBits = 6;
  static constexpr std::uint32_t kLastEpoch = 0xFFFFFFFFu >> kLocalBits;
  static_assert(1 << kLocalBits == kMeshletVertices);

  int count_new(const std::uint32_t* corner) const {
    const auto is_new = [&](int k) { return slots_[corner[k]] >> kLocalBits != epoch_; };
    int n = is_new(0) ? 1 : 0;
    if (corner[1] != corner[0] && is_new(1)) ++n;
    if (corner[2] != corner[0] && corner[2] != corner[1] && is_new(2)) ++n;
    return n;
  }

  std::vector<std::uint32_t> slots_;
  std::uint32_t epoch_ = 0;
};

constexpr Vec4f kNoTangent{1, 0, 0, 1};  // of vertices without a normal map

void append_vertex(Geometry& g, const MeshView& mesh, std::uint32_t v, bool with_colors) {
  const Vec3f p = mesh.positions_world[v];
  g.x_world.push_back(p.x);
  g.y_world.push_back(p.y);
  g.z_world.push_back(p.z);
  g.vertices.push_back({p, mesh.normals_world[v], mesh.uvs ? mesh.uvs[v] : Vec2f{0, 0}});
  if (with_colors) g.colors.push_back(mesh.colors ? mesh.colors[v] : Vec4f{1, 1, 1, 1});
  if (!g.uvs1.empty() || mesh.uvs1) g.uvs1.push_back(mesh.uvs1 ? mesh.uvs1[v] : Vec2f{0, 0});
  if (!g.tangents.empty() || mesh.tangents_world)
    g.tangents.push_back(mesh.tangents_world ? mesh.tangents_world[v] : kNoTangent);
}

// The meshlet's vertices, padded to sixteen with the last.
void append_vertices(Geometry& g, const MeshView& mesh, const std::uint32_t* globals, int count, bool with_colors) {
  const int padded = static_cast<int>(round_up_16(static_cast<std::size_t>(count)));
  for (int i = 0; i < padded; ++i) append_vertex(g, mesh, globals[std::min(i, count - 1)], with_colors);
}

// Corner arrays (padded with the degenerate 0, 0, 0), bounds and longest edge of a drawn meshlet.
void append_meshlet(Geometry& g, const MeshView& mesh, const std::uint8_t* local, Meshlet meshlet) {
  const std::size_t count = meshlet.triangle_count, padded = round_up_16(count);
  for (std::size_t t = 0; t < padded; ++t) {
    const bool real = t < count;
    g.corner0.push_back(real ? local[3 * t] : std::uint8_t{0});
    g.corner1.push_back(real ? local[3 * t + 1] : std::uint8_t{0});
    g.corner2.push_back(real ? local[3 * t + 2] : std::uint8_t{0});
  }
  meshlet.material = mesh.material;
  measure_meshlet(g, meshlet);
  g.meshlets.push_back(meshlet);
}

}  // namespace

void measure_meshlet(const Geometry& g, Meshlet& meshlet) {
  const VertexRecord* v = g.vertices.data() + meshlet.first_vertex;
  Vec3f lo = v[0].position_world, hi = lo;
  for (int i = 1; i < meshlet.vertex_count; ++i) {
    const Vec3f p = v[i].position_world;
    lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
    hi = {std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z)};
  }
  float longest2 = 0;
  for (std::size_t i = meshlet.first_index; i < meshlet.first_index + std::size_t{meshlet.triangle_count}; ++i) {
    const Vec3f a = v[g.corner0[i]].position_world, b = v[g.corner1[i]].position_world;
    const Vec3f c = v[g.corner2[i]].position_world;
    const Vec3f ab = b - a, bc = c - b, ca = a - c;
    longest2 = std::max({longest2, dot(ab, ab), dot(bc, bc), dot(ca, ca)});
  }
  meshlet.bounds_min_world = lo;
  meshlet.bounds_max_world = hi;
  meshlet.longest_edge_m = std::sqrt(longest2);
}

void measure_mesh(const MeshView& mesh, GeometrySize& size) {
  MeshletCutter cutter(mesh.vertex_count);
  std::uint8_t local[kMeshletTriangles * 3];
  std::uint32_t globals[kMeshletVertices];
  const std::size_t count = mesh.index_count / 3;
  for (std::size_t first = 0; first < count;) {
    int vertices = 0;
    const int triangles = cutter.cut(mesh.indices, first, count, local, globals, vertices);
    size.vertices += round_up_16(static_cast<std::size_t>(vertices));
    if (mesh.drawn) {
      size.corners += round_up_16(static_cast<std::size_t>(triangles));
      ++size.meshlets;
    }
    first += static_cast<std::size_t>(triangles);
  }
  size.triangles += count;
  ++size.drawables;
}

void reserve_geometry(Geometry& g, const GeometrySize& size, bool with_colors) {
  const std::size_t vertices = g.vertices.size() + size.vertices, corners = g.corner0.size() + size.corners;
  g.x_world.reserve(vertices);
  g.y_world.reserve(vertices);
  g.z_world.reserve(vertices);
  g.vertices.reserve(vertices);
  if (with_colors) g.colors.reserve(vertices);
  g.corner0.reserve(corners);
  g.corner1.reserve(corners);
  g.corner2.reserve(corners);
  g.triangles.reserve(g.triangles.size() + size.triangles);
  g.meshlets.reserve(g.meshlets.size() + size.meshlets);
  g.drawables.reserve(g.drawables.size() + size.drawables);
}

void append_mesh(Geometry& g, const MeshView& mesh) {
  const std::size_t count = mesh.index_count / 3;
  const auto first_id = static_cast<std::uint32_t>(g.triangles.size());
  g.drawables.push_back(
      {mesh.node, mesh.primitive, mesh.material, first_id, static_cast<std::uint32_t>(count), mesh.drawn});
  // The first mesh with colours whitens the vertices before it.
  if (mesh.colors && g.colors.empty()) g.colors.resize(g.vertices.size(), Vec4f{1, 1, 1, 1});
  const bool with_colors = mesh.colors || !g.colors.empty();
  if (mesh.uvs1 && g.uvs1.empty()) g.uvs1.resize(g.vertices.size(), Vec2f{0, 0});
  if (mesh.tangents_world && g.tangents.empty()) g.tangents.resize(g.vertices.size(), kNoTangent);

  MeshletCutter cutter(mesh.vertex_count);
  std::uint8_t local[kMeshletTriangles * 3];
  std::uint32_t globals[kMeshletVertices];
  for (std::size_t first = 0; first < count;) {
    int vertices = 0;
    const int triangles = cutter.cut(mesh.indices, first, count, local, globals, vertices);
    Meshlet meshlet;
    meshlet.first_triangle = first_id + static_cast<std::uint32_t>(first);
    meshlet.first_vertex = static_cast<std::uint32_t>(g.vertices.size());
    meshlet.first_index = static_cast<std::uint32_t>(g.corner0.size());
    meshlet.triangle_count = static_cast<std::uint16_t>(triangles);
    meshlet.vertex_count = static_cast<std::uint16_t>(vertices);
    append_vertices(g, mesh, globals, vertices, with_colors);
    for (int t = 0; t < triangles; ++t) {
      const std::uint8_t* l = local + 3 * t;
      g.triangles.push_back(
          {{meshlet.first_vertex + l[0], meshlet.first_vertex + l[1], meshlet.first_vertex + l[2]}, mesh.material});
    }
    // A drawable that is not drawn has ids and vertices, but no meshlet, so no stage draws it.
    if (mesh.drawn) append_meshlet(g, mesh, local, meshlet);
    first += static_cast<std::size_t>(triangles);
  }
}

}  // namespace shoal
