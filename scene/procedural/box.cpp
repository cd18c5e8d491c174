// The scene `box`: a small basin for tests. Its few triangles lie through the water, under it, above it and behind it.
#include <cstdint>

#include "scene/procedural/mesh_builder.h"
#include "scene/procedural/scenes.h"
#include "scene/procedural/textures.h"

namespace shoal {
namespace {

enum Mat : std::uint8_t { kBasin, kRed, kYellow, kGreen, kBall, kBoard, kMatCount };
constexpr float kHalfX = 1.0f, kHalfZ = 0.7f, kDepth = 0.8f, kRim = 0.15f;

void basin(PartBuilder& b, int n) {
  const float x = kHalfX, z = kHalfZ, wall = kDepth + kRim;
  b.quad(kBasin, n, n, {-x, -kDepth, z}, {2 * x, 0, 0}, {0, 0, -2 * z}, 0.8f);
  b.quad(kBasin, n, n, {-x, -kDepth, -z}, {2 * x, 0, 0}, {0, wall, 0}, 0.8f, {0.95f, 0.95f, 0.95f});
  b.quad(kBasin, n, n, {x, -kDepth, z}, {-2 * x, 0, 0}, {0, wall, 0}, 0.8f, {0.95f, 0.95f, 0.95f});
  b.quad(kBasin, n, n, {-x, -kDepth, z}, {0, 0, -2 * z}, {0, wall, 0}, 0.8f, {0.85f, 0.85f, 0.85f});
  b.quad(kBasin, n, n, {x, -kDepth, -z}, {0, 0, 2 * z}, {0, wall, 0}, 0.8f, {0.85f, 0.85f, 0.85f});
}
void boxes(PartBuilder& b, int n) {
  b.box(kRed, n, {-0.70f, -0.35f, -0.40f}, {-0.40f, 0.25f, -0.10f}, 0.8f);
  b.box(kYellow, n, {0.35f, -0.80f, -0.45f}, {0.65f, -0.50f, -0.15f}, 0.8f);
  b.box(kGreen, n, {-0.25f, 0.20f, 0.30f}, {0.00f, 0.40f, 0.50f}, 0.8f);
}
void balls(PartBuilder& b, int n) {
  struct Ball {
    Vec3f centre;
    float radius;
  };
  for (const Ball& ball : {Ball{{0.45f, 0.02f, 0.25f}, 0.18f}, Ball{{-0.35f, -0.60f, 0.25f}, 0.20f}}) {
    b.surface(
        kBall, 2 * n + 2, n + 2,
        [&](float u, float v) {
          const Vec2f a = turn(1.0f - u), e = turn(0.5f * v - 0.25f);
          const float ring = v == 0.0f || v == 1.0f ? 0.0f : e.x;
          const Vec3f d = normalize({ring * a.x, v == 0.0f ? -1.0f : (v == 1.0f ? 1.0f : e.y), ring * a.y});
          return SurfacePoint{ball.centre + d * ball.radius, d, {u, 1.0f - v}};
        },
        Normals::kGiven, Poles::kBoth);
  }
}

// A slanting board with two sides. Its grid uses the triangles that the other parts leave over.
void board(PartBuilder& b, int quads) {
  int rows = 1;
  while ((rows + 1) * (rows + 1) * 2 <= quads) ++rows;
  b.quad(kBoard, quads / rows, rows, {-0.1f, -0.45f, -0.55f}, {0.75f, 0.65f, 0}, {0, 0, 0.22f}, 0.8f);
}

using PartFn = void (*)(PartBuilder&, int);
struct Part {
  const char* name;
  PartFn add;
  std::uint64_t percent;
};
constexpr Part kParts[] = {{"basin", basin, 30}, {"boxes", boxes, 30}, {"balls", balls, 35}, {"board", board, 100}};

// Returns the finest level within the budget.
int finest_level(PartFn add, std::uint64_t budget) {
  int level = 1;
  for (int step = 1 << 23; step > 0; step /= 2) {
    PartBuilder b(nullptr);
    add(b, level + step);
    if (b.triangles() <= budget) level += step;
  }
  return level;
}

}  // namespace

Scene make_box(std::uint64_t triangles) {
  Scene scene;
  scene.name = "box";
  scene.materials.materials.resize(kMatCount);
  for (Material& m : scene.materials.materials) {
    m.metallic = 0;
    m.roughness = 0.7f;
  }
  scene.materials.textures = {make_pool_tiles(), make_beach_ball()};
  scene.materials.materials[kBasin].base_color_texture = 0;
  scene.materials.materials[kBall].base_color_texture = 1;
  scene.materials.materials[kBoard].base_color = {0.15f, 0.30f, 0.70f, 1};
  scene.materials.materials[kBoard].double_sided = true;
  scene.materials.materials[kRed].base_color = {0.80f, 0.10f, 0.08f, 1};
  scene.materials.materials[kYellow].base_color = {0.90f, 0.62f, 0.08f, 1};
  scene.materials.materials[kGreen].base_color = {0.15f, 0.55f, 0.20f, 1};

  std::uint64_t left = triangles;
  for (const Part& part : kParts) {
    const std::uint64_t budget = std::min(left, triangles * part.percent / 100);
    Mesh mesh;
    mesh.name = part.name;
    PartBuilder builder(&mesh);
    part.add(builder, finest_level(part.add, budget));
    left -= std::min(left, builder.triangles());
    scene.meshes.push_back(std::move(mesh));
    Node node;
    node.name = part.name;
    node.mesh = static_cast<std::int32_t>(scene.meshes.size()) - 1;
    scene.nodes.push_back(std::move(node));
  }
  WaterSpec water;
  water.has_size = water.has_depth = true;
  water.size_x = 2 * kHalfX;
  water.size_z = 2 * kHalfZ;
  water.depth = kDepth;
  add_water(scene, "water", {0, 0, 0}, water);
  add_sun(scene, {0.4f, 0.8f, 0.45f}, {1.0f, 0.95f, 0.85f}, 2.6f);
  add_camera(scene, "high", {1.6f, 1.5f, 2.0f}, {0, -0.25f, 0}, 0.75f);
  add_camera(scene, "grazing", {2.2f, 0.45f, 0.9f}, {0, -0.05f, 0}, 0.70f);
  add_camera(scene, "under", {0.85f, -0.55f, 0.55f}, {-0.3f, -0.15f, -0.1f}, 1.2f);
  return scene;
}

}  // namespace shoal
