// The built-in scenes: triangle counts, valid meshes, closed solids, cameras, and the same bytes on every machine.
#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "tests/scene/procedural_checks.h"

using namespace shoal;
using namespace shoal::test;

TEST_CASE("triangle counts are met within a tenth", "[procedural]") {
  std::vector<std::uint64_t> counts = {100, 101, 103, 107, 113, 127, 139, 150, 163,
                                       177, 191, 223, 251, 307, 401, 555, 777};
  for (double n = 1000; n < 1.3e6; n *= 2.37) counts.push_back(static_cast<std::uint64_t>(n));
  counts.push_back(128000);
  for (const char* name : {"pool", "box"}) {
    for (const std::uint64_t n : counts) {
      const double got = static_cast<double>(count_triangles(make(name, n)));
      INFO(name << " with " << n << " triangles has " << got);
      CHECK(std::fabs(got / static_cast<double>(n) - 1.0) <= 0.1);
    }
  }
}

TEST_CASE("meshes are sound: finite, not degenerate, unit normals on the front", "[procedural]") {
  for (const std::uint64_t n : {100u, 1000u, 5000u, 30000u, 128000u}) check_sound(make("pool", n));
  for (const std::uint64_t n : {100u, 1000u, 5000u}) check_sound(make("box", n));
}

TEST_CASE("solids are closed and wound outwards", "[procedural]") {
  for (const std::uint64_t n : {3000u, 128000u}) {
    const Scene scene = make("pool", n);
    for (const char* name : {"ball_1", "ball_2", "ball_3", "ring_1", "ring_2", "ring_3", "ring_4", "cypress"}) {
      const Mesh* mesh = find_mesh(scene, name);
      INFO(name << " of " << n);
      if (!mesh) continue;
      CHECK(is_closed(*mesh));
      CHECK(signed_volume(*mesh) > 0);
    }
  }
  const Scene scene = make("pool", 128000);
  // Within a few per cent of the sphere and the torus that they are.
  REQUIRE(find_mesh(scene, "ball_1"));
  REQUIRE(find_mesh(scene, "ring_1"));
  CHECK(signed_volume(*find_mesh(scene, "ball_1")) ==
        Approx(4.0 / 3.0 * 3.14159265 * 0.27 * 0.27 * 0.27).epsilon(0.03));
  CHECK(signed_volume(*find_mesh(scene, "ring_1")) ==
        Approx(2 * 3.14159265 * 3.14159265 * 0.42 * 0.125 * 0.125).epsilon(0.03));
}

TEST_CASE("the basin is coarse or fine, without a crack", "[procedural]") {
  std::size_t vertices[2];
  int i = 0;
  for (const std::uint64_t n : {100u, 128000u}) {
    const Scene scene = make("pool", n);
    const Mesh* basin = find_mesh(scene, "basin");
    REQUIRE(basin);
    vertices[i] = 0;
    for (const MeshPrimitive& p : basin->primitives) vertices[i] += p.positions.size();
    ++i;
    // Its only open edge is the rim at the deck.
    std::map<std::array<float, 6>, int> edges;
    for (const MeshPrimitive& p : basin->primitives) {
      for (std::size_t t = 0; t < p.indices.size(); t += 3) {
        for (std::size_t k = 0; k < 3; ++k) {
          Vec3f a = p.positions[p.indices[t + k]], b = p.positions[p.indices[t + (k + 1) % 3]];
          const std::array<float, 3> ka{a.x + 0, a.y + 0, a.z + 0}, kb{b.x + 0, b.y + 0, b.z + 0};
          const bool forth = ka < kb;
          if (!forth) std::swap(a, b);
          edges[{a.x + 0, a.y + 0, a.z + 0, b.x + 0, b.y + 0, b.z + 0}] += forth ? 1 : -1;
        }
      }
    }
    std::size_t open_below = 0;
    for (const auto& [edge, times] : edges) {
      if (times != 0 && !(edge[1] == 0.10f && edge[4] == 0.10f)) ++open_below;
    }
    CHECK(open_below == 0);
  }
  CHECK(vertices[0] < 98);
  CHECK(vertices[1] > 1093);
}

TEST_CASE("cameras come in the order that the command promises", "[procedural]") {
  for (const std::uint64_t n : {100u, 20000u}) {
    const RenderScene out = build_render_scene(make("pool", n));
    REQUIRE(out.cameras.size() == 4);
    CHECK(out.cameras[0].name == "high");
    CHECK(out.cameras[1].name == "grazing");
    CHECK(out.cameras[2].name == "under");
    CHECK(out.cameras[3].name == "surface");
    REQUIRE(out.waters.size() == 1);
    CHECK(out.cameras[1].camera.position_world.y > 0);
    CHECK(out.cameras[2].camera.position_world.y < 0);
    CHECK(std::fabs(out.cameras[3].camera.position_world.y) < 0.2f);
    CHECK(out.geometry.triangles.size() == count_triangles(make("pool", n)));
  }
}

TEST_CASE("a scene is the same bytes on every machine", "[procedural][digest]") {
  // Positions, normals, uvs, colours, indices, matrices and texels. To be changed only with the scene itself.
  CHECK(digest(make("pool", 20000)) == "937f51191d4e51dc");
  CHECK(digest(make("box", 1000)) == "0f4655fdcc9bc432");
}
