// Generated tangents against analytic surfaces, at mirrored texture seams and degenerate coordinates, and under
// transforms.
#include "scene/build/tangents.h"

#include <catch2/catch.hpp>
#include <cmath>

namespace shoal::test {
namespace {

// A sphere's patch away from the poles: u along the longitude, v down; du/dlongitude may be negative (mirrored).
MeshPrimitive sphere_patch(int columns, int rows, double u_per_radian) {
  MeshPrimitive mesh;
  for (int r = 0; r <= rows; ++r) {
    for (int c = 0; c <= columns; ++c) {
      const double lon = 2.0 * c / columns, lat = 1.0 - 2.0 * r / rows;
      const double x = std::cos(lat) * std::sin(lon), y = std::sin(lat), z = std::cos(lat) * std::cos(lon);
      const Vec3f p{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
      mesh.positions.push_back(p);
      mesh.normals.push_back(p);
      mesh.uvs.push_back({static_cast<float>(lon * u_per_radian), static_cast<float>(r) / static_cast<float>(rows)});
    }
  }
  const auto at = [&](int c, int r) { return static_cast<std::uint32_t>(r * (columns + 1) + c); };
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      mesh.indices.insert(mesh.indices.end(), {at(c, r), at(c, r + 1), at(c + 1, r)});
      mesh.indices.insert(mesh.indices.end(), {at(c + 1, r), at(c, r + 1), at(c + 1, r + 1)});
    }
  }
  return mesh;
}

double dot3(Vec3f n, Vec4f t) { return double{n.x} * t.x + double{n.y} * t.y + double{n.z} * t.z; }

}  // namespace

TEST_CASE("tangents: along growing u on a sphere, unit, across the normal, the bitangent up the picture") {
  for (const double u : {0.3, -0.3}) {
    MeshPrimitive mesh = sphere_patch(40, 40, u);
    const std::size_t vertices = mesh.positions.size();
    generate_tangents(mesh, mesh.uvs);
    CHECK(mesh.positions.size() == vertices);
    REQUIRE(mesh.tangents.size() == vertices);
    double worst = 0, off = 0, length = 0;
    for (std::size_t v = 0; v < vertices; ++v) {
      const Vec4f t = mesh.tangents[v];
      const Vec3f n = mesh.normals[v];
      const double lon = std::atan2(double{n.x}, double{n.z});
      // East, or west where u grows westwards.
      const double east = (t.x * std::cos(lon) - t.z * std::sin(lon)) * (u > 0 ? 1 : -1);
      worst = std::max(worst, 1 - east);
      off = std::max(off, std::fabs(dot3(n, t)));
      length = std::max(length, std::fabs(double{t.x} * t.x + double{t.y} * t.y + double{t.z} * t.z - 1));
      // cross(n, t) w is north: against v.
      const double up = (double{n.z} * t.x - double{n.x} * t.z) * t.w;
      CHECK(up > 0);
    }
    CHECK(worst < 2e-3);
    CHECK(off < 2e-6);
    CHECK(length < 1e-6);
  }
}

TEST_CASE("tangents: weighted by the angle at the vertex for all sizes, against double") {
  // Two triangles share the edge from the origin; their u axes differ. All normals +z.
  MeshPrimitive mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-3, 4, 0}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {-0.5f, -1}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  generate_tangents(mesh, mesh.uvs);
  // First: u = x, angle 45 degrees. Second: u = a x + b y with a + b = 1, -3a + 4b = -0.5: v' likewise; the direction
  // along which v stays: d with v(d) = 0. v = 1 - (c x + d y), c + d = 1, -3c + 4d = 2.
  const double c = 2.0 / 7.0, d = 5.0 / 7.0;
  const double lx = d / std::sqrt(c * c + d * d), ly = -c / std::sqrt(c * c + d * d);
  const double first = std::atan2(1.0, 1.0), second = std::atan2(4.0, -3.0) - std::atan2(1.0, 1.0);
  const double x = first + second * lx, y = second * ly, length = std::sqrt(x * x + y * y);
  CHECK(std::fabs(mesh.tangents[0].x - x / length) < 2e-6);
  CHECK(std::fabs(mesh.tangents[0].y - y / length) < 2e-6);
  CHECK(mesh.tangents[0].w == 1);
  CHECK(std::fabs(mesh.tangents[1].x - 1) < 2e-6);
  CHECK(std::fabs(mesh.tangents[3].x - lx) < 2e-6);
}

TEST_CASE("tangents: a mirrored seam doubles its vertices and every array with them") {
  // Texture mirrored at x = 0: u = |x|.
  MeshPrimitive mesh;
  mesh.positions = {{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.uvs = {{1, 1}, {0, 1}, {1, 1}, {0, 0}};
  mesh.colors = {{0, 0, 0, 1}, {0.1f, 0, 0, 1}, {0.2f, 0, 0, 1}, {0.3f, 0, 0, 1}};
  mesh.influences = 4;
  mesh.joints = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  mesh.weights.assign(16, 0.25f);
  mesh.targets.resize(1);
  mesh.targets[0].positions = {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}};
  mesh.indices = {0, 1, 3, 1, 2, 3};
  generate_tangents(mesh, mesh.uvs);
  REQUIRE(mesh.positions.size() == 6);
  CHECK(mesh.indices == std::vector<std::uint32_t>{0, 1, 3, 4, 2, 5});
  CHECK(mesh.colors[4].x == 0.1f);
  CHECK(mesh.joints[4 * 5 + 1] == 13);
  CHECK(mesh.targets[0].positions[5].x == 4);
  for (const std::uint32_t v : {0u, 1u, 3u}) CHECK((mesh.tangents[v].x == -1 && mesh.tangents[v].w == -1));
  for (const std::uint32_t v : {4u, 2u, 5u}) CHECK((mesh.tangents[v].x == 1 && mesh.tangents[v].w == 1));
}

TEST_CASE("tangents: without area in the texture any direction across the normal; equal vertices share theirs") {
  MeshPrimitive mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.normals = {{0, 0, 1}, {1, 0, 0}, {0.6f, 0.8f, 0}};
  mesh.indices = {0, 1, 2};
  generate_tangents(mesh, std::vector<Vec2f>(3, Vec2f{0.5f, 0.5f}));
  for (std::size_t v = 0; v < 3; ++v) {
    CHECK(std::fabs(dot3(mesh.normals[v], mesh.tangents[v])) < 1e-6);
    CHECK(std::fabs(std::hypot(mesh.tangents[v].x, mesh.tangents[v].y, mesh.tangents[v].z) - 1) < 1e-6f);
  }
  // The sphere with a vertex a corner has the tangents of the shared one, bit for bit.
  MeshPrimitive shared = sphere_patch(5, 4, 0.3), apart;
  for (const std::uint32_t i : shared.indices) {
    apart.indices.push_back(static_cast<std::uint32_t>(apart.positions.size()));
    apart.positions.push_back(shared.positions[i]);
    apart.normals.push_back(shared.normals[i]);
    apart.uvs.push_back(shared.uvs[i]);
  }
  generate_tangents(shared, shared.uvs);
  generate_tangents(apart, apart.uvs);
  int different = 0;
  for (std::size_t i = 0; i < apart.indices.size(); ++i) {
    const Vec4f a = apart.tangents[i], b = shared.tangents[shared.indices[i]];
    different += !(a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w);
  }
  CHECK(different == 0);
}

TEST_CASE("tangents: transformed along the surface; a mirroring transform reverses the sign of the bitangent") {
  const Mat4 stretched = from_rows({2, 0, 0, 5}, {0, 1, 0, 6}, {0, 0, -3, 7});
  const Vec4f t = place_tangent(stretched, {0.6f, 0, 0.8f, 1});
  const double length = std::hypot(1.2, 2.4);
  CHECK(t.x == Approx(1.2 / length));
  CHECK(t.y == 0);
  CHECK(t.z == Approx(-2.4 / length));
  CHECK(t.w == -1);
  CHECK(place_tangent(kIdentity4, {0, 1, 0, -1}).w == -1);
}

}  // namespace shoal::test
