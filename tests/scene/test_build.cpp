// Building a scene for rendering: geometry in world space, outlines of water, cameras, lighting.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "scene/scene.h"

using namespace shoal;

namespace {

// One triangle in the x-y plane, facing +z, in a node with the given matrix.
Scene triangle_scene(const Mat4& world_from_local) {
  Scene scene;
  scene.name = "test";
  scene.materials.materials.resize(1);
  MeshPrimitive p;
  p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  p.normals.assign(3, Vec3f{0, 0, 1});
  p.indices = {0, 1, 2};
  scene.meshes.push_back({"triangle", {p}});
  Node node;
  node.name = "triangle";
  node.mesh = 0;
  node.world_from_local = world_from_local;
  scene.nodes.push_back(node);
  return scene;
}

Node place(const char* name, const Mat4& world_from_local) {
  Node node;
  node.name = name;
  node.world_from_local = world_from_local;
  return node;
}

// A unit square on y = 0, wound to face down.
Mesh square_mesh(float y = 0) {
  MeshPrimitive p;
  p.positions = {{-1, y, -1}, {1, y, -1}, {1, y, 1}, {-1, y, 1}};
  p.normals.assign(4, Vec3f{0, 1, 0});
  p.indices = {0, 1, 2, 0, 2, 3};
  return {"square", {p}};
}

Vec3f face_normal(const Geometry& g, std::size_t triangle) {
  const auto& v = g.triangles[triangle].vertex;
  const Vec3f a = g.vertices[v[0]].position_world, b = g.vertices[v[1]].position_world,
              c = g.vertices[v[2]].position_world;
  return cross(b - a, c - a);
}

double outline_area(const WaterBody& body) {
  double area = 0;
  for (std::size_t i = 0; i < body.outline.size(); i += 3) {
    const Vec3f n = cross(body.outline[i + 1] - body.outline[i], body.outline[i + 2] - body.outline[i]);
    area += 0.5 * double(dot(n, body.normal));
  }
  return area;
}

constexpr Mat4 kMirrorX = from_rows({-1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0});
// A quarter turn about x: +y goes to +z, +z to -y.
constexpr Mat4 kTurnX = from_rows({1, 0, 0, 5}, {0, 0, -1, 6}, {0, 1, 0, 7});

}  // namespace

TEST_CASE("normals go by the inverse transpose and stay unit", "[build]") {
  Mat4 t = kIdentity4;  // squash x to a quarter, shear z by x
  t[0].x = 0.25f;
  t[0].z = 0.5f;
  Scene scene = triangle_scene(t);
  scene.meshes[0].primitives[0].normals.assign(3, Vec3f{0.6f, 0, 0.8f});
  const RenderScene out = build_render_scene(scene);
  // A tangent of that normal, moved by the matrix in double, must stay at a right angle to it.
  const double tx = 0.25 * 0.8, tz = 0.5 * 0.8 - 0.6;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3f n = out.geometry.vertices[i].normal_world;
    CHECK(std::fabs(double(n.x) * tx + double(n.z) * tz) < 1e-6);
    CHECK(double(dot(n, n)) == Approx(1.0).epsilon(1e-6));
    CHECK(n.z > 0);
  }
}

TEST_CASE("normals survive tiny and flat scales", "[build]") {
  for (const float s : {1e-18f, 1e12f}) {
    Mat4 t = kIdentity4;
    for (int i = 0; i < 3; ++i) t[i][i] = s;
    const Vec3f n = build_render_scene(triangle_scene(t)).geometry.vertices[0].normal_world;
    CHECK(n.z == Approx(1.0f));
  }
  Mat4 flat = kIdentity4;
  flat[0].x = flat[1].y = flat[2].z = 0;
  const Vec3f n = build_render_scene(triangle_scene(flat)).geometry.vertices[0].normal_world;
  CHECK(dot(n, n) == 1.0f);
}

TEST_CASE("a mirrored node keeps its front faces in front", "[build]") {
  CHECK(face_normal(build_render_scene(triangle_scene(kIdentity4)).geometry, 0).z > 0);
  const RenderScene out = build_render_scene(triangle_scene(kMirrorX));
  CHECK(face_normal(out.geometry, 0).z > 0);
  CHECK(out.geometry.vertices[0].normal_world.z == 1.0f);
  CHECK(out.bounds_min_world.x == -1.0f);
}

TEST_CASE("a vertex that leaves the numbers is an error", "[build]") {
  Scene scene = triangle_scene(kIdentity4);
  scene.meshes[0].primitives[0].positions[1].x = 3e38f;
  scene.nodes[0].world_from_local[0].x = 10;
  CHECK_THROWS_AS(build_render_scene(scene), Error);
}

TEST_CASE("water of a given size, on a turned, scaled and mirrored node", "[build][water]") {
  for (const float mirror : {1.0f, -1.0f}) {
    Scene scene = triangle_scene(kIdentity4);
    WaterSpec spec;
    spec.has_size = spec.has_depth = true;
    spec.size_x = 4;
    spec.size_z = 2;
    spec.depth = 1.5f;
    scene.waters.push_back(spec);
    Mat4 t = kTurnX;
    for (int row = 0; row < 3; ++row) {
      t[0][row] *= 3.0f * mirror;
      t[1][row] *= 2.0f;
    }
    scene.nodes.push_back(place("water", t));
    scene.nodes[1].water = 0;
    const RenderScene out = build_render_scene(scene);
    REQUIRE(out.waters.size() == 1);
    const WaterBody& w = out.waters[0];
    CHECK(w.node == 1);
    CHECK(w.normal.z == 1.0f);
    CHECK(w.origin.y == 6.0f);
    CHECK(w.depth_m == Approx(3.0));
    REQUIRE(w.outline.size() == 6);
    CHECK(outline_area(w) == Approx(4 * 3 * 2));
    for (const Vec3f& p : w.outline) CHECK(p.z == 7.0f);
    for (std::size_t i = 0; i < 6; i += 3) {
      CHECK(dot(cross(w.outline[i + 1] - w.outline[i], w.outline[i + 2] - w.outline[i]), w.normal) > 0);
    }
    CHECK(double(dot(w.axis_x, cross(w.normal, w.axis_z))) == Approx(1.0));
  }
}

TEST_CASE("a planar mesh is the water's outline: not drawn, its ids kept", "[build][water]") {
  Scene scene = triangle_scene(kIdentity4);
  scene.meshes.push_back(square_mesh());
  scene.waters.emplace_back();
  Node water = place("water", kIdentity4);
  water.world_from_local[3].y = 2;
  water.mesh = 1;
  water.water = 0;
  scene.nodes.insert(scene.nodes.begin(), water);
  const RenderScene out = build_render_scene(scene);
  REQUIRE(out.geometry.drawables.size() == 2);
  CHECK_FALSE(out.geometry.drawables[0].drawn);
  CHECK(out.geometry.drawables[1].first_triangle == 2);
  CHECK(out.geometry.meshlets.size() == 1);
  REQUIRE(out.waters.size() == 1);
  CHECK(outline_area(out.waters[0]) == Approx(4));
  CHECK(out.waters[0].depth_m == 2.0f);  // down to the triangle's lowest corner
}

TEST_CASE("water that makes no sense is an error", "[build][water]") {
  Scene scene = triangle_scene(kIdentity4);
  scene.meshes.push_back(square_mesh(0.5f));
  scene.waters.emplace_back();
  scene.nodes.push_back(place("water", kIdentity4));
  scene.nodes[1].water = 0;
  SECTION("neither size nor mesh") { CHECK_THROWS_AS(build_render_scene(scene), Error); }
  SECTION("a mesh off its plane") {
    scene.nodes[1].mesh = 1;
    CHECK_THROWS_AS(build_render_scene(scene), Error);
  }
  scene.waters[0].has_size = true;
  scene.waters[0].size_x = scene.waters[0].size_z = 1;
  SECTION("sound otherwise") { CHECK_NOTHROW(build_render_scene(scene)); }
  SECTION("a degenerate node") {
    scene.nodes[1].world_from_local[0].x = 0;
    CHECK_THROWS_AS(build_render_scene(scene), Error);
  }
  SECTION("no size") {
    scene.waters[0].size_z = std::numeric_limits<float>::quiet_NaN();
    CHECK_THROWS_AS(build_render_scene(scene), Error);
  }
  SECTION("ior out of range") {
    scene.waters[0].ior = 3.5f;
    CHECK_THROWS_AS(build_render_scene(scene), Error);
  }
}

TEST_CASE("cameras stand where their nodes are, in node order", "[build][camera]") {
  Scene scene = triangle_scene(kIdentity4);
  scene.cameras.resize(2);
  scene.cameras[0].yfov = 1.0f;
  scene.cameras[1].orthographic = true;
  scene.cameras[1].xmag = 3;
  scene.cameras[1].ymag = 2;
  Mat4 scaled = kTurnX;
  for (int row = 0; row < 3; ++row) scaled[1][row] *= 7.0f;  // a camera's node may be scaled: no matter
  scene.nodes.push_back(place("second", scaled));
  scene.nodes[1].camera = 1;
  scene.nodes.push_back(place("first", kTurnX));
  scene.nodes[2].camera = 0;
  const RenderScene out = build_render_scene(scene);
  REQUIRE(out.cameras.size() == 2);
  CHECK(out.cameras[0].name == "second");
  CHECK(out.cameras[0].camera.orthographic);
  CHECK(out.cameras[0].camera.xmag_m == 3);
  CHECK(out.cameras[1].name == "first");
  CHECK(double(out.cameras[1].camera.tan_half_yfov) == Approx(std::tan(0.5)).epsilon(1e-6));
  for (const PlacedCamera& placed : out.cameras) {
    // Local -z of that turn is world +y, local +y is world +z.
    CHECK(placed.camera.forward_world.y == 1.0f);
    CHECK(placed.camera.up_world.z == 1.0f);
    CHECK(placed.camera.right_world.x == 1.0f);
    CHECK(placed.camera.position_world.z == 7.0f);
  }
}

TEST_CASE("without a camera, one sees the whole scene", "[build][camera]") {
  Mat4 t = kIdentity4;
  t[0].x = 40;
  t[3].y = -300;
  const RenderScene out = build_render_scene(triangle_scene(t));
  REQUIRE(out.cameras.size() == 1);
  CHECK(out.cameras[0].name == "default");
  const View view = make_view(out.cameras[0].camera, 500, 500, {0, 0});
  for (const VertexRecord& v : out.geometry.vertices) {
    const ClipVertex<float> c = project<float>(view, v.position_world);
    CHECK(c.w > out.cameras[0].camera.near_m);
    CHECK(std::fabs(c.x / c.w) < 250);
    CHECK(std::fabs(c.y / c.w) < 250);
  }
}

TEST_CASE("light: the file's, or a default sun and sky for a lit scene, or none", "[build][light]") {
  Scene scene = triangle_scene(kIdentity4);
  SECTION("lit, without lights") {
    const Lighting light = build_render_scene(scene).lighting;
    REQUIRE(light.directional.size() == 1);
    CHECK(light.directional[0].direction_world.y < 0);
    CHECK(light.background.kind == Background::Kind::kSky);
    CHECK(light.ambient_up.z > 0);
  }
  SECTION("all unlit") {
    scene.materials.materials[0].unlit = true;
    const Lighting light = build_render_scene(scene).lighting;
    CHECK(light.directional.empty());
    CHECK(light.background.kind == Background::Kind::kColor);
    CHECK(light.background.color.x == 0);
  }
  SECTION("a light on a node") {
    scene.lights.push_back({{1, 0.5f, 0.25f}, 4});
    scene.nodes.push_back(place("sun", kTurnX));
    scene.nodes[1].light = 0;
    const Lighting light = build_render_scene(scene).lighting;
    REQUIRE(light.directional.size() == 1);
    CHECK(light.directional[0].direction_world.y == 1.0f);
    CHECK(light.directional[0].irradiance.y == 2.0f);
    CHECK(light.background.to_sun_world.y == -1.0f);
  }
  SECTION("a uniform background lights evenly from all sides") {
    scene.has_background = true;
    scene.background.color = {0.25f, 0.5f, 0.75f};
    const Lighting light = build_render_scene(scene).lighting;
    CHECK(light.ambient_up.y == 0.5f);
    CHECK(light.ambient_down.z == 0.75f);
  }
}

TEST_CASE("the ambient light from above is the sky's mean under the cosine", "[build][light]") {
  const Lighting light = build_render_scene(triangle_scene(kIdentity4)).lighting;
  // The gradient of shading/sky.h, integrated in double.
  const Background& b = light.background;
  double sum = 0;
  constexpr int kSteps = 20000;
  for (int i = 0; i < kSteps; ++i) {
    const double y = (i + 0.5) / kSteps, low = 0.8 * std::pow(1 - y, 3) + 0.2 * std::pow(1 - y, 16);
    sum += 2 * y * (double(b.zenith.x) + (double(b.horizon.x) - double(b.zenith.x)) * low) / kSteps;
  }
  CHECK(double(light.ambient_up.x) == Approx(sum).epsilon(1e-4));
}
