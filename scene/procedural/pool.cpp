// `pool`: Liu et al.'s swimming pool (2020, figures 10 to 13), as a villa's garden. This file has the plan: which
// parts, how the triangles are shared out, materials, cameras. The parts are in pool_*.cpp.
#include <cmath>
#include <string>

#include "scene/procedural/pool_parts.h"
#include "scene/procedural/scenes.h"
#include "scene/procedural/textures.h"

namespace shoal {
namespace pool {
namespace {

// Copies of a part stand at these places.
struct Copies {
  const Vec3f* at;
  int count;
};
constexpr Vec3f kColumnsAt[] = {{-9, kDeckY, -6.1f}, {-6, kDeckY, -6.1f}, {-3, kDeckY, -6.1f}, {0, kDeckY, -6.1f},
                                {3, kDeckY, -6.1f},  {6, kDeckY, -6.1f},  {9, kDeckY, -6.1f}};
constexpr Vec3f kLoungersAt[] = {
    {-3.4f, kDeckY, -4.3f}, {-2.0f, kDeckY, -4.3f}, {2.0f, kDeckY, -4.3f}, {3.4f, kDeckY, -4.3f}};
constexpr Vec3f kParasolsAt[] = {{-2.7f, kDeckY, -4.75f}, {2.7f, kDeckY, -4.75f}};
constexpr Vec3f kPotsAt[] = {{-6.3f, kDeckY, -3.6f}, {6.3f, kDeckY, -3.6f}, {-6.3f, kDeckY, 3.6f}, {0, kDeckY, -5.2f}};
constexpr Vec3f kCypressesAt[] = {{-12.6f, -0.1f, -7.2f}, {-12.9f, -0.1f, -3.4f},  {-12.5f, -0.1f, 0.6f},
                                  {-12.8f, -0.1f, 4.4f},  {12.7f, -0.1f, -6.4f},   {12.9f, -0.1f, -1.2f},
                                  {12.6f, -0.1f, 3.8f},   {-15.5f, -0.1f, -12.5f}, {-11.5f, -0.1f, -13.5f},
                                  {11.8f, -0.1f, -13.0f}, {15.0f, -0.1f, -12.0f}};
constexpr Vec3f kOlivesAt[] = {{-17, -0.1f, -3}, {-19.5f, -0.1f, 3}, {-22, -0.1f, -9}, {-16.5f, -0.1f, 8},
                               {-27, 0, -2},     {-25, 0, 7},        {-31, 0, -13},    {-36, 0, 2},
                               {-40, 0.2f, -8},  {-9, -0.1f, -17},   {1, -0.1f, -19},  {17, -0.1f, -5},
                               {19, -0.1f, 2},   {23, -0.1f, -11}};
constexpr Vec3f kOnce[] = {{0, 0, 0}};

template <std::size_t kN>
constexpr Copies at(const Vec3f (&places)[kN]) {
  return {places, static_cast<int>(kN)};
}

// In order of importance: the first are always there, the others as soon as there are triangles to spare. The share is
// of what is to be handed out; the hills are last and take what the others leave over.
struct Part {
  const char* name;
  PartFn add;
  Copies copies;
  double share;
  bool always;
};
constexpr Part kParts[] = {{"basin", basin, at(kOnce), 20, true},
                           {"deck", deck, at(kOnce), 12, true},
                           {"steps", steps, at(kOnce), 4, true},
                           {"ball_1", ball<0>, at(kOnce), 3, true},
                           {"ring_1", ring<0>, at(kOnce), 3.5, false},
                           {"coping", coping, at(kOnce), 2, false},
                           {"ring_2", ring<1>, at(kOnce), 3.5, false},
                           {"ball_3", ball<2>, at(kOnce), 2.5, false},
                           {"column", column, at(kColumnsAt), 7, false},
                           {"arcade", arcade, at(kOnce), 4, false},
                           {"roof", roof, at(kOnce), 8, false},
                           {"house", house, at(kOnce), 2, false},
                           {"ladder", ladder, at(kOnce), 3, false},
                           {"ball_2", ball<1>, at(kOnce), 2.5, false},
                           {"ring_3", ring<2>, at(kOnce), 3, false},
                           {"ring_4", ring<3>, at(kOnce), 1.5, false},
                           {"garden_walls", garden_walls, at(kOnce), 0.5, false},
                           {"pot", pot, at(kPotsAt), 6, false},
                           {"cypress", cypress, at(kCypressesAt), 9, false},
                           {"hedges", hedges, at(kOnce), 5, false},
                           {"olive", olive, at(kOlivesAt), 5, false},
                           {"blossoms", blossoms, at(kOnce), 5, false},
                           {"parasol", parasol, at(kParasolsAt), 3, false},
                           {"lounger", lounger, at(kLoungersAt), 4, false},
                           {"ball_4", ball<3>, at(kOnce), 2, false}};
constexpr std::size_t kPartCount = std::size(kParts);
constexpr double kHillsShare = 10;

std::uint64_t count(PartFn add, int level) {
  PartBuilder b(nullptr);
  add(b, level);
  return b.triangles();
}

// The finest level that costs at most `budget`; 1 where none does.
int finest_level(PartFn add, std::uint64_t budget) {
  int lo = 1, hi = 2;
  while (hi < (1 << 26) && count(add, hi) <= budget) {
    lo = hi;
    hi *= 2;
  }
  while (hi - lo > 1) {
    const int mid = lo + (hi - lo) / 2;
    (count(add, mid) <= budget ? lo : hi) = mid;
  }
  return lo;
}

struct Plan {
  int levels[kPartCount] = {};  // 0: left out
  int hills = 1;
};

Plan make_plan(std::uint64_t triangles) {
  Plan plan;
  std::uint64_t left = triangles - std::min(triangles, count(hills, 1));
  double shares = kHillsShare;
  std::uint64_t spent_at_least = 0;
  for (std::size_t i = 0; i < kPartCount; ++i) {
    const Part& part = kParts[i];
    const std::uint64_t cost = count(part.add, 1) * static_cast<std::uint64_t>(part.copies.count);
    // A part comes when all so far can be had and half of the triangles are still free to refine them.
    if (!part.always && 2 * (spent_at_least + cost) > left) continue;
    spent_at_least += cost;
    plan.levels[i] = 1;
    shares += part.share;
  }
  // Every part spends its share of what is left, and passes on what it cannot use. The coarsest levels of the parts
  // still to come are set aside.
  std::uint64_t aside = spent_at_least;
  for (std::size_t i = 0; i < kPartCount; ++i) {
    if (plan.levels[i] == 0) continue;
    const Part& part = kParts[i];
    const auto copies = static_cast<std::uint64_t>(part.copies.count);
    aside -= count(part.add, 1) * copies;
    const std::uint64_t free = left > aside ? left - aside : 0;
    const auto share = static_cast<std::uint64_t>(static_cast<double>(left) * (part.share / shares));
    plan.levels[i] = finest_level(part.add, std::min(share, free) / copies);
    left -= std::min(left, count(part.add, plan.levels[i]) * copies);
    shares -= part.share;
  }
  plan.hills = finest_level(hills, left + count(hills, 1));
  return plan;
}

std::int32_t add_mesh(Scene& scene, const char* name, PartFn add, int level) {
  Mesh mesh;
  mesh.name = name;
  PartBuilder builder(&mesh);
  add(builder, level);
  scene.meshes.push_back(std::move(mesh));
  return static_cast<std::int32_t>(scene.meshes.size()) - 1;
}

void add_parts(Scene& scene, const Plan& plan) {
  const auto add_node = [&](std::string name, std::int32_t parent, std::int32_t mesh, Vec3f at) {
    Node node;
    node.name = std::move(name);
    node.parent = parent;
    node.mesh = mesh;
    node.world_from_local.m[0][3] = at.x;
    node.world_from_local.m[1][3] = at.y;
    node.world_from_local.m[2][3] = at.z;
    scene.nodes.push_back(std::move(node));
  };
  for (std::size_t i = 0; i < kPartCount; ++i) {
    if (plan.levels[i] == 0) continue;
    const Part& part = kParts[i];
    const std::int32_t mesh = add_mesh(scene, part.name, part.add, plan.levels[i]);
    if (part.copies.count == 1) {
      add_node(part.name, kNoIndex, mesh, part.copies.at[0]);
      continue;
    }
    const std::string name = part.name;
    const auto group = static_cast<std::int32_t>(scene.nodes.size());
    add_node(name == "cypress" ? "cypresses" : name + "s", kNoIndex, kNoIndex, {0, 0, 0});
    for (int k = 0; k < part.copies.count; ++k) {
      add_node(name + "_" + std::to_string(k + 1), group, mesh, part.copies.at[k]);
    }
  }
  add_node("backdrop", kNoIndex, add_mesh(scene, "backdrop", hills, plan.hills), {0, 0, 0});
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
  pool::add_parts(scene, pool::make_plan(std::max<std::uint64_t>(triangles, 1)));

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
