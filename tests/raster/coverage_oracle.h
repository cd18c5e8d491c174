// What a rasterizer must cover, from the written rules alone, in integers too wide to overflow.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "raster_driver.h"

namespace shoal_test {

__extension__ typedef __int128 Wide128;

// Corners in 1/256 px, y down.
struct GridTriangle {
  std::int64_t x[3], y[3];
  std::int32_t id;
};

// Twice the signed area of a, b, s.
inline Wide128 side_of(const GridTriangle& t, int a, int b, std::int64_t x, std::int64_t y) {
  return Wide128(t.x[b] - t.x[a]) * Wide128(y - t.y[a]) - Wide128(t.y[b] - t.y[a]) * Wide128(x - t.x[a]);
}
inline int sign_of(Wide128 v) { return v > 0 ? 1 : (v < 0 ? -1 : 0); }

// Direct3D's words: a sample on an edge is in if the edge is a top edge (exactly horizontal, above the others) or a
// left edge (not horizontal, on the left side of the triangle). "Left side" is taken literally: a step to the right
// from the edge goes to where the third corner is.
inline bool edge_owns_its_points(const GridTriangle& t, int a, int b, int c) {
  if (t.y[a] == t.y[b]) return t.y[c] > t.y[a];
  const int third = sign_of(side_of(t, a, b, t.x[c], t.y[c]));
  return sign_of(side_of(t, a, b, t.x[a] + 1, t.y[a])) == third;
}

// Does the triangle, of whichever orientation, cover the centre of a pixel? None for area 0.
inline bool covers(const GridTriangle& t, int x_px, int y_px) {
  const std::int64_t x = std::int64_t(x_px) * 256 + 128, y = std::int64_t(y_px) * 256 + 128;
  for (int k = 0; k < 3; ++k) {
    const int a = k, b = (k + 1) % 3, c = (k + 2) % 3;
    const int third = sign_of(side_of(t, a, b, t.x[c], t.y[c])), here = sign_of(side_of(t, a, b, x, y));
    if (third == 0 || here == -third) return false;
    if (here == 0 && !edge_owns_its_points(t, a, b, c)) return false;
  }
  return true;
}

// Counter-clockwise on the screen as a viewer sees it (y down).
inline bool faces_viewer(const GridTriangle& t) { return side_of(t, 0, 1, t.x[2], t.y[2]) < 0; }

// A number that tells triangles apart, so that a sum of them tells sets of triangles apart.
inline std::uint64_t mark_of(std::int32_t id) {
  std::uint64_t h = (static_cast<std::uint64_t>(id) + 1) * 0x9E3779B97F4A7C15ull;
  h ^= h >> 29;
  return h * 0xBF58476D1CE4E5B9ull;
}

// Who covers each pixel of a frame: how many triangles, and the sum of their marks.
struct Coverage {
  int width_px, height_px;
  std::vector<std::uint32_t> count;
  std::vector<std::uint64_t> marks;
  Coverage(int width, int height)
      : width_px(width),
        height_px(height),
        count(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)),
        marks(count.size()) {}
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) + static_cast<std::size_t>(x);
  }
  void add(int x, int y, std::int32_t id) {
    ++count[at(x, y)];
    marks[at(x, y)] += mark_of(id);
  }
  bool operator==(const Coverage& o) const { return count == o.count && marks == o.marks; }
};

// Pixel by pixel within each triangle's box.
inline Coverage oracle_coverage(const std::vector<GridTriangle>& triangles, int width_px, int height_px,
                                bool two_sided) {
  Coverage out(width_px, height_px);
  for (const GridTriangle& t : triangles) {
    if (!two_sided && !faces_viewer(t)) continue;
    const auto px = [](std::int64_t v, int size) {
      return static_cast<int>(std::max<std::int64_t>(-1, std::min<std::int64_t>(v / 256, size)));
    };
    const int x0 = std::max(px(std::min({t.x[0], t.x[1], t.x[2]}), width_px) - 1, 0);
    const int x1 = std::min(px(std::max({t.x[0], t.x[1], t.x[2]}), width_px) + 1, width_px - 1);
    const int y0 = std::max(px(std::min({t.y[0], t.y[1], t.y[2]}), height_px) - 1, 0);
    const int y1 = std::min(px(std::max({t.y[0], t.y[1], t.y[2]}), height_px) + 1, height_px - 1);
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x)
        if (covers(t, x, y)) out.add(x, y, t.id);
  }
  return out;
}

// An alpha test that notes who covers what and then cuts all of it, so that nothing hides anything.
struct CountingCut {
  static constexpr bool kTests = true;
  Coverage* seen;
  WideM operator()(std::int32_t id, int x_px, int y_px, WideM cover) const {
    const std::uint32_t bits = to_bits(cover);
    for (int i = 0; i < 16; ++i) {
      const int x = x_px + (i & 3), y = y_px + (i >> 2);
      if (((bits >> i) & 1u) != 0 && x < seen->width_px && y < seen->height_px) seen->add(x, y, id);
    }
    return mask_from_bits(0);
  }
};

// What the front end and the tiles cover.
template <class Program>
Coverage raster_coverage(const Geometry& g, const Program& program, const PassSettings& pass, bool two_sided,
                         std::uint32_t per_work_item) {
  const std::vector<DrawState> draw_states = {{.double_sided = two_sided, .alpha_tested = true}};
  const std::vector<WorkItemBins> work_items = bin_geometry(g, draw_states, program, pass, per_work_item);
  Coverage seen(pass.width_px, pass.height_px);
  VisibilityBuffer buffer;
  draw_tiles(work_items, pass, CountingCut{&seen}, buffer);
  return seen;
}

// World x and y are pixels, z the depth, so that a test knows the grid position of every vertex: exact up to 2^15 px.
struct PixelProgram {
  static constexpr bool kWarped = false;
  Vec2f centre_px{0, 0};
  float w = 1;  // a power of two: dividing by it is exact
  template <class F>
  ClipVertex<F> vertex(Vec3<F> p) const {
    return {(p.x - F(centre_px.x)) * F(w), (p.y - F(centre_px.y)) * F(w), p.z * F(w), F(w)};
  }
  bool meshlet_outside(const Meshlet&) const { return false; }
};

// Triangles on the pixel grid, as a mesh and as the oracle takes them.
struct GridMesh {
  std::vector<Vec3f> positions;
  std::vector<std::uint32_t> indices;

  // x, y in 1/256 px
  std::uint32_t vertex(std::int64_t x, std::int64_t y, float depth) {
    positions.push_back({static_cast<float>(x) / 256.0f, static_cast<float>(y) / 256.0f, depth});
    return static_cast<std::uint32_t>(positions.size() - 1);
  }
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) { indices.insert(indices.end(), {a, b, c}); }
  std::vector<GridTriangle> triangles() const {
    std::vector<GridTriangle> out;
    for (std::size_t t = 0; t + 2 < indices.size(); t += 3) {
      GridTriangle g{};
      g.id = static_cast<std::int32_t>(t / 3);
      for (std::size_t k = 0; k < 3; ++k) {
        g.x[k] = std::llround(static_cast<double>(positions[indices[t + k]].x) * 256.0);
        g.y[k] = std::llround(static_cast<double>(positions[indices[t + k]].y) * 256.0);
      }
      out.push_back(g);
    }
    return out;
  }
};

inline Geometry geometry_of(const std::vector<Vec3f>& positions, const std::vector<std::uint32_t>& indices) {
  const std::vector<Vec3f> normals(positions.size(), Vec3f{0, 0, 1});
  MeshView mesh;
  mesh.positions_world = positions.data();
  mesh.normals_world = normals.data();
  mesh.indices = indices.data();
  mesh.vertex_count = static_cast<std::uint32_t>(positions.size());
  mesh.index_count = static_cast<std::uint32_t>(indices.size());
  Geometry g;
  append_mesh(g, mesh);
  return g;
}

class TestRandom {
 public:
  explicit TestRandom(std::uint32_t seed) : engine_(seed) {}
  // lo to hi, both included
  std::int64_t integer(std::int64_t lo, std::int64_t hi) {
    const std::uint64_t bits = (static_cast<std::uint64_t>(engine_()) << 32) | engine_();
    return lo + static_cast<std::int64_t>(bits % static_cast<std::uint64_t>(hi - lo + 1));
  }
  double real(double lo, double hi) { return lo + (hi - lo) * (static_cast<double>(engine_()) / 4294967296.0); }
  float in(double lo, double hi) { return static_cast<float>(real(lo, hi)); }

 private:
  std::mt19937 engine_;
};

}  // namespace shoal_test
