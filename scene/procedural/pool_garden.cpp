// Plants of the scene `pool`: pots, hedges, cypresses, and the hills behind.
#include <cmath>

#include "scene/procedural/pool_parts.h"
#include "scene/procedural/shapes.h"
#include "scene/procedural/textures.h"

namespace shoal::pool {
void pot(PartBuilder& b, int level) {
  const auto profile = [](float t) {
    if (t >= 1.0f) return Vec2f{0.0f, 0.52f};  // the soil
    if (t > 0.85f) return Vec2f{mix(0.27f, 0.24f, (t - 0.85f) / 0.15f), mix(0.58f, 0.52f, (t - 0.85f) / 0.15f)};
    if (t > 0.6f) return Vec2f{0.31f, mix(0.50f, 0.58f, (t - 0.6f) / 0.25f)};
    return Vec2f{mix(0.19f, 0.285f, t / 0.6f), mix(0.0f, 0.50f, t / 0.6f)};
  };
  b.lathe(kTerracotta, level + 4, level < 3 ? 2 : 4 * level, {0, 0, 0}, profile, Poles::kV1, {1, 1});
  leafy_ball(b, kFoliage, level + 1, {0, 0.92f, 0}, 0.44f);
}

void hedges(PartBuilder& b, int level) {
  // Clipped boxes beyond the garden walls: a vault over u, from one foot to the other, along the wall.
  for (const float side : {-1.0f, 1.0f}) {
    const Vec3f foot{side * 11.2f, -0.2f, -8.6f};
    b.surface(
        kFoliage, 2 * level + 2, 6 * level,
        [&](float u, float v) {
          // The profile is a box with round shoulders; v runs along z.
          const float across = 2.0f * clamp01(u) - 1.0f, a = std::fabs(across);
          const float outward = std::min(1.0f, std::max(-1.0f, 3.0f * across));
          const float x = (a > 0.5f ? 0.55f : 1.1f * a) * (across < 0 ? -1.0f : 1.0f);
          const float y = a > 0.5f ? 1.75f * (1.0f - smooth_step(0.5f, 1.0f, a)) : 1.75f;
          Vec3f p = foot + Vec3f{x, y, mix(0.0f, 17.6f, v)};
          const float bump = rough(p, 4.0f, 4, 211);
          p = p + Vec3f{0.22f * (bump - 0.5f) * outward, 0.30f * (bump - 0.5f) * (1.0f - 0.7f * a), 0};
          return SurfacePoint{p, {0, 1, 0}, {across * 2.2f, v * 17.6f}, leaf_shade(bump, a < 0.5f ? 0.5f : -0.5f)};
        },
        Normals::kSmooth);
  }
}

void cypress(PartBuilder& b, int level) {
  constexpr float kHeight = 7.4f, kWidth = 0.78f;
  b.surface(
      kCypress, level + 4, 3 * level + 2,
      [&](float u, float v) {
        const Vec2f c = turn(1.0f - u);
        // A flame: full at a third of its height.
        const float t = v, body = std::sqrt(std::max(0.0f, t * (1.0f - t))) * (1.45f - 0.75f * t) * 1.6f;
        const Vec3f on{c.x * kWidth * body, t * kHeight, c.y * kWidth * body};
        const float bump = rough({c.x, t * kHeight * 0.7f, c.y}, 2.6f, 4, 221);
        const Vec3f p{on.x * (0.70f + 0.6f * bump), on.y, on.z * (0.70f + 0.6f * bump)};
        return SurfacePoint{p, {0, 1, 0}, {u * 4.0f, -t * kHeight}, leaf_shade(bump, 0.0f)};
      },
      Normals::kSmooth, Poles::kBoth);
}

void olive(PartBuilder& b, int level) {
  const auto stem = [](float t) { return Vec3f{0.25f * t * t, 1.7f * t, 0.12f * t}; };
  b.tube(kWood, level + 2, 2, 0.13f, stem, {1, 0, 0}, false, {1, 1}, {0.6f, 0.6f, 0.6f});
  leafy_ball(b, kOlive, level + 1, {0.25f, 2.55f, 0.1f}, 1.25f);
  leafy_ball(b, kOlive, level, {-0.65f, 2.15f, 0.35f}, 0.85f);
  leafy_ball(b, kOlive, level, {0.75f, 2.2f, -0.55f}, 0.90f);
}

void blossoms(PartBuilder& b, int level) {
  // Bougainvillea: up the house's corner and along its cornice, and over the garden wall. Tufts strewn along lines.
  struct Vine {
    Vec3f from, to;
    int tufts;
    float spread, radius;
  };
  static constexpr Vine kVines[] = {{{-9.25f, 0.2f, -5.75f}, {-9.2f, 3.6f, -5.72f}, 22, 0.24f, 0.24f},
                                    {{-9.3f, 3.6f, -5.7f}, {-7.6f, 4.3f, -5.72f}, 20, 0.38f, 0.30f},
                                    {{-7.6f, 4.3f, -5.72f}, {-5.4f, 4.4f, -5.74f}, 12, 0.14f, 0.20f},
                                    {{-10.1f, 1.05f, -3.0f}, {-10.0f, 1.05f, -0.6f}, 16, 0.20f, 0.26f},
                                    {{-9.93f, 0.5f, -2.1f}, {-9.93f, 0.8f, -1.3f}, 7, 0.16f, 0.20f},
                                    {{9.2f, 2.4f, -5.72f}, {8.6f, 4.25f, -5.7f}, 16, 0.28f, 0.28f}};
  int n = 0;
  for (const Vine& vine : kVines) {
    for (int k = 0; k < vine.tufts; ++k, ++n) {
      const auto random = [n](std::uint32_t which) { return random_unit(n, 0, 240 + which); };
      const float along = (static_cast<float>(k) + random(0)) / static_cast<float>(vine.tufts);
      const Vec3f aside{random(1) - 0.5f, random(2) - 0.5f, 0.6f * (random(3) - 0.5f)};
      const Vec3f at = mix(vine.from, vine.to, along) + aside * (2.0f * vine.spread);
      leafy_ball(b, k % 4 == 1 ? kFoliage : kBlossom, level, at, vine.radius * (0.6f + 0.7f * random(4)));
    }
  }
}

void garden_walls(PartBuilder& b, int level) {
  for (const float side : {-1.0f, 1.0f}) {
    const float x0 = std::min(side * kDeckX, side * (kDeckX + 0.3f)), x1 = x0 + 0.3f;
    b.box(kGardenWall, level, {x0, -0.4f, kDeckBack}, {x1, 0.95f, kDeckFront}, 3.0f);
    if (level > 1) b.box(kCoping, 1, {x0 - 0.05f, 0.95f, kDeckBack}, {x1 + 0.05f, 1.02f, kDeckFront + 0.05f}, 0.6f);
  }
}

void hills(PartBuilder& b, int level) {
  constexpr float kNear = 6.8f, kFar = 420.0f;
  const int rings = std::max(1, static_cast<int>(std::sqrt(static_cast<float>(level) * 0.18f)));
  const int around = std::max(4, level / rings);
  b.surface(
      kGrass, around, rings,
      [&](float u, float v) {
        const Vec2f c = turn(u);
        // Rings grow with their distance: about as many for the garden as for the horizon.
        const float w = v * v, r = kNear + (kFar - kNear) * (0.10f * v + 0.90f * w * w);
        const Vec3f flat{c.x * r, 0, c.y * r};
        const float ridge = fractal_noise(flat.x * 0.012f + 40.0f, flat.z * 0.012f + 40.0f, 0, 5, 231);
        const float knoll = fractal_noise(flat.x * 0.05f + 9.0f, flat.z * 0.05f + 9.0f, 0, 3, 232);
        // Higher behind the house than towards the viewer's side.
        const float behind = 0.55f + 0.45f * smooth_step(0.6f, -0.8f, c.y);
        const float rise = smooth_step(22.0f, 190.0f, r), far_rise = smooth_step(150.0f, kFar, r);
        const float y = -0.06f + behind * rise * (4.0f + 30.0f * ridge * ridge) + behind * far_rise * 48.0f * ridge +
                        1.2f * (knoll - 0.5f) * smooth_step(16.0f, 40.0f, r);
        // Lawn, then dry hills, then blue with the air between.
        const Vec3f lawn{0.21f, 0.31f, 0.075f}, dry{0.52f, 0.43f, 0.18f}, wood{0.12f, 0.19f, 0.06f};
        Vec3f tint = mix(lawn, mix(dry, wood, smooth_step(0.42f, 0.60f, knoll)), smooth_step(20.0f, 60.0f, r));
        tint = mix(tint, {0.30f, 0.44f, 0.68f}, 0.80f * smooth_step(90.0f, 400.0f, r));
        return SurfacePoint{{flat.x, y, flat.z}, {0, 1, 0}, {flat.x / 4.0f, flat.z / 4.0f}, tint};
      },
      Normals::kSmooth);
}

}  // namespace shoal::pool
