// The scenes `ball` and `knot`: objects over water as in Li et al.'s Table 1, a ball of 39936 triangles and, instead of
// their dragon of 2.4 million triangles, a studded torus knot. Both use the same basin of few triangles.
#include <cmath>
#include <cstdint>

#include "scene/procedural/mesh_builder.h"
#include "scene/procedural/scenes.h"
#include "scene/procedural/shapes.h"
#include "scene/procedural/textures.h"

namespace shoal {
namespace {

enum Mat : std::uint8_t { kFloor, kWall, kRim, kTerrace, kLawn, kGardenWall, kBall, kKnot, kMatCount };

// Metres. The water's plane is y = 0.
constexpr float kHalf = 4.0f, kDepth = 1.3f, kRimTop = 0.16f, kRimOut = 4.45f, kTerraceY = 0.06f, kTerraceOut = 10.0f;
constexpr float kLawnOut = 150.0f;

// A square frame of four flat quads between two squares around the axis, each at its own height. The quads face
// outward, or up where the frame is level.
void frame(PartBuilder& b, int material, float in, float y_in, float out, float y_out, float uv_metres, Vec3f color) {
  for (int side = 0; side < 4; ++side) {
    const Vec3f along = side == 0   ? Vec3f{1, 0, 0}
                        : side == 1 ? Vec3f{0, 0, -1}
                        : side == 2 ? Vec3f{-1, 0, 0}
                                    : Vec3f{0, 0, 1};
    const Vec3f away{-along.z, 0, along.x};
    const Vec3f n = normalize(Vec3f{0, 1, 0} * (out - in) + away * (y_in - y_out));
    b.surface(material, 1, 1, [&](float u, float v) {
      const float r = mix(out, in, v);
      Vec3f p = along * mix(-r, r, u) + away * r;
      p.y = mix(y_out, y_in, v);
      return SurfacePoint{p, n, {(along.x != 0 ? p.x : p.z) / uv_metres, (r + p.y) / uv_metres}, color};
    });
  }
}

void basin(PartBuilder& b) {
  const float x = kHalf, wall = kDepth + kRimTop;
  b.quad(kFloor, 1, 1, {-x, -kDepth, x}, {2 * x, 0, 0}, {0, 0, -2 * x}, 2.0f);
  b.quad(kWall, 1, 1, {-x, -kDepth, -x}, {2 * x, 0, 0}, {0, wall, 0}, 1.6f);
  b.quad(kWall, 1, 1, {x, -kDepth, x}, {-2 * x, 0, 0}, {0, wall, 0}, 1.6f);
  b.quad(kWall, 1, 1, {-x, -kDepth, x}, {0, 0, -2 * x}, {0, wall, 0}, 1.6f, {0.93f, 0.93f, 0.93f});
  b.quad(kWall, 1, 1, {x, -kDepth, -x}, {0, 0, 2 * x}, {0, wall, 0}, 1.6f, {0.93f, 0.93f, 0.93f});
  frame(b, kRim, kHalf, kRimTop, kRimOut, kRimTop, 0.6f, {1, 1, 1});
  frame(b, kRim, kRimOut, kRimTop, kRimOut, kTerraceY, 0.6f, {0.9f, 0.9f, 0.9f});
  frame(b, kTerrace, kRimOut, kTerraceY, kTerraceOut, kTerraceY, 2.4f, {1, 1, 1});
  // Two garden walls behind the basin, which the water reflects.
  const float o = kTerraceOut;
  b.box(kGardenWall, 1, {-o - 0.3f, -0.2f, -o - 0.3f}, {o, 1.9f, -o}, 3.0f);
  b.box(kGardenWall, 1, {-o - 0.3f, -0.2f, -o}, {-o, 1.9f, o}, 3.0f);
  frame(b, kLawn, kTerraceOut, kTerraceY, kLawnOut, -0.5f, 4.0f, {0.22f, 0.32f, 0.08f});
}

// The sphere of 2 around (up - 1) triangles whose number is closest to the budget: 208 x 97 for 39936.
void ball(PartBuilder& b, std::uint64_t triangles) {
  int belts = 1;
  while (13ull * static_cast<std::uint64_t>(belts + 1) * static_cast<std::uint64_t>(belts + 1) <= 3 * triangles)
    ++belts;
  const auto twice = 2 * static_cast<std::uint64_t>(belts);
  const int around = std::max(3, static_cast<int>((triangles + twice / 2) / twice));
  constexpr Vec3f kCentre{0, 0.52f, 0};
  constexpr float kRadius = 0.95f;
  b.surface(
      kBall, around, belts + 1,
      [&](float u, float v) {
        const Vec3f n = normalize(sphere_direction(u, v));
        return SurfacePoint{kCentre + n * kRadius, n, {u, 1.0f - v}};
      },
      Normals::kGiven, Poles::kBoth);
}

// The (2, 3) torus knot, upright: it winds twice around the ring and three times through it.
struct KnotPoint {
  Vec3f centre, out, side;  // of the tube; out and side span its cross-section
};
KnotPoint knot_point(float t) {
  constexpr float kRing = 0.88f, kWind = 0.40f, kTurn = 6.2831853f;
  const Vec2f a = turn(2.0f * t), c = turn(3.0f * t);
  const float r = kRing + kWind * c.x;
  KnotPoint k;
  k.centre = {r * a.x, 0.78f + r * a.y, kWind * c.y};
  // Derivatives by t, and the normal of the torus, which is never parallel to the knot.
  const float dr = -kWind * c.y * 3.0f * kTurn;
  const Vec3f along =
      normalize({dr * a.x - r * a.y * 2.0f * kTurn, dr * a.y + r * a.x * 2.0f * kTurn, kWind * c.x * 3.0f * kTurn});
  const Vec3f normal{c.x * a.x, c.x * a.y, c.y};
  k.out = normalize(normal - along * dot(normal, along));
  k.side = cross(along, k.out);
  return k;
}

// The relief of staggered rows of studs; their height is 1 at the centre.
float stud(float u, float v) {
  constexpr float kAround = 14, kAlong = 112;
  const float row = std::floor(v * kAlong), y = v * kAlong - row;
  const float half = row * 0.5f - std::floor(row * 0.5f);
  const float column = u * kAround + half, x = column - std::floor(column);
  const float dx = 2.0f * x - 1.0f, dy = 2.0f * y - 1.0f;
  const float inside = clamp01(1.06f - dx * dx - dy * dy);
  return inside * (2.0f - inside);
}

void knot(PartBuilder& b, std::uint64_t triangles) {
  constexpr float kRadius = 0.25f, kLength = 13.9f, kHeight = 0.035f;
  // The quads are about square.
  std::uint64_t ring = 3;
  while ((ring + 1) * (ring + 1) * 18 <= triangles) ++ring;
  const int around = static_cast<int>(ring);
  const int along = std::max(3, static_cast<int>((triangles / 2 + ring / 2) / ring));
  // A mesh that is too coarse for the studs stays smooth.
  const float height = kHeight * clamp01((static_cast<float>(along) / 112.0f - 3.0f) / 4.0f);
  float at_v = 0;
  KnotPoint k = knot_point(at_v);
  b.surface(kKnot, around, along, [&](float u, float v) {
    if (v != at_v) {
      at_v = v;
      k = knot_point(v);
    }
    const float round_u = u - std::floor(u), round_v = v - std::floor(v);
    const Vec2f c = turn(u);
    const Vec3f out = k.out * c.x + k.side * c.y, across = k.side * c.x - k.out * c.y;
    const Vec3f ahead = cross(k.out, k.side);
    const auto lift = [&](float du, float dv) {
      const float su = round_u + du, sv = round_v + dv;
      return height * stud(su - std::floor(su), sv - std::floor(sv));
    };
    constexpr float kStepU = 1.0f / 2048.0f, kStepV = 1.0f / 16384.0f;
    const float h = lift(0, 0);
    const float by_u = (lift(kStepU, 0) - lift(-kStepU, 0)) / (2.0f * kStepU * 6.2831853f * kRadius);
    const float by_v = (lift(0, kStepV) - lift(0, -kStepV)) / (2.0f * kStepV * kLength);
    const Vec3f normal = normalize(out - across * by_u - ahead * by_v);
    const float shade = mix(height > 0 ? 0.45f : 1.0f, 1.0f, clamp01(h / kHeight));
    return SurfacePoint{k.centre + out * (kRadius + h), normal, {u, v}, Vec3f{1, 1, 1} * shade};
  });
}

void add_mesh(Scene& scene, const char* name, Mesh mesh) {
  mesh.name = name;
  scene.meshes.push_back(std::move(mesh));
  Node node;
  node.name = name;
  node.mesh = static_cast<std::int32_t>(scene.meshes.size()) - 1;
  scene.nodes.push_back(std::move(node));
}

void set_materials(Materials& m) {
  m.materials.resize(kMatCount);
  for (Material& material : m.materials) {
    material.metallic = 0;
    material.roughness = 0.8f;
  }
  m.textures = {make_checker(), make_pool_tiles(), make_coping(), make_pavers(), make_grass(), make_stucco()};
  for (const Mat textured : {kFloor, kWall, kRim, kTerrace, kLawn, kGardenWall})
    m.materials[textured].base_color_texture = static_cast<std::int32_t>(textured);
  for (const Mat glazed : {kFloor, kWall}) m.materials[glazed].roughness = 0.4f;
  m.materials[kGardenWall].base_color = {0.90f, 0.66f, 0.45f, 1};
  m.materials[kBall].base_color = {0.06f, 0.38f, 0.09f, 1};
  m.materials[kBall].roughness = 0.28f;
  m.materials[kKnot].base_color = {0.10f, 0.42f, 0.26f, 1};
  m.materials[kKnot].roughness = 0.34f;
}

Scene make_scene(const char* name, std::uint64_t triangles, void (*object)(PartBuilder&, std::uint64_t)) {
  Scene scene;
  scene.name = name;
  set_materials(scene.materials);
  Mesh ground, thing;
  PartBuilder ground_builder(&ground), thing_builder(&thing);
  basin(ground_builder);
  // The papers count the object alone. Where the basin is a large part of the number, it counts too.
  const std::uint64_t around = ground_builder.triangles();
  object(thing_builder, triangles >= 12 * around ? triangles : triangles - std::min(triangles, around));
  add_mesh(scene, name, std::move(thing));
  add_mesh(scene, "basin", std::move(ground));

  WaterSpec water;
  water.has_size = water.has_depth = true;
  water.size_x = water.size_z = 2 * kHalf;
  water.depth = kDepth;
  water.absorption = {0.30f, 0.06f, 0.03f};
  water.surface.kind = SurfaceKind::kPerlin;
  water.surface.slope = 0.06f;
  water.surface.wavelength_m = 1.0f;
  water.surface.octaves = 4;
  add_water(scene, "water", {0, 0, 0}, water);
  add_sun(scene, {-0.55f, 0.75f, 0.42f}, {1.0f, 0.94f, 0.84f}, 2.6f);
  scene.background.ground = {0.20f, 0.24f, 0.10f};
  add_camera(scene, "high", {2.4f, 2.5f, 4.9f}, {0, 0.12f, -0.2f}, 0.75f);
  add_camera(scene, "grazing", {2.2f, 0.75f, 3.7f}, {-0.1f, 0.42f, 0}, 0.72f);
  add_camera(scene, "under", {2.1f, -0.85f, 2.6f}, {0, -0.02f, 0}, 1.15f);
  add_camera(scene, "surface", {1.5f, 0.08f, 3.2f}, {0, 0.30f, 0}, 0.80f);
  return scene;
}

}  // namespace

Scene make_ball(std::uint64_t triangles) { return make_scene("ball", triangles, ball); }

Scene make_knot(std::uint64_t triangles) { return make_scene("knot", triangles, knot); }

}  // namespace shoal
