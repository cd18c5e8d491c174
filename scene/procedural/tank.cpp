// The scene `tank`: an aquarium on a table, seen through its side. It has no glass: the front is a vertical plane of
// water, the top a horizontal one. It contains gravel, stones, plants, an arch and fish.
#include <cmath>
#include <cstdint>

#include "scene/procedural/part_plan.h"
#include "scene/procedural/scenes.h"
#include "scene/procedural/shapes.h"
#include "scene/procedural/textures.h"

namespace shoal {
namespace {

enum Mat : std::uint8_t {
  kBack,
  kSide,
  kFrame,
  kGravel,
  kTable,
  kRoomFloor,
  kRoomWall,
  kStone,
  kArch,
  kWeed,
  kFern,
  kClown,
  kTang,
  kTangTail,
  kFin,
  kEye,
  kMatCount
};

// The inside of the tank in metres. The top of the table is y = 0, the top of the water y = kWater.
constexpr float kHalfX = 0.90f, kHalfZ = 0.40f, kFloor = 0.06f, kWater = 0.78f, kTop = 0.90f, kPost = 0.035f;

// The height of the gravel, which rises towards the back and the sides.
float gravel_y(float x, float z) {
  const float back = smooth_step(0.35f, -0.45f, z), side = smooth_step(0.3f, 0.9f, std::fabs(x));
  return kFloor + 0.03f + 0.09f * back + 0.04f * side * back +
         0.035f * (fractal_noise(x * 5.0f, z * 5.0f, 0, 3, 301) - 0.5f);
}

void case_(PartBuilder& b, int level) {
  const int n = level;
  const float x = kHalfX, z = kHalfZ, o = kPost, tall = kTop - kFloor;
  // Inside: back and sides; the floor's edge is under the gravel.
  b.quad(kBack, 2 * n, n, {-x, kFloor, -z}, {2 * x, 0, 0}, {0, tall, 0}, 0.45f);
  b.quad(kSide, n, n, {-x, kFloor, z}, {0, 0, -2 * z}, {0, tall, 0}, 0.6f);
  b.quad(kSide, n, n, {x, kFloor, -z}, {0, 0, 2 * z}, {0, tall, 0}, 0.6f);
  // Outside, and the edges between.
  b.quad(kFrame, n, n, {-x - o, 0, -z - o}, {0, 0, 2 * z + 2 * o}, {0, kTop, 0}, 0.6f);
  b.quad(kFrame, n, n, {x + o, 0, z + o}, {0, 0, -2 * z - 2 * o}, {0, kTop, 0}, 0.6f);
  b.quad(kFrame, n, n, {x + o, 0, -z - o}, {-2 * x - 2 * o, 0, 0}, {0, kTop, 0}, 0.6f);
  for (const float side : {-1.0f, 1.0f}) {
    const float at = side < 0 ? -x - o : x;
    b.quad(kFrame, 1, n, {at, kTop, z + o}, {o, 0, 0}, {0, 0, -2 * z - 2 * o}, 0.6f);
    // Posts: their fronts, and their backs where they pass the water's front.
    b.quad(kFrame, 1, n, {at, 0, z + o}, {o, 0, 0}, {0, kTop, 0}, 0.6f);
    b.quad(kFrame, 1, n, {side * x, kFloor, side < 0 ? z + o : z}, {0, 0, side < 0 ? -o : o}, {0, tall, 0}, 0.6f);
  }
  b.quad(kFrame, 2 * n, 1, {-x, kTop, -z}, {2 * x, 0, 0}, {0, 0, -o}, 0.6f);
  // Plinth and rail along the front.
  b.quad(kFrame, 2 * n, 1, {-x, 0, z + o}, {2 * x, 0, 0}, {0, kFloor, 0}, 0.6f);
  b.quad(kFrame, 2 * n, 1, {-x, kFloor, z + o}, {2 * x, 0, 0}, {0, 0, -o}, 0.6f);
  b.box(kFrame, 1, {-x, kTop - 0.05f, z}, {x, kTop, z + o}, 0.6f);
}

void gravel(PartBuilder& b, int level) {
  constexpr float kFront = kHalfZ - 0.01f;
  const auto shade = [](float x, float z) {
    return Vec3f{1, 1, 1} * (0.65f + 0.35f * smooth_step(0.0f, 0.12f, std::min(kHalfX - std::fabs(x), z + kHalfZ)));
  };
  b.surface(
      kGravel, 2 * level, level,
      [&](float u, float v) {
        const float x = mix(-kHalfX, kHalfX, u), z = mix(kFront, -kHalfZ, v);
        return SurfacePoint{{x, gravel_y(x, z), z}, {0, 1, 0}, {x / 0.5f, z / 0.5f}, shade(x, z)};
      },
      Normals::kSmooth);
  // Its section behind the front.
  b.surface(kGravel, 2 * level, 1, [&](float u, float v) {
    const float x = mix(-kHalfX, kHalfX, u), y = mix(kFloor, gravel_y(x, kFront), v);
    return SurfacePoint{
        {x, y, kFront}, {0, 0, 1}, {x / 0.5f, (kFront + gravel_y(x, kFront) - y) / 0.5f}, shade(x, kFront)};
  });
}

void room(PartBuilder& b, int level) {
  const int n = level;
  b.box(kTable, n, {-1.6f, -0.05f, -0.75f}, {1.6f, 0.0f, 0.85f}, 1.2f);
  for (const float x : {-1.5f, 1.42f}) {
    for (const float z : {-0.68f, 0.70f}) b.box(kTable, 1, {x, -0.80f, z}, {x + 0.08f, -0.05f, z + 0.08f}, 1.2f);
  }
  // A courtyard's corner, open to the sky and towards the sun.
  constexpr float kSide_x = 4.2f, kBack_z = -1.2f, kNear_z = 7.0f, kY = -0.80f, kTall = 3.1f;
  b.quad(kRoomFloor, n, n, {-kSide_x, kY, kNear_z}, {2 * kSide_x, 0, 0}, {0, 0, kBack_z - kNear_z}, 2.4f);
  b.quad(kRoomWall, n, n, {-kSide_x, kY, kBack_z}, {2 * kSide_x, 0, 0}, {0, kTall, 0}, 3.0f);
  b.quad(kRoomWall, n, n, {-kSide_x, kY, kNear_z}, {0, 0, kBack_z - kNear_z}, {0, kTall, 0}, 3.0f);
  b.quad(kRoomWall, n, n, {kSide_x, kY, kBack_z}, {0, 0, kNear_z - kBack_z}, {0, kTall, 0}, 3.0f);
  b.box(kFrame, 1, {-kSide_x, kY, kBack_z - 0.1f}, {kSide_x, kY + 0.14f, kBack_z + 0.02f}, 0.6f);
  b.box(kFrame, 1, {-kSide_x - 0.1f, kY, kBack_z}, {0.02f - kSide_x, kY + 0.14f, kNear_z}, 0.6f);
  b.box(kFrame, 1, {kSide_x - 0.02f, kY, kBack_z}, {kSide_x + 0.1f, kY + 0.14f, kNear_z}, 0.6f);
}

void stones(PartBuilder& b, int level) {
  struct Stone {
    float x, z;
    Vec3f half;
  };
  static constexpr Stone kStones[] = {{-0.52f, -0.12f, {0.17f, 0.13f, 0.12f}}, {-0.34f, 0.03f, {0.09f, 0.07f, 0.08f}},
                                      {0.66f, -0.20f, {0.13f, 0.20f, 0.11f}},  {0.53f, 0.0f, {0.08f, 0.06f, 0.07f}},
                                      {0.06f, 0.22f, {0.06f, 0.04f, 0.05f}},   {-0.72f, 0.20f, {0.07f, 0.05f, 0.06f}},
                                      {0.76f, 0.19f, {0.09f, 0.06f, 0.07f}}};
  std::uint32_t seed = 311;
  for (const Stone& s : kStones) {
    rock(b, kStone, level, {s.x, gravel_y(s.x, s.z) + 0.45f * s.half.y, s.z}, s.half, 0.5f, seed++);
  }
}

// A ruin: two piers and a half ring of blocks.
void arch(PartBuilder& b, int level) {
  constexpr float kX = 0.16f, kZ = -0.16f, kInner = 0.12f, kOuter = 0.19f, kDeep = 0.07f, kSpring = 0.30f;
  const Vec3f front{0, 0, kDeep};
  for (const float side : {-1.0f, 1.0f}) {
    const float x0 = std::min(side * kInner, side * kOuter) + kX, x1 = x0 + kOuter - kInner;
    b.box(kArch, std::max(1, level / 2), {x0, 0.08f, kZ - kDeep}, {x1, kSpring, kZ + kDeep}, 0.5f);
    b.box(kArch, 1, {x0 - 0.012f, kSpring - 0.03f, kZ - kDeep - 0.012f}, {x1 + 0.012f, kSpring, kZ + kDeep + 0.012f},
          0.5f);
  }
  const auto at = [&](float u, float r) {
    const Vec2f c = turn(0.5f * u);
    return Vec3f{kX + r * c.x, kSpring + r * std::max(0.0f, c.y), kZ};
  };
  const int n = 2 * level + 2;
  // From the right pier over to the left: outside, inside, front, back.
  b.surface(kArch, n, 1, [&](float u, float v) {
    const Vec2f c = turn(0.5f * u);
    return SurfacePoint{at(u, kOuter) + front * (2.0f * v - 1.0f), {c.x, c.y, 0}, {u * 1.2f, v * 0.28f}};
  });
  b.surface(kArch, n, 1, [&](float u, float v) {
    const Vec2f c = turn(0.5f * u);
    return SurfacePoint{
        at(u, kInner) + front * (1.0f - 2.0f * v), {-c.x, -c.y, 0}, {u * 0.8f, v * 0.28f}, {0.7f, 0.7f, 0.7f}};
  });
  b.surface(kArch, n, 1, [&](float u, float v) {
    return SurfacePoint{at(u, mix(kOuter, kInner, v)) + front, {0, 0, 1}, {u * 1.2f, v * 0.14f}};
  });
  b.surface(kArch, n, 1, [&](float u, float v) {
    return SurfacePoint{at(u, mix(kInner, kOuter, v)) - front, {0, 0, -1}, {u * 1.2f, v * 0.14f}};
  });
}

// Curved ribbons from one root; tall ones reach the surface.
void weeds(PartBuilder& b, int level) {
  struct Clump {
    float x, z, height;
    int blades;
  };
  static constexpr Clump kClumps[] = {{-0.76f, -0.26f, 0.54f, 9}, {-0.20f, -0.30f, 0.46f, 8}, {0.42f, -0.30f, 0.52f, 8},
                                      {0.80f, -0.28f, 0.55f, 7},  {-0.62f, 0.06f, 0.24f, 7},  {0.36f, 0.12f, 0.17f, 8},
                                      {-0.12f, 0.10f, 0.13f, 7}};
  int n = 0;
  for (const Clump& k : kClumps) {
    const bool low = k.height < 0.3f;
    for (int i = 0; i < k.blades; ++i, ++n) {
      const auto random = [n](int which) { return random_unit(n, which, 331); };
      const Vec2f c = turn(random(0));
      const Vec3f foot{k.x + 0.05f * (random(1) - 0.5f), gravel_y(k.x, k.z) - 0.01f, k.z + 0.05f * (random(2) - 0.5f)};
      const float height = k.height * (0.6f + 0.5f * random(3)), lean = (low ? 0.4f : 0.22f) * height;
      Vec3f over{c.x * lean, 0, c.y * lean * 0.6f};
      // Plants stay inside the tank.
      over.z = std::max(-0.36f - foot.z, std::min(0.34f - foot.z, over.z));
      over.x = std::max(-0.86f - foot.x, std::min(0.86f - foot.x, over.x));
      const float l = 0.7f + 0.3f * random(4);
      blade(b, low ? kFern : kWeed, level + 1, foot, over, height, low ? 0.035f : 0.028f, {l, l, 0.8f * l});
    }
  }
}

// A fish of length 1 along x with its head at +x: body, tail, fins and eyes.
template <int kSkin>
void fish(PartBuilder& b, int level) {
  constexpr bool kRound = kSkin == kClown;
  constexpr float kTall = kRound ? 0.19f : 0.25f, kThick = kRound ? 0.10f : 0.07f, kBack_x = -0.36f, kFront_x = 0.5f;
  // v from the tail's root to the nose.
  const auto girth = [](float v) {
    const float bow = std::sqrt(std::max(0.0f, v * (1.0f - v))) * 2.0f;
    return bow * mix(0.62f, 1.0f, smooth_step(0.0f, 0.6f, v)) + 0.16f * (1.0f - v) * std::min(1.0f, 12.0f * v);
  };
  b.surface(
      kSkin, 2 * level + 4, 2 * level + 3,
      [&](float u, float v) {
        const Vec2f c = turn(u);
        const float g = girth(clamp01(v));
        return SurfacePoint{{mix(kBack_x, kFront_x, v), kTall * g * c.y, kThick * g * c.x}, {0, 1, 0}, {u, v}};
      },
      Normals::kSmooth, Poles::kBoth);
  const int tail = kRound ? int{kFin} : int{kTangTail};
  // Thin fins with two sides: v runs from their root outward; they are longest in the middle.
  const auto fin = [&](int material, Vec3f root0, Vec3f root1, Vec3f tip0, Vec3f tip1) {
    const Vec3f n = normalize(cross(root1 - root0, tip0 - root0));
    b.surface(material, std::max(1, level), std::max(1, level / 2), [&](float u, float v) {
      const float reach = level < 3 ? v : v * (0.62f + 1.52f * u * (1.0f - u));
      const Vec3f p = mix(mix(root0, root1, u), mix(tip0, tip1, u), reach);
      return SurfacePoint{p, n, {u, v}, Vec3f{1, 1, 1} * mix(0.75f, 1.0f, v)};
    });
  };
  fin(tail, {-0.33f, -0.032f, 0}, {-0.33f, 0.004f, 0}, {-0.5f, -0.17f, 0}, {-0.48f, -0.01f, 0});
  fin(tail, {-0.33f, -0.004f, 0}, {-0.33f, 0.032f, 0}, {-0.48f, 0.01f, 0}, {-0.5f, 0.17f, 0});
  fin(kFin, {0.18f, 0.8f * kTall, 0}, {-0.20f, 0.55f * kTall, 0}, {0.05f, 1.35f * kTall, 0}, {-0.27f, 1.1f * kTall, 0});
  fin(kFin, {-0.18f, -0.55f * kTall, 0}, {0.06f, -0.85f * kTall, 0}, {-0.25f, -1.1f * kTall, 0},
      {-0.04f, -1.3f * kTall, 0});
  for (const float side : {-1.0f, 1.0f}) {
    const Vec3f root{0.14f, -0.02f, side * 0.85f * kThick};
    fin(kFin, root, root + Vec3f{-0.02f, -0.06f, 0}, root + Vec3f{-0.13f, 0.01f, side * 0.07f},
        root + Vec3f{-0.12f, -0.09f, side * 0.06f});
    const Vec3f centre{0.385f, 0.032f, side * kThick * 0.60f};
    b.surface(
        kEye, level + 3, level / 2 + 2,
        [&](float u, float v) {
          const Vec3f d = normalize(sphere_direction(u, v));
          return SurfacePoint{centre + d * 0.022f, d, {u, v}};
        },
        Normals::kGiven, Poles::kBoth);
  }
}

std::vector<Part> make_parts() {
  const std::vector<Mat4> clowns = {
      placed({-0.34f, 0.50f, 0.12f}, 0.02f, 0.20f), placed({-0.10f, 0.36f, 0.20f}, 0.46f, 0.15f),
      placed({0.48f, 0.60f, -0.05f}, -0.05f, 0.16f), placed({-0.62f, 0.33f, 0.24f}, 0.05f, 0.14f)};
  const std::vector<Mat4> tangs = {placed({0.28f, 0.42f, 0.14f}, 0.55f, 0.24f),
                                   placed({0.62f, 0.36f, 0.16f}, 0.42f, 0.19f),
                                   placed({-0.05f, 0.62f, -0.12f}, 0.93f, 0.20f)};
  const std::vector<Mat4> once = placed_once();
  return {{"case", case_, once, 4, true},          {"gravel", gravel, once, 12, true},
          {"stones", stones, once, 14, false},     {"clownfish", fish<kClown>, clowns, 14, false, "clownfishes"},
          {"tang", fish<kTang>, tangs, 12, false}, {"arch", arch, once, 3, false},
          {"weeds", weeds, once, 26, false}};
}

Materials make_materials() {
  Materials m;
  m.materials.resize(kMatCount);
  for (Material& material : m.materials) {
    material.metallic = 0;
    material.roughness = 0.8f;
  }
  const auto textured = [&](Mat which, Texture texture) {
    m.materials[which].base_color_texture = static_cast<std::int32_t>(m.textures.size());
    m.textures.push_back(std::move(texture));
  };
  const auto tint = [&](Mat which, float r, float g, float b) { m.materials[which].base_color = {r, g, b, 1}; };
  textured(kBack, make_checker());
  textured(kGravel, make_gravel());
  textured(kTable, make_planks());
  textured(kRoomFloor, make_pavers());
  textured(kRoomWall, make_stucco());
  textured(kStone, make_rock());
  textured(kArch, make_ripple_marble());
  textured(kClown, make_fish_bands());
  textured(kTang, make_fish_flank());
  tint(kSide, 0.22f, 0.40f, 0.46f);
  m.materials[kFrame].base_color = {0.055f, 0.06f, 0.065f, 1};
  tint(kRoomWall, 0.62f, 0.72f, 0.74f);
  tint(kArch, 0.95f, 0.85f, 0.70f);
  tint(kWeed, 0.10f, 0.36f, 0.05f);
  tint(kFern, 0.34f, 0.42f, 0.05f);
  tint(kTangTail, 0.95f, 0.72f, 0.03f);
  tint(kFin, 0.93f, 0.40f, 0.05f);
  tint(kEye, 0.01f, 0.01f, 0.012f);
  for (const Mat thin : {kWeed, kFern, kTangTail, kFin}) m.materials[thin].double_sided = true;
  for (const Mat smooth : {kFrame, kClown, kTang}) m.materials[smooth].roughness = 0.45f;
  m.materials[kEye].roughness = 0.1f;
  return m;
}

// Adds a body of water.
//   place  its local y is the normal of the plane; local z points down where the plane is vertical
void add_tank_water(Scene& scene, const char* name, const Mat4& place, float size_z, float depth) {
  WaterSpec water;
  water.has_size = water.has_depth = true;
  water.size_x = 2 * kHalfX;
  water.size_z = size_z;
  water.depth = depth;
  water.absorption = {0.55f, 0.12f, 0.09f};
  add_water(scene, name, {0, 0, 0}, water);
  scene.nodes.back().world_from_local = place;
}

}  // namespace

Scene make_tank(std::uint64_t triangles) {
  Scene scene;
  scene.name = "tank";
  scene.materials = make_materials();
  add_parts(scene, make_parts(), {"room", room, placed_once(), 3, true}, triangles);

  add_tank_water(scene, "top", translation({0, kWater, 0}), 2 * kHalfZ, kWater - kFloor);
  SurfaceSettings& surface = scene.waters.back().surface;
  surface.kind = SurfaceKind::kGradientWaves;
  surface.slope = 0.02f;
  surface.wavelength_m = 0.35f;
  // The vertical plane: local y is the world's z, local z points down.
  const Mat4 front = from_rows({1, 0, 0, 0}, {0, 0, -1, 0.5f * (kFloor + kWater)}, {0, 1, 0, kHalfZ});
  add_tank_water(scene, "front", front, kWater - kFloor, 2 * kHalfZ);
  add_sun(scene, {-0.40f, 0.80f, 0.62f}, {1.0f, 0.95f, 0.86f}, 2.4f);
  // The first four cameras look down through the front, so that none of their rays reaches the top from below. `low`
  // looks up at the top and shows the tank reflected there.
  add_camera(scene, "front", {0.12f, 0.86f, 2.20f}, {0.0f, 0.40f, 0.0f}, 0.62f);
  add_camera(scene, "oblique", {1.45f, 1.18f, 1.95f}, {0.04f, 0.38f, 0.02f}, 0.62f);
  add_camera(scene, "above", {-0.55f, 1.95f, 1.15f}, {0.0f, 0.42f, 0.0f}, 0.68f);
  add_camera(scene, "grazing", {-1.04f, 0.84f, 0.70f}, {0.46f, 0.36f, 0.18f}, 0.82f);
  add_camera(scene, "under", {-0.70f, 0.40f, 0.22f}, {0.35f, 0.46f, -0.06f}, 1.10f);
  add_camera(scene, "low", {-0.60f, 0.14f, 1.85f}, {0.02f, 0.45f, 0.0f}, 0.70f);
  return scene;
}

}  // namespace shoal
