// Meshlets: every triangle once, in order, where it was, within the limits.
#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

#include "raster/geometry.h"
#include "raster/geometry_lookup.h"
#include "raster/geometry_measure.h"

using namespace shoal;

namespace {

struct TestMesh {
  std::vector<Vec3f> positions, normals;
  std::vector<Vec2f> uvs;
  std::vector<Vec4f> colors;
  std::vector<std::uint32_t> indices;

  MeshView view() const {
    MeshView v;
    v.positions_world = positions.data();
    v.normals_world = normals.data();
    v.uvs = uvs.empty() ? nullptr : uvs.data();
    v.colors = colors.empty() ? nullptr : colors.data();
    v.indices = indices.data();
    v.vertex_count = static_cast<std::uint32_t>(positions.size());
    v.index_count = static_cast<std::uint32_t>(indices.size());
    return v;
  }
};

std::uint32_t next_random(std::uint32_t& state) {
  state ^= state << 13;
  state ^= state >> 17;
  state ^= state << 5;
  return state;
}

// Vertices carry their own number in x, so that a mix-up shows.
TestMesh random_mesh(std::uint32_t vertices, std::uint32_t triangles, std::uint32_t spread, std::uint32_t seed) {
  TestMesh m;
  for (std::uint32_t i = 0; i < vertices; ++i) {
    const float f = static_cast<float>(i);
    m.positions.push_back(
        {f, static_cast<float>(next_random(seed) % 1000), static_cast<float>(next_random(seed) % 1000)});
    m.normals.push_back({0, 0, 1});
    m.uvs.push_back({f, -f});
  }
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const std::uint32_t base = next_random(seed) % vertices;
    for (int k = 0; k < 3; ++k) m.indices.push_back((base + next_random(seed) % spread) % vertices);
  }
  return m;
}

bool equal(Vec3f a, Vec3f b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

// Checks one drawable's meshlets against its mesh; `first` is the id of its first triangle.
void check_mesh(const Geometry& g, const TestMesh& mesh, std::uint32_t first) {
  const std::size_t count = mesh.indices.size() / 3;
  std::uint32_t next = first;
  for (const Meshlet& c : g.meshlets) {
    if (c.first_triangle < first || c.first_triangle >= first + count) continue;
    REQUIRE(c.first_triangle == next);
    REQUIRE(c.triangle_count >= 1);
    REQUIRE(c.triangle_count <= 128);
    REQUIRE(c.vertex_count <= 64);
    REQUIRE(c.first_vertex % 16 == 0);
    REQUIRE(c.first_index % 16 == 0);
    Vec3f lo{1e30f, 1e30f, 1e30f}, hi{-1e30f, -1e30f, -1e30f};
    double longest = 0;
    int next_local = 0;
    for (std::uint32_t t = 0; t < c.triangle_count; ++t) {
      const std::uint8_t local[3] = {g.corner0[c.first_index + t], g.corner1[c.first_index + t],
                                     g.corner2[c.first_index + t]};
      Vec3f p[3];
      for (std::size_t k = 0; k < 3; ++k) {
        REQUIRE(local[k] < c.vertex_count);
        REQUIRE(local[k] <= next_local);  // numbered in order of first use
        if (local[k] == next_local) ++next_local;
        const std::uint32_t v = c.first_vertex + local[k], source = mesh.indices[3 * (next - first + t) + k];
        REQUIRE(g.triangles[next + t].vertex[k] == v);
        p[k] = mesh.positions[source];
        REQUIRE(equal(g.vertices[v].position_world, p[k]));
        REQUIRE(equal({g.x_world[v], g.y_world[v], g.z_world[v]}, p[k]));
        REQUIRE(g.vertices[v].uv.y == -p[k].x);
        lo = {std::fmin(lo.x, p[k].x), std::fmin(lo.y, p[k].y), std::fmin(lo.z, p[k].z)};
        hi = {std::fmax(hi.x, p[k].x), std::fmax(hi.y, p[k].y), std::fmax(hi.z, p[k].z)};
      }
      for (int k = 0; k < 3; ++k) {
        const Vec3f a = p[k], b = p[(k + 1) % 3];
        longest = std::fmax(longest, std::hypot(double(a.x) - b.x, double(a.y) - b.y, double(a.z) - b.z));
      }
    }
    REQUIRE(next_local == c.vertex_count);
    REQUIRE(equal(c.bounds_min_world, lo));
    REQUIRE(equal(c.bounds_max_world, hi));
    REQUIRE(c.longest_edge_m == Approx(longest).epsilon(1e-6));
    // Padding: degenerate triangles, and the last vertex over again.
    for (std::uint32_t t = c.triangle_count; t % 16 != 0; ++t) {
      REQUIRE(int(g.corner0[c.first_index + t] | g.corner1[c.first_index + t] | g.corner2[c.first_index + t]) == 0);
    }
    for (std::uint32_t v = c.vertex_count; v % 16 != 0; ++v) {
      REQUIRE(equal(g.vertices[c.first_vertex + v].position_world,
                    g.vertices[c.first_vertex + c.vertex_count - 1u].position_world));
    }
    next += c.triangle_count;
  }
  REQUIRE(next == first + count);
}

}  // namespace

TEST_CASE("every triangle is in one meshlet, in order, with its vertices", "[geometry]") {
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    const TestMesh mesh = random_mesh(40 + 97 * seed, 50 * seed * seed, 2 + 11 * seed, seed);
    Geometry g;
    append_mesh(g, mesh.view());
    check_mesh(g, mesh, 0);
    CHECK(g.colors.empty());
    CHECK(g.vertices.size() % 16 == 0);
    CHECK(g.corner0.size() % 16 == 0);
  }
}

TEST_CASE("the cut is greedy: a meshlet ends only where the next triangle does not fit", "[geometry]") {
  const TestMesh mesh = random_mesh(3000, 4000, 9, 5);
  Geometry g;
  append_mesh(g, mesh.view());
  for (std::size_t c = 0; c + 1 < g.meshlets.size(); ++c) {
    const Meshlet& meshlet = g.meshlets[c];
    std::set<std::uint32_t> used;
    for (std::size_t t = meshlet.first_triangle; t <= meshlet.first_triangle + meshlet.triangle_count; ++t) {
      used.insert({mesh.indices[3 * t], mesh.indices[3 * t + 1], mesh.indices[3 * t + 2]});
    }
    CHECK((meshlet.triangle_count == 128 || used.size() > 64));
  }
}

TEST_CASE("a triangle may use a vertex twice, and a meshlet may be full to the last vertex", "[geometry]") {
  TestMesh mesh = random_mesh(66, 0, 1, 3);
  for (std::uint32_t v = 0; v < 66; v += 2) mesh.indices.insert(mesh.indices.end(), {v, v + 1, v});
  Geometry g;
  append_mesh(g, mesh.view());
  check_mesh(g, mesh, 0);
  REQUIRE(g.meshlets.size() == 2);
  CHECK(g.meshlets[0].triangle_count == 32);
  CHECK(g.meshlets[0].vertex_count == 64);
}

TEST_CASE("drawables go on with ids; what is not drawn has ids but no meshlets", "[geometry]") {
  const TestMesh a = random_mesh(100, 300, 20, 7), b = random_mesh(80, 200, 20, 8), c = random_mesh(60, 100, 20, 9);
  Geometry g;
  MeshView hidden = b.view();
  hidden.drawn = false;
  hidden.node = 4;
  hidden.material = 3;
  append_mesh(g, a.view());
  append_mesh(g, hidden);
  append_mesh(g, c.view());
  REQUIRE(g.drawables.size() == 3);
  CHECK(g.drawables[1].first_triangle == 300);
  CHECK(g.drawables[1].triangle_count == 200);
  CHECK(g.drawables[1].node == 4);
  CHECK_FALSE(g.drawables[1].drawn);
  CHECK(g.drawables[2].first_triangle == 500);
  CHECK(g.triangles.size() == 600);
  CHECK(g.triangles[400].material == 3);
  check_mesh(g, a, 0);
  check_mesh(g, c, 500);
  for (const Meshlet& meshlet : g.meshlets) CHECK((meshlet.first_triangle < 300 || meshlet.first_triangle >= 500));
  for (std::size_t t = 300; t < 500; ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(equal(g.vertices[g.triangles[t].vertex[k]].position_world, b.positions[b.indices[3 * (t - 300) + k]]));
    }
  }
}

TEST_CASE("a triangle's drawable is the last that starts at or before it, empty drawables or not", "[geometry]") {
  Geometry g;
  CHECK(drawable_of(g, 0) == 0);
  std::uint32_t first = 0;
  for (const std::uint32_t count : {3u, 1u, 0u, 0u, 7u, 2u, 0u, 5u}) {
    Drawable d;
    d.first_triangle = first, d.triangle_count = count;
    g.drawables.push_back(d);
    first += count;
  }
  for (std::uint32_t id = 0; id < first; ++id) {
    const Drawable& d = g.drawables[drawable_of(g, static_cast<std::int32_t>(id))];
    CAPTURE(id);
    CHECK((id >= d.first_triangle && id < d.first_triangle + d.triangle_count));
  }
}

TEST_CASE("colours are white where a mesh has none, whichever comes first", "[geometry]") {
  TestMesh plain = random_mesh(50, 70, 9, 1), tinted = random_mesh(50, 70, 9, 2);
  tinted.colors.assign(50, Vec4f{0.25f, 0.5f, 0.75f, 1});
  Geometry g;
  append_mesh(g, plain.view());
  append_mesh(g, tinted.view());
  append_mesh(g, plain.view());
  REQUIRE(g.colors.size() == g.vertices.size());
  for (std::size_t t = 0; t < 210; ++t) {
    for (const std::uint32_t v : g.triangles[t].vertex) CHECK(g.colors[v].x == (t >= 70 && t < 140 ? 0.25f : 1.0f));
  }
}

TEST_CASE("what is measured is what is appended, to the last element", "[geometry]") {
  const TestMesh a = random_mesh(700, 2000, 15, 21), b = random_mesh(90, 333, 40, 22);
  MeshView hidden = b.view();
  hidden.drawn = false;
  GeometrySize size;
  measure_mesh(a.view(), size);
  measure_mesh(hidden, size);
  Geometry g;
  append_mesh(g, a.view());
  append_mesh(g, hidden);
  CHECK(size.vertices == g.vertices.size());
  CHECK(size.vertices == g.x_world.size());
  CHECK(size.corners == g.corner0.size());
  CHECK(size.triangles == g.triangles.size());
  CHECK(size.meshlets == g.meshlets.size());
  CHECK(size.drawables == g.drawables.size());
}
