// The scene `pool`: a swimming pool after Liu et al. (2020, figures 10 to 13) in a villa's garden. This file selects
// the parts, materials and cameras; pool_*.cpp define the parts.
#include "scene/procedural/pool_parts.h"
#include "scene/procedural/scenes.h"
#include "scene/procedural/textures.h"

namespace shoal {
namespace pool {
namespace {

// The parts in order of importance. The first are always included, the others where enough triangles remain.
std::vector<Part> make_parts() {
  const std::vector<Mat4> once = placed_once();
  const std::vector<Mat4> columns = places_at({{-9, kDeckY, -6.1f},
                                               {-6, kDeckY, -6.1f},
                                               {-3, kDeckY, -6.1f},
                                               {0, kDeckY, -6.1f},
                                               {3, kDeckY, -6.1f},
                                               {6, kDeckY, -6.1f},
                                               {9, kDeckY, -6.1f}});
  const std::vector<Mat4> loungers =
      places_at({{-3.4f, kDeckY, -4.3f}, {-2.0f, kDeckY, -4.3f}, {2.0f, kDeckY, -4.3f}, {3.4f, kDeckY, -4.3f}});
  const std::vector<Mat4> parasols = places_at({{-2.7f, kDeckY, -4.75f}, {2.7f, kDeckY, -4.75f}});
  const std::vector<Mat4> pots =
      places_at({{-6.3f, kDeckY, -3.6f}, {6.3f, kDeckY, -3.6f}, {-6.3f, kDeckY, 3.6f}, {0, kDeckY, -5.2f}});
  const std::vector<Mat4> cypresses = places_at({{-12.6f, -0.1f, -7.2f},
                                                 {-12.9f, -0.1f, -3.4f},
                                                 {-12.5f, -0.1f, 0.6f},
                                                 {-12.8f, -0.1f, 4.4f},
                                                 {12.7f, -0.1f, -6.4f},
                                                 {12.9f, -0.1f, -1.2f},
                                                 {12.6f, -0.1f, 3.8f},
                                                 {-15.5f, -0.1f, -12.5f},
                                                 {-11.5f, -0.1f, -13.5f},
                                                 {11.8f, -0.1f, -13.0f},
                                                 {15.0f, -0.1f, -12.0f}});
  const std::vector<Mat4> olives = places_at({{-17, -0.1f, -3},
                                              {-19.5f, -0.1f, 3},
                                              {-22, -0.1f, -9},
                                              {-16.5f, -0.1f, 8},
                                              {-27, 0, -2},
                                              {-25, 0, 7},
                                              {-31, 0, -13},
                                              {-36, 0, 2},
                                              {-40, 0.2f, -8},
                                              {-9, -0.1f, -17},
                                              {1, -0.1f, -19},
                                              {17, -0.1f, -5},
                                              {19, -0.1f, 2},
                                              {23, -0.1f, -11}});
  return {{"basin", basin, once, 20, true},
          {"deck", deck, once, 12, true},
          {"steps", steps, once, 4, true},
          {"ball_1", ball<0>, once, 3, true},
          {"ring_1", ring<0>, once, 3.5, false},
          {"coping", coping, once, 2, false},
          {"ring_2", ring<1>, once, 3.5, false},
          {"ball_3", ball<2>, once, 2.5, false},
          {"column", column, columns, 7, false},
          {"arcade", arcade, once, 4, false},
          {"roof", roof, once, 8, false},
          {"house", house, once, 2, false},
          {"ladder", ladder, once, 3, false},
          {"ball_2", ball<1>, once, 2.5, false},
          {"ring_3", ring<2>, once, 3, false},
          {"ring_4", ring<3>, once, 1.5, false},
          {"garden_walls", garden_walls, once, 0.5, false},
          {"pot", pot, pots, 6, false},
          {"cypress", cypress, cypresses, 9, false, "cypresses"},
          {"hedges", hedges, once, 5, false},
          {"olive", olive, olives, 5, false},
          {"blossoms", blossoms, once, 5, false},
          {"parasol", parasol, parasols, 3, false},
          {"lounger", lounger, loungers, 4, false},
          {"ball_4", ball<3>, once, 2, false}};
}

}  // namespace

Materials make_materials() {
  Materials m;
  m.materials.resize(kMatCount);
  const auto textured = [&](Mat which, Texture texture) {
    m.materials[which].base_color_texture = static_cast<std::int32_t>(m.textures.size());
    m.textures.push_back(std::move(texture));
  };
  const auto same = [&](Mat which, Mat as) {
    m.materials[which].base_color_texture = m.materials[as].base_color_texture;
  };
  const auto tint = [&](Mat which, float r, float g, float b) { m.materials[which].base_color = {r, g, b, 1}; };
  for (Material& material : m.materials) {
    material.metallic = 0;
    material.roughness = 0.85f;
  }
  textured(kTiles, make_pool_tiles());
  textured(kLane, make_lane_tiles());
  textured(kBand, make_waterline_tiles());
  textured(kCoping, make_coping());
  textured(kPavers, make_pavers());
  textured(kStucco, make_stucco());
  same(kOchre, kStucco);
  textured(kRoof, make_roof_tiles());
  textured(kMarble, make_ripple_marble());
  textured(kWood, make_planks());
  same(kShutter, kStucco);
  same(kGardenWall, kStucco);
  textured(kBall, make_beach_ball());
  textured(kRing, make_ring_stripes());
  textured(kAwning, make_awning());
  textured(kFoliage, make_foliage());
  for (const Mat leaves : {kCypress, kOlive, kBlossom}) same(leaves, kFoliage);
  same(kTerracotta, kStucco);
  textured(kGrass, make_grass());
  tint(kOchre, 0.86f, 0.55f, 0.30f);
  tint(kShutter, 0.10f, 0.27f, 0.42f);
  tint(kStucco, 0.97f, 0.91f, 0.80f);
  tint(kGardenWall, 0.93f, 0.74f, 0.52f);
  tint(kGlass, 0.02f, 0.035f, 0.05f);
  tint(kChrome, 0.82f, 0.84f, 0.86f);
  tint(kDiveRing, 1.0f, 0.55f, 0.04f);
  tint(kCushion, 0.90f, 0.88f, 0.83f);
  tint(kTerracotta, 0.62f, 0.26f, 0.13f);
  tint(kFoliage, 0.24f, 0.42f, 0.10f);
  tint(kCypress, 0.12f, 0.23f, 0.085f);
  tint(kOlive, 0.36f, 0.47f, 0.20f);
  tint(kBlossom, 0.95f, 0.09f, 0.42f);
  for (const Mat glossy : {kTiles, kLane, kBand, kBall, kRing, kDiveRing}) m.materials[glossy].roughness = 0.35f;
  m.materials[kGlass].roughness = 0.15f;
  m.materials[kChrome].roughness = 0.22f;
  m.materials[kChrome].metallic = 1;
  return m;
}

}  // namespace pool

Scene make_pool(std::uint64_t triangles) {
  Scene scene;
  scene.name = "pool";
  scene.materials = pool::make_materials();
  // The hills come last and use the triangles that the others leave over.
  add_parts(scene, pool::make_parts(), {"backdrop", pool::hills, placed_once(), 10, true}, triangles);

  WaterSpec water;
  water.has_size = water.has_depth = true;
  water.size_x = 2 * pool::kHalfX;
  water.size_z = 2 * pool::kHalfZ;
  water.depth = pool::kDeep;
  water.absorption = {0.22f, 0.045f, 0.022f};
  add_water(scene, "water", {0, 0, 0}, water);

  add_sun(scene, {-0.46f, 0.72f, 0.52f}, {1.0f, 0.91f, 0.76f}, 2.55f);
  scene.background.zenith = {0.16f, 0.34f, 0.68f};
  scene.background.horizon = {0.68f, 0.80f, 0.93f};
  scene.background.ground = {0.42f, 0.36f, 0.28f};
  add_camera(scene, "high", {7.7f, 3.75f, 6.2f}, {-0.75f, 0.22f, -1.35f}, 0.80f);
  add_camera(scene, "grazing", {6.3f, 1.05f, 1.7f}, {-2.6f, 0.15f, -0.9f}, 0.80f);
  add_camera(scene, "under", {3.6f, -1.72f, 1.35f}, {-0.4f, 0.18f, -0.35f}, 1.38f);
  add_camera(scene, "surface", {4.4f, 0.09f, 1.75f}, {-2.6f, 0.32f, -1.4f}, 0.85f);
  return scene;
}

}  // namespace shoal
