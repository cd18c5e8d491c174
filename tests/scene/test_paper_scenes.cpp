// The scenes ball, knot, furnace, tank and pond: properties that the papers and docs/scenes.md state, valid meshes,
// closed solids, and the same bytes on every machine.
#include <catch2/catch.hpp>

#include <cmath>
#include <string>
#include <vector>

#include "tests/scene/procedural_checks.h"

using namespace shoal;
using namespace shoal::test;

namespace {

std::uint64_t mesh_triangles(const Scene& scene, const std::string& name) {
  const Mesh* mesh = find_mesh(scene, name);
  std::uint64_t count = 0;
  if (mesh != nullptr)
    for (const MeshPrimitive& p : mesh->primitives) count += p.indices.size() / 3;
  return count;
}

// Heights of a sheet over a place: one for each triangle that covers it, seen from above.
std::vector<double> heights_at(const Mesh& mesh, double x, double z) {
  std::vector<double> heights;
  for (const MeshPrimitive& p : mesh.primitives) {
    for (std::size_t i = 0; i < p.indices.size(); i += 3) {
      const Vec3f a = p.positions[p.indices[i]], b = p.positions[p.indices[i + 1]], c = p.positions[p.indices[i + 2]];
      const auto side = [&](Vec3f from, Vec3f to) {
        return (double(to.x) - from.x) * (z - from.z) - (double(to.z) - from.z) * (x - from.x);
      };
      const double ab = side(a, b), bc = side(b, c), ca = side(c, a), sum = ab + bc + ca;
      if (sum == 0 || ab * sum < 0 || bc * sum < 0 || ca * sum < 0) continue;
      heights.push_back((bc * a.y + ca * b.y + ab * c.y) / sum);
    }
  }
  return heights;
}

template <class Fn>
void for_each_world_vertex(const Scene& scene, const std::string& mesh, Fn&& visit) {
  for (const Node& node : scene.nodes) {
    if (node.mesh == kNoIndex || scene.meshes[static_cast<std::size_t>(node.mesh)].name != mesh) continue;
    const Mat4& m = node.world_from_local;
    for (const MeshPrimitive& p : scene.meshes[static_cast<std::size_t>(node.mesh)].primitives)
      for (const Vec3f v : p.positions)
        visit(Vec3f{m[0].x * v.x + m[1].x * v.y + m[2].x * v.z + m[3].x,
                    m[0].y * v.x + m[1].y * v.y + m[2].y * v.z + m[3].y,
                    m[0].z * v.x + m[1].z * v.y + m[2].z * v.z + m[3].z});
  }
}

// Length of the (2, 3) torus knot round a ring of 0.88 m, 0.4 m from it.
double knot_length() {
  constexpr int kSteps = 200000;
  const double turn = 2 * std::acos(-1.0);
  double length = 0, last[3] = {1.28, 0, 0};
  for (int i = 1; i <= kSteps; ++i) {
    const double t = turn * i / kSteps, r = 0.88 + 0.4 * std::cos(3 * t);
    const double p[3] = {r * std::cos(2 * t), r * std::sin(2 * t), 0.4 * std::sin(3 * t)};
    length += std::sqrt((p[0] - last[0]) * (p[0] - last[0]) + (p[1] - last[1]) * (p[1] - last[1]) +
                        (p[2] - last[2]) * (p[2] - last[2]));
    std::copy(p, p + 3, last);
  }
  return length;
}

}  // namespace

TEST_CASE("triangle counts of the papers' scenes are met within a tenth", "[procedural]") {
  struct Range {
    const char* name;
    std::vector<std::uint64_t> counts;
  };
  const Range ranges[] = {{"ball", {200, 333, 700, 900, 5000, 39936, 300000}},
                          {"knot", {200, 600, 800, 3000, 39936, 500000, 2400000}},
                          {"furnace", {100, 150, 300, 1000, 3300, 20000}},
                          {"tank", {1000, 1700, 3000, 5100, 11000, 64000, 400000}},
                          {"pond", {2000, 3100, 4400, 5000, 7700, 20000, 128000, 2000000}}};
  for (const Range& range : ranges) {
    for (const std::uint64_t n : range.counts) {
      const double got = static_cast<double>(count_triangles(make(range.name, n)));
      INFO(range.name << " with " << n << " triangles has " << got);
      CHECK(std::fabs(got / static_cast<double>(n) - 1.0) <= 0.1);
    }
  }
}

TEST_CASE("the papers' scenes are sound: finite, not degenerate, unit normals on the front", "[procedural]") {
  for (const std::uint64_t n : {300u, 39936u}) check_sound(make("ball", n));
  for (const std::uint64_t n : {300u, 5000u, 200000u}) check_sound(make("knot", n));
  for (const std::uint64_t n : {100u, 1000u}) check_sound(make("furnace", n));
  for (const std::uint64_t n : {1000u, 5000u, 64000u}) check_sound(make("tank", n));
  for (const std::uint64_t n : {2000u, 5000u, 12000u, 40000u, 128000u, 500000u}) check_sound(make("pond", n));
}

TEST_CASE("the ball alone has the 39936 triangles of Li et al.'s Table 1", "[procedural]") {
  for (const ProceduralScene& s : procedural_scenes()) {
    if (std::string(s.name) == "ball") CHECK(s.default_triangles == 39936);
    if (std::string(s.name) == "knot") CHECK(s.default_triangles == 2400000);
  }
  const Scene scene = make("ball", 39936);
  CHECK(mesh_triangles(scene, "ball") == 39936);
  const Mesh* ball = find_mesh(scene, "ball");
  REQUIRE(ball);
  CHECK(is_closed(*ball));
  CHECK(signed_volume(*ball) == Approx(4.0 / 3.0 * std::acos(-1.0) * 0.95 * 0.95 * 0.95).epsilon(1e-3));
  REQUIRE(scene.waters.size() == 1);
  CHECK(scene.waters[0].surface.kind == SurfaceKind::kPerlin);
}

TEST_CASE("the knot is one closed tube", "[procedural]") {
  const double tube = std::acos(-1.0) * 0.25 * 0.25 * knot_length();
  const Scene smooth = make("knot", 5000), studded = make("knot", 60000);
  REQUIRE(find_mesh(smooth, "knot"));
  REQUIRE(find_mesh(studded, "knot"));
  CHECK(is_closed(*find_mesh(smooth, "knot")));
  CHECK(is_closed(*find_mesh(studded, "knot")));
  // The polygon of its section is a little smaller than the circle; studs add to the tube.
  CHECK(signed_volume(*find_mesh(smooth, "knot")) == Approx(tube).epsilon(0.04));
  CHECK(signed_volume(*find_mesh(studded, "knot")) > 1.02 * tube);
  CHECK(signed_volume(*find_mesh(studded, "knot")) < 1.30 * tube);
}

TEST_CASE("the tank's water stands and lies, and holds what swims in it", "[procedural]") {
  const Scene scene = make("tank", 20000);
  const RenderScene out = build_render_scene(scene);
  REQUIRE(out.waters.size() == 2);
  const WaterBody &top = out.waters[0], &front = out.waters[1];
  CHECK(top.name == "top");
  CHECK(front.name == "front");
  CHECK((top.normal.x == 0 && top.normal.y == 1 && top.normal.z == 0));
  CHECK((front.normal.x == 0 && front.normal.y == 0 && front.normal.z == 1));
  // They bound the same water: the front's upper edge and the top's front edge are one.
  float highest = -1, nearest = -1;
  for (const Vec3f p : front.outline) highest = std::max(highest, p.y);
  for (const Vec3f p : top.outline) nearest = std::max(nearest, p.z);
  CHECK(highest == Approx(top.origin.y).margin(1e-6));
  CHECK(nearest == Approx(front.origin.z).margin(1e-6));
  CHECK(top.origin.y - top.depth_m == Approx(0.06).margin(1e-6));
  CHECK(front.origin.z - front.depth_m == Approx(-0.40).margin(1e-6));
  for (const char* name : {"clownfish", "tang", "weeds", "stones", "arch"}) {
    int outside = 0, vertices = 0;
    for_each_world_vertex(scene, name, [&](Vec3f p) {
      ++vertices;
      if (std::fabs(p.x) > 0.9f || std::fabs(p.z) > 0.4f || p.y < 0 || p.y > 0.78f) ++outside;
    });
    INFO(name);
    CHECK(vertices > 0);
    CHECK(outside == 0);
  }
}

TEST_CASE("the pond has Steel's 128 pots in two colours, on its bed", "[procedural]") {
  for (const std::uint64_t n : {5000u, 128000u}) {
    const Scene scene = make("pond", n);
    const Mesh* terrain = find_mesh(scene, "terrain");
    REQUIRE(terrain);
    int pots[2] = {0, 0}, under = 0, off_the_bed = 0;
    for (const Node& node : scene.nodes) {
      if (node.mesh == kNoIndex) continue;
      const std::string& name = scene.meshes[static_cast<std::size_t>(node.mesh)].name;
      if (name != "blue_pot" && name != "green_pot") continue;
      ++pots[name == "blue_pot" ? 0 : 1];
      const Vec3f at(node.world_from_local[3]);
      if (at.y < -0.2f) ++under;
      const std::vector<double> ground = heights_at(*terrain, double(at.x), double(at.z));
      // A coarse bed cuts corners.
      if (ground.empty() || std::fabs(ground[0] - double(at.y)) > (n > 100000 ? 0.35 : 0.8)) ++off_the_bed;
    }
    CHECK(pots[0] == 64);
    CHECK(pots[1] == 64);
    CHECK(under >= 100);
    CHECK(off_the_bed == 0);
  }
  const Scene scene = make("pond", 128000);
  for (const char* name : {"blue_pot", "green_pot", "boulder", "slab", "pine"}) {
    INFO(name);
    REQUIRE(find_mesh(scene, name));
    if (std::string(name) == "pine") continue;
    CHECK(is_closed(*find_mesh(scene, name)));
    CHECK(signed_volume(*find_mesh(scene, name)) > 0);
  }
}

TEST_CASE("the pond's shore is the ground's: the water's edge is under it all round", "[procedural]") {
  for (const std::uint64_t n : {2000u, 5000u, 128000u}) {
    const Scene scene = make("pond", n);
    const Mesh* terrain = find_mesh(scene, "terrain");
    REQUIRE(terrain);
    REQUIRE(scene.waters.size() == 1);
    const double x = 0.5 * double(scene.waters[0].size_x), z = 0.5 * double(scene.waters[0].size_z);
    double lowest_rim = 1e9, lowest = 1e9;
    int holes = 0;
    const auto height_at = [&](double at_x, double at_z) {
      const std::vector<double> heights = heights_at(*terrain, at_x, at_z);
      if (heights.empty()) ++holes;
      return heights.empty() ? 0.0 : heights[0];
    };
    for (int i = 0; i <= 40; ++i) {
      const double t = 2.0 * i / 40 - 1;
      for (const double side : {-1.0, 1.0}) {
        lowest_rim = std::min({lowest_rim, height_at(t * x, side * z), height_at(side * x, t * z)});
      }
      lowest = std::min(lowest, height_at(0.8 * t * x, 0.3 * z));
    }
    INFO(n << " triangles");
    CHECK(holes == 0);
    CHECK(lowest_rim > 0.05);
    CHECK(lowest < -1.2);
    // All of the bed is inside of the body, so that a camera over it is under water.
    float bottom = 0;
    for (const MeshPrimitive& p : terrain->primitives)
      for (const Vec3f v : p.positions) bottom = std::min(bottom, v.y);
    CHECK(bottom > -scene.waters[0].depth);
  }
}

TEST_CASE("the papers' scenes have cameras above and under the water", "[procedural]") {
  const auto names = [](const char* scene, std::uint64_t triangles) {
    std::string all;
    for (const PlacedCamera& camera : build_render_scene(make(scene, triangles)).cameras) all += camera.name + " ";
    return all;
  };
  CHECK(names("ball", 1000) == "high grazing under surface ");
  CHECK(names("knot", 1000) == "high grazing under surface ");
  CHECK(names("pond", 5000) == "high grazing under surface ");
  CHECK(names("furnace", 100) == "above under wall ");
  CHECK(names("tank", 1000) == "front oblique above grazing under low ");
}

TEST_CASE("the papers' scenes are the same bytes on every machine", "[procedural][digest]") {
  // Positions, normals, uvs, colours, indices, matrices and texels. To be changed only with the scene itself.
  CHECK(digest(make("ball", 39936)) == "2801ec15f42350f4");
  CHECK(digest(make("knot", 20000)) == "19d859364c15d566");
  CHECK(digest(make("furnace", 1000)) == "7d5d003825cdfef5");
  CHECK(digest(make("tank", 20000)) == "bf810be7fd791499");
  CHECK(digest(make("pond", 20000)) == "847f9ac6d86dc993");
}
