// The scene `pond`: a procedural version of the pond in Steel's demonstration of refraction (2024), a bowl in a meadow
// with 128 pots of two colours and arrows. This file selects and places the parts, materials and cameras; pond_*.cpp
// define the parts.
#include <cmath>

#include "scene/procedural/pond_parts.h"
#include "scene/procedural/scenes.h"
#include "scene/procedural/shapes.h"
#include "scene/procedural/textures.h"

namespace shoal {
namespace pond {
namespace {

constexpr int kPots = 128;

// Distributes pots over the bed by the golden angle with small offsets. Every seventh has fallen over.
std::vector<Mat4> pots_at(int colour) {
  std::vector<Mat4> places;
  for (int i = colour; i < kPots; i += 2) {
    const auto random = [i](int which) { return random_unit(i, which, 481); };
    const Vec2f d = turn(static_cast<float>(i) * 0.38196601f);
    const float r = shore_m(d) * 0.97f * std::sqrt((static_cast<float>(i) + 0.5f) / static_cast<float>(kPots));
    const float x = d.x * r + 0.5f * (random(0) - 0.5f), z = d.y * r + 0.5f * (random(1) - 0.5f);
    const float size = 0.85f + 0.45f * random(2);
    const bool fallen = i % 7 == 3;
    const float tipped = fallen ? 0.22f + 0.04f * random(3) : 0.03f * (random(3) - 0.5f);
    const Vec3f at{x, ground_y(x, z) + size * (fallen ? 0.20f : -0.02f), z};
    places.push_back(placed(at, random(4), size, tipped));
  }
  return places;
}

std::vector<Mat4> arrows_at() {
  std::vector<Mat4> places;
  for (int i = 0; i < 56; ++i) {
    const auto random = [i](int which) { return random_unit(i, which, 491); };
    const Vec2f d = turn(random(0));
    const float r = shore_m(d) * std::sqrt(random(1)) * 1.02f, x = d.x * r, z = d.y * r;
    places.push_back(placed({x, ground_y(x, z) - 0.10f, z}, random(2), 1.0f, 0.02f + 0.11f * random(3)));
  }
  return places;
}

// Places rocks along the shore and a few in the water.
std::vector<Mat4> rocks_at(int count, std::uint32_t seed, float least, float most) {
  std::vector<Mat4> places;
  for (int i = 0; i < count; ++i) {
    const auto random = [i, seed](int which) { return random_unit(i, which, seed); };
    // Rocks are in groups of three.
    const Vec2f d = turn(random_unit(i / 3, 0, seed + 5) + 0.035f * (random(0) - 0.5f));
    const float r = shore_m(d) * mix(0.80f, 1.13f, random(1)), x = d.x * r, z = d.y * r,
                size = mix(least, most, random(2) * random(2));
    places.push_back(placed({x, ground_y(x, z) + 0.08f * size, z}, random(3), size, 0.06f * (random(4) - 0.5f)));
  }
  return places;
}

std::vector<Mat4> reeds_at() {
  std::vector<Mat4> places;
  for (int i = 0; i < 34; ++i) {
    const auto random = [i](int which) { return random_unit(i, which, 501); };
    // Reeds grow in beds on the far side and to its left and right.
    constexpr float kBeds[5] = {0.57f, 0.66f, 0.80f, 0.93f, 0.40f};
    const Vec2f d = turn(kBeds[i % 5] + 0.05f * (random(0) - 0.5f));
    const float r = shore_m(d) * mix(0.88f, 1.02f, random(1)), x = d.x * r, z = d.y * r;
    places.push_back(placed({x, ground_y(x, z) + 0.30f, z}, random(2), mix(0.8f, 1.15f, random(3))));
  }
  return places;
}

// Places plants in a ring around the pond, except towards the cameras.
std::vector<Mat4> ring_at(int count, std::uint32_t seed, float near, float far, float least, float most) {
  std::vector<Mat4> places;
  for (int i = 0; i < count; ++i) {
    const auto random = [i, seed](int which) { return random_unit(i, which, seed); };
    const float share = (static_cast<float>(i) + 0.8f * random(0)) / static_cast<float>(count);
    const Vec2f d = turn(0.46f + 0.58f * share);
    const float r = mix(near, far, random(1)), x = d.x * r, z = d.y * r;
    places.push_back(placed({x, ground_y(x, z) - 0.1f, z}, random(2), mix(least, most, random(3))));
  }
  return places;
}

std::vector<Part> make_parts(std::uint64_t triangles) {
  const std::vector<Mat4> once = placed_once();
  return {{"blue_pot", blue_pot, pots_at(0), 17, triangles >= 4500},
          {"green_pot", green_pot, pots_at(1), 17, triangles >= 4500},
          {"boulder", boulder, rocks_at(27, 511, 0.5f, 2.0f), 7, false},
          {"slab", slab, rocks_at(21, 521, 0.4f, 1.5f), 5, false},
          {"jetty", jetty, once, 2, false},
          {"tree", tree, ring_at(13, 531, 21.0f, 46.0f, 0.9f, 1.5f), 5, false},
          {"arrow", arrow, arrows_at(), 4, false},
          {"bush", bush, ring_at(15, 541, 14.5f, 24.0f, 0.7f, 1.3f), 3, false, "bushes"},
          {"pine", pine, ring_at(17, 551, 26.0f, 70.0f, 0.9f, 1.6f), 5, false},
          {"reed", reeds, reeds_at(), 7, false},
          {"grass", grass, once, 11, false}};
}

Materials make_materials() {
  Materials m;
  m.materials.resize(kMatCount);
  for (Material& material : m.materials) {
    material.metallic = 0;
    material.roughness = 0.9f;
  }
  const auto textured = [&](Mat which, Texture texture) {
    m.materials[which].base_color_texture = static_cast<std::int32_t>(m.textures.size());
    m.textures.push_back(std::move(texture));
  };
  const auto tint = [&](Mat which, float r, float g, float b) { m.materials[which].base_color = {r, g, b, 1}; };
  textured(kDirt, make_dirt());
  textured(kVerge, make_verge());
  textured(kMeadow, make_grass());
  textured(kRock, make_rock());
  textured(kBluePot, make_blue_glaze());
  textured(kGreenPot, make_green_glaze());
  textured(kLeaves, make_foliage());
  m.materials[kPineLeaves].base_color_texture = m.materials[kLeaves].base_color_texture;
  textured(kPlank, make_planks());
  m.materials[kBark].base_color_texture = m.materials[kRock].base_color_texture;
  tint(kShaft, 0.52f, 0.36f, 0.18f);
  tint(kHead, 0.30f, 0.31f, 0.33f);
  tint(kFletching, 0.85f, 0.12f, 0.08f);
  tint(kReed, 0.28f, 0.40f, 0.10f);
  tint(kCattail, 0.20f, 0.09f, 0.035f);
  tint(kGrass, 0.52f, 0.62f, 0.30f);
  tint(kLeaves, 0.20f, 0.36f, 0.09f);
  tint(kPineLeaves, 0.10f, 0.22f, 0.09f);
  tint(kBark, 0.36f, 0.27f, 0.20f);
  tint(kPlank, 0.72f, 0.68f, 0.62f);
  for (const Mat thin : {kFletching, kReed, kGrass}) m.materials[thin].double_sided = true;
  for (const Mat glazed : {kBluePot, kGreenPot}) m.materials[glazed].roughness = 0.35f;
  return m;
}

}  // namespace
}  // namespace pond

Scene make_pond(std::uint64_t triangles) {
  Scene scene;
  scene.name = "pond";
  scene.materials = pond::make_materials();
  add_parts(scene, pond::make_parts(triangles), {"terrain", pond::terrain, placed_once(), 20, true}, triangles);

  WaterSpec water;
  water.has_size = water.has_depth = true;
  water.size_x = 2 * pond::kWaterHalfX;
  water.size_z = 2 * pond::kWaterHalfZ;
  water.depth = -pond::kLowest;
  water.absorption = {0.24f, 0.07f, 0.08f};
  water.surface.kind = SurfaceKind::kGradientWaves;
  water.surface.slope = 0.03f;
  add_water(scene, "water", {0, 0, 0}, water);
  add_sun(scene, {-0.62f, 0.66f, 0.30f}, {1.0f, 0.92f, 0.78f}, 2.6f);
  scene.background.zenith = {0.15f, 0.33f, 0.70f};
  scene.background.horizon = {0.70f, 0.81f, 0.92f};
  scene.background.ground = {0.22f, 0.24f, 0.12f};
  add_camera(scene, "high", {6.4f, 4.3f, 10.8f}, {-0.9f, 0.15f, -0.8f}, 0.84f);
  add_camera(scene, "grazing", {5.2f, 0.95f, 7.4f}, {-1.4f, 0.15f, -1.5f}, 0.80f);
  add_camera(scene, "under", {2.0f, -0.62f, 4.3f}, {-0.6f, -0.70f, -0.4f}, 1.20f);
  add_camera(scene, "surface", {4.2f, 0.10f, 4.2f}, {-2.0f, 0.12f, -1.5f}, 0.85f);
  return scene;
}

}  // namespace shoal
