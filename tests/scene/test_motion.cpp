// Moving scenes: every vertex against double, normals, bounds, water, cameras and lights; sample models where they are
// available.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "core/error.h"
#include "core/thread_pool.h"
#include "scene/gltf/gltf.h"
#include "tests/scene/motion_oracle.h"

namespace shoal::test {
namespace {

// A bar along y of `rings` squares, its joints at y = 0 and y = 1.
Scene bent_bar() {
  Scene scene;
  scene.name = "bar";
  scene.nodes.resize(3);
  scene.locals.resize(3);
  scene.nodes[0].mesh = 0;
  scene.nodes[0].skin = 0;
  scene.nodes[2].parent = 1;
  scene.locals[0].translation[0] = 100;  // a skinned mesh does not follow its node
  scene.locals[2].translation[1] = 1;
  MeshPrimitive p;
  constexpr int kRings = 9;
  for (int r = 0; r < kRings; ++r) {
    const float y = 2.0f * static_cast<float>(r) / (kRings - 1), upper = y < 1 ? 0.0f : y - 1;
    for (int i = 0; i < 4; ++i) {
      const float x = i == 0 || i == 3 ? -0.25f : 0.25f, z = i < 2 ? -0.25f : 0.25f;
      p.positions.push_back({x, y, z});
      p.normals.push_back({x * 2.8284271f, 0, z * 2.8284271f});
      for (const int joint : {0, 1, 0, 0}) p.joints.push_back(static_cast<std::uint16_t>(joint));
      for (const float weight : {1 - upper, upper, 0.0f, 0.0f}) p.weights.push_back(weight);
    }
  }
  for (std::uint32_t r = 0; r + 1 < kRings; ++r) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t a = 4 * r + i, b = 4 * r + (i + 1) % 4;
      p.indices.insert(p.indices.end(), {a, a + 4, b, b, a + 4, b + 4});
    }
  }
  p.influences = 4;
  scene.meshes.push_back({"bar", {p}});
  scene.materials.materials.emplace_back();
  Skin skin;
  skin.joints = {1, 2};
  skin.joint_from_mesh.assign(2, kIdentity4);
  skin.joint_from_mesh[1][3].y = -1;
  scene.skins.push_back(skin);
  Channel bend;
  bend.node = 2;
  bend.path = ChannelPath::kRotation;
  bend.times_s = {0, 2};
  bend.values = {0, 0, 0, 1, 0, 0, 0.70710678f, 0.70710678f};  // a quarter about z
  scene.animations.push_back({"bend", {bend}});
  for (Node& node : scene.nodes) node.world_from_local = kIdentity4;
  return scene;
}

// A triangle of its own vertices, on a node that an animation slides, turns and mirrors.
Scene lone_triangle() {
  Scene scene;
  scene.name = "triangle";
  scene.nodes.resize(1);
  scene.locals.resize(1);
  scene.nodes[0].mesh = 0;
  MeshPrimitive p;
  p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  p.normals.assign(3, {0, 0, 1});
  p.indices = {0, 1, 2};
  scene.meshes.push_back({"", {p}});
  scene.materials.materials.emplace_back();
  return scene;
}

Channel channel(std::int32_t node, ChannelPath path, std::vector<float> times, std::vector<float> values) {
  Channel c;
  c.node = node;
  c.path = path;
  c.times_s = std::move(times);
  c.values = std::move(values);
  return c;
}

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}
bool same_geometry(const Geometry& a, const Geometry& b) {
  bool meshlets = a.meshlets.size() == b.meshlets.size();
  for (std::size_t c = 0; meshlets && c < a.meshlets.size(); ++c) {
    const Meshlet &x = a.meshlets[c], &y = b.meshlets[c];
    meshlets = std::memcmp(&x.bounds_min_world, &y.bounds_min_world, 12) == 0 &&
               std::memcmp(&x.bounds_max_world, &y.bounds_max_world, 12) == 0 && x.longest_edge_m == y.longest_edge_m;
  }
  return meshlets && same_bytes(a.vertices, b.vertices) && same_bytes(a.x_world, b.x_world) &&
         same_bytes(a.y_world, b.y_world) && same_bytes(a.z_world, b.z_world) && same_bytes(a.triangles, b.triangles) &&
         a.corner0 == b.corner0 && a.corner1 == b.corner1 && a.corner2 == b.corner2;
}

// Front of a triangle as it is drawn.
Vec3f drawn_front(const Geometry& g, std::size_t triangle) {
  const auto corner = [&](std::size_t k) { return g.vertices[g.triangles[triangle].vertex[k]].position_world; };
  return cross(corner(1) - corner(0), corner(2) - corner(0));
}

}  // namespace

TEST_CASE("motion: a bent bar's vertices and normals", "[motion]") {
  const Scene scene = bent_bar();
  RenderScene render = build_render_scene(scene);
  REQUIRE(render.moves());
  for (const double t : {0.0, 0.3, 1.0, 1.9, 2.0, 5.0}) {
    CAPTURE(t);
    update_render_scene(render, t);
    CHECK(worst_position(scene, render, oracle_pose(scene, {0}, t)) < 4e-6);
    for (const VertexRecord& v : render.geometry.vertices)
      CHECK(std::fabs(dot(v.normal_world, v.normal_world) - 1) < 1e-5f);
  }
  // At the end the upper half lies along -x from (0, 1, 0), its top at x = -1. The ring at y = 1.5 is half of each: its
  // corner (0.25, 1.5) stays and goes to (-0.5, 1.25).
  CHECK(render.bounds_min_world.x == Approx(-1).margin(1e-6));
  CHECK(render.bounds_max_world.y == Approx(1.375).margin(1e-6));
}

TEST_CASE("motion: the time alone decides, not the times before, nor the threads", "[motion]") {
  const Scene scene = bent_bar();
  RenderScene one = build_render_scene(scene), other = build_render_scene(scene);
  CHECK(same_geometry(one.geometry, other.geometry));
  update_render_scene(one, 0.7);
  CHECK_FALSE(same_geometry(one.geometry, other.geometry));
  ThreadPool pool(3);
  for (const double t : {1.9, -3.0, 0.2, 0.7}) update_render_scene(other, t, &pool);
  CHECK(same_geometry(one.geometry, other.geometry));
  update_render_scene(one, 0);
  CHECK(same_geometry(one.geometry, build_render_scene(scene).geometry));
}

TEST_CASE("motion: what was built and what was moved there are the same", "[motion]") {
  // The same place once by keyframes and once as a scene that stands still.
  Scene moving = lone_triangle(), still = lone_triangle();
  moving.animations.push_back({"", {channel(0, ChannelPath::kTranslation, {0, 1}, {0, 0, 0, 4, 8, -2})}});
  still.locals.clear();
  still.nodes[0].world_from_local = translation({1, 2, -0.5f});
  RenderScene render = build_render_scene(moving);
  update_render_scene(render, 0.25);
  CHECK(same_geometry(render.geometry, build_render_scene(still).geometry));
  CHECK_FALSE(build_render_scene(still).moves());
}

TEST_CASE("motion: a mirrored moment keeps the front in front", "[motion]") {
  Scene scene = lone_triangle();
  scene.animations.push_back({"", {channel(0, ChannelPath::kScale, {0, 1}, {1, 1, 1, -1, 1, 1})}});
  RenderScene render = build_render_scene(scene);
  for (const double t : {0.0, 0.25, 0.75, 1.0, 0.1}) {
    CAPTURE(t);
    update_render_scene(render, t);
    CHECK(drawn_front(render.geometry, 0).z > 0);
    CHECK(render.geometry.vertices[0].normal_world.z == 1);
    const Meshlet& meshlet = render.geometry.meshlets[0];
    const auto corner = [&](const std::vector<std::uint8_t>& c) {
      return render.geometry.vertices[meshlet.first_vertex + c[meshlet.first_index]].position_world;
    };
    const Vec3f a = corner(render.geometry.corner0), b = corner(render.geometry.corner1),
                c = corner(render.geometry.corner2);
    CHECK(cross(b - a, c - a).z > 0);
  }
}

TEST_CASE("motion: morph targets move positions and normals", "[motion]") {
  Scene scene = lone_triangle();
  scene.meshes[0].primitives[0].targets = {{{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}, {}},
                                           {{{0, 0, 0}, {0, 0, 2}, {0, 0, 0}}, {{0, 0, 0}, {-1, 0, 0}, {0, 0, 0}}}};
  scene.nodes[0].morph_weights = {0.5f, 0};
  scene.animations.push_back({"", {channel(0, ChannelPath::kWeights, {0, 1}, {0.5f, 0, 0, 1})}});
  RenderScene render = build_render_scene(scene);
  CHECK(render.geometry.vertices[0].position_world.z == 0.5f);
  update_render_scene(render, 0.5);
  CHECK(render.geometry.vertices[0].position_world.z == 0.25f);
  CHECK(render.geometry.vertices[1].position_world.z == 1.25f);
  CHECK(render.geometry.vertices[1].normal_world.x == Approx(-0.5 / std::sqrt(1.25)).margin(1e-6));
  CHECK(render.geometry.vertices[1].normal_world.z == Approx(1 / std::sqrt(1.25)).margin(1e-6));

  scene.meshes[0].primitives[0].flat_normals = true;  // the triangle's own, wherever it goes
  render = build_render_scene(scene);
  update_render_scene(render, 1);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(render.geometry.vertices[i].normal_world.x == Approx(-2 / std::sqrt(5.0)).margin(1e-6));
    CHECK(render.geometry.vertices[i].normal_world.z == Approx(1 / std::sqrt(5.0)).margin(1e-6));
  }
}

TEST_CASE("motion: water, cameras and lights go with their nodes", "[motion]") {
  Scene scene = lone_triangle();
  scene.nodes.resize(4);
  scene.locals.resize(4);
  scene.nodes[0].world_from_local = kIdentity4;
  WaterSpec spec;
  spec.has_size = true;
  spec.size_x = 2, spec.size_z = 4;
  scene.waters.push_back(spec);
  scene.cameras.emplace_back();
  scene.lights.emplace_back();
  scene.nodes[1].water = 0;
  scene.nodes[2].camera = 0;
  scene.nodes[3].light = 0;
  for (const int n : {1, 2, 3}) scene.nodes[static_cast<std::size_t>(n)].parent = 0;
  const std::vector<float> quarter = {0, 0, 0, 1, 0.70710678f, 0, 0, 0.70710678f};  // about x: -z turns to +y
  scene.animations.push_back({"",
                              {channel(0, ChannelPath::kTranslation, {0, 1}, {0, 3, 0, 0, 5, 0}),
                               channel(0, ChannelPath::kRotation, {0, 1}, quarter)}});
  RenderScene render = build_render_scene(scene);
  REQUIRE(render.waters.size() == 1);
  CHECK(render.waters[0].origin.y == 3);
  const float depth_m = render.waters[0].depth_m;
  const PlacedCamera camera = render.cameras[0];
  CHECK(camera.camera.forward_world.z == -1);
  CHECK(render.lighting.directional[0].direction_world.z == -1);

  CHECK(camera_at(render, camera, 1).forward_world.y == Approx(1).margin(1e-6));
  CHECK(camera_at(render, camera, 0.5).position_world.y == 4);
  update_render_scene(render, 1);
  CHECK(render.waters[0].origin.y == 5);
  CHECK(render.waters[0].normal.z == Approx(1).margin(1e-6));
  CHECK(render.waters[0].depth_m == depth_m);
  CHECK(render.waters[0].outline.size() == 6);
  CHECK(render.cameras[0].camera.forward_world.y == Approx(1).margin(1e-6));
  CHECK(render.lighting.directional[0].direction_world.y == Approx(1).margin(1e-6));
  CHECK(render.lighting.background.to_sun_world.y == Approx(-1).margin(1e-6));
}

TEST_CASE("motion: a vertex that leaves the numbers is an error that names its node", "[motion]") {
  Scene scene = lone_triangle();
  scene.nodes[0].name = "rocket";
  scene.meshes[0].primitives[0].positions[1].x = 1e20f;
  scene.animations.push_back({"", {channel(0, ChannelPath::kScale, {0, 1}, {1, 1, 1, 1e30f, 1, 1})}});
  RenderScene render = build_render_scene(scene);
  CHECK_THROWS_WITH(update_render_scene(render, 1), Catch::Matchers::Contains("node 'rocket'"));
}

TEST_CASE("motion: the sample models, every vertex at several times", "[motion]") {
  const char* shared = std::getenv("SHOAL_SHARED_DATA");
  if (shared == nullptr || !std::filesystem::exists(std::string(shared) + "/gltf/MODELS.csv")) {
    WARN("SHOAL_SHARED_DATA is not set: the animated sample models are not tested");
    return;
  }
  struct Model {
    const char* file;
    std::size_t animations, playing, skins;
    double end_s;
  };
  for (const Model& model : {Model{"SimpleSkin/glTF/SimpleSkin.gltf", 1, 1, 1, 5.5},
                             Model{"RiggedSimple/glTF-Binary/RiggedSimple.glb", 1, 1, 1, 2.1},
                             Model{"Fox/glTF-Binary/Fox.glb", 3, 1, 1, 3.4},
                             Model{"AnimatedMorphCube/glTF/AnimatedMorphCube.gltf", 1, 1, 0, 4.2},
                             Model{"SimpleMorph/glTF/SimpleMorph.gltf", 1, 1, 0, 4.0},
                             Model{"InterpolationTest/glTF-Binary/InterpolationTest.glb", 9, 9, 0, 2.0}}) {
    CAPTURE(model.file);
    const Scene scene = load_gltf(std::string(shared) + "/gltf/" + model.file);
    REQUIRE(scene.animations.size() == model.animations);
    CHECK(scene.skins.size() == model.skins);
    CHECK(scene.warnings.size() == (model.playing == model.animations ? 0 : 1));
    std::vector<std::size_t> playing;
    for (std::size_t a = 0; a < model.playing; ++a) playing.push_back(a);
    RenderScene render = build_render_scene(scene);
    REQUIRE(render.moves());
    for (int step = -1; step <= 8; ++step) {
      const double t = model.end_s * step / 7;
      update_render_scene(render, t);
      CAPTURE(t);
      CHECK(worst_position(scene, render, oracle_pose(scene, playing, t)) < 4e-6);
      Vec3f lo = render.geometry.vertices[0].position_world, hi = lo;
      for (const VertexRecord& v : render.geometry.vertices) {
        lo = {std::min(lo.x, v.position_world.x), std::min(lo.y, v.position_world.y),
              std::min(lo.z, v.position_world.z)};
        hi = {std::max(hi.x, v.position_world.x), std::max(hi.y, v.position_world.y),
              std::max(hi.z, v.position_world.z)};
      }
      CHECK(std::memcmp(&lo, &render.bounds_min_world, sizeof lo) == 0);
      CHECK(std::memcmp(&hi, &render.bounds_max_world, sizeof hi) == 0);
    }
  }
}

}  // namespace shoal::test
