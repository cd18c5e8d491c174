// The scene `furnace`: the walls, the sky and all objects are white, and the water absorbs nothing. Every pixel of
// every method must then be white; otherwise reflection and refraction do not conserve light.
#include "scene/procedural/part_plan.h"
#include "scene/procedural/scenes.h"
#include "scene/procedural/shapes.h"

namespace shoal {
namespace {

constexpr int kWhite = 0;
constexpr float kHalf = 2.0f, kDepth = 1.5f, kTop = 1.0f;

// One wall has a window and there is no ceiling, so that rays reach the sky.
void room(PartBuilder& b, int n) {
  const float x = kHalf, wall = kDepth + kTop;
  b.quad(kWhite, n, n, {-x, -kDepth, x}, {2 * x, 0, 0}, {0, 0, -2 * x}, 1);
  b.quad(kWhite, n, n, {x, -kDepth, x}, {-2 * x, 0, 0}, {0, wall, 0}, 1);
  b.quad(kWhite, n, n, {-x, -kDepth, x}, {0, 0, -2 * x}, {0, wall, 0}, 1);
  b.quad(kWhite, n, n, {x, -kDepth, -x}, {0, 0, 2 * x}, {0, wall, 0}, 1);
  b.quad(kWhite, n, n, {-x, -kDepth, -x}, {x, 0, 0}, {0, wall, 0}, 1);
  b.quad(kWhite, n, n, {0, -kDepth, -x}, {x, 0, 0}, {0, kDepth - 0.4f, 0}, 1);
}

// Objects under the water, through its surface, and above it.
void blocks(PartBuilder& b, int n) {
  b.box(kWhite, n, {-1.2f, -1.5f, -1.0f}, {-0.6f, -0.7f, -0.4f}, 1);
  b.box(kWhite, n, {0.5f, -1.5f, -0.9f}, {0.9f, 0.5f, -0.5f}, 1);
  b.box(kWhite, n, {-0.5f, 0.3f, 0.3f}, {0.1f, 0.6f, 0.7f}, 1);
}

// The level is about the number of triangles.
void ball(PartBuilder& b, int level) {
  constexpr Vec3f kCentre{0.6f, 0.05f, 0.6f};
  int belts = 1;
  while (4 * (belts + 1) * (belts + 1) <= level) ++belts;
  b.surface(
      kWhite, std::max(3, level / (2 * belts)), belts + 1,
      [&](float u, float v) {
        const Vec3f d = normalize(sphere_direction(u, v));
        return SurfacePoint{kCentre + d * 0.4f, d, {u, 1.0f - v}};
      },
      Normals::kGiven, Poles::kBoth);
}

}  // namespace

Scene make_furnace(std::uint64_t triangles) {
  Scene scene;
  scene.name = "furnace";
  scene.materials.materials.resize(1);
  scene.materials.materials[kWhite].unlit = true;
  scene.has_background = true;
  scene.background.color = {1, 1, 1};

  const std::vector<Part> parts = {{"room", room, placed_once(), 2, true}, {"blocks", blocks, placed_once(), 2, false}};
  add_parts(scene, parts, {"ball", ball, placed_once(), 3, true}, triangles);

  WaterSpec water;
  water.has_size = water.has_depth = true;
  water.size_x = water.size_z = 2 * kHalf;
  water.depth = kDepth;
  water.absorption = {0, 0, 0};
  add_water(scene, "water", {0, 0, 0}, water);
  add_camera(scene, "above", {1.5f, 1.6f, 1.8f}, {-0.2f, -0.4f, -0.4f}, 1.0f);
  add_camera(scene, "under", {1.3f, -0.9f, 1.5f}, {-0.3f, -0.2f, -0.6f}, 1.3f);
  add_camera(scene, "wall", {-1.4f, 0.12f, 1.2f}, {0.9f, -0.15f, -2.0f}, 1.0f);
  return scene;
}

}  // namespace shoal
