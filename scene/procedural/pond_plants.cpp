// Plants of the scene `pond`: reeds, grass, bushes and trees.
#include <cmath>

#include "scene/procedural/pond_parts.h"
#include "scene/procedural/shapes.h"

namespace shoal::pond {

void reeds(PartBuilder& b, int level) {
  const int blades = 9;
  for (int i = 0; i < blades; ++i) {
    const auto random = [i](int which) { return random_unit(i, which, 451); };
    const Vec2f c = turn(random(0)), d = turn(random(1));
    const float r = 0.28f * std::sqrt(random(2)), height = 0.95f + 0.75f * random(3);
    const Vec3f foot{c.x * r, -0.35f, c.y * r}, lean = Vec3f{d.x, 0, d.y} * (0.08f + 0.30f * random(4));
    const float l = 0.7f + 0.3f * random(5);
    blade(b, kReed, level, foot, lean, height + 0.35f, 0.045f, {l, l, l});
  }
  for (int i = 0; i < 3; ++i) {
    const auto random = [i](int which) { return random_unit(i, which, 457); };
    const Vec2f c = turn(random(0));
    const Vec3f foot = Vec3f{c.x, 0, c.y} * (0.05f + 0.16f * random(1)) + Vec3f{0, -0.35f, 0};
    const Vec3f lean{0.14f * (random(2) - 0.5f), 0, 0.14f * (random(3) - 0.5f)};
    const float height = 1.45f + 0.45f * random(4);
    const auto stem = [&](float t) { return foot + lean * (t * t) + Vec3f{0, height * t, 0}; };
    b.tube(kReed, level + 2, level, 0.009f, stem, {1, 0, 0}, false, {1, 1}, {0.8f, 0.8f, 0.6f});
    const auto head = [&](float t) { return stem(mix(0.90f, 1.0f, t)); };
    b.tube(kCattail, level + 3, 1, 0.030f, head, {1, 0, 0}, false, {1, 1});
  }
}

void grass(PartBuilder& b, int level) {
  constexpr int kTufts = 12, kBlades = 5;
  for (int i = 0; i < kTufts * level; ++i) {
    if (b.counting()) {
      for (int k = 0; k < kBlades; ++k) blade(b, kGrass, 1, {0, 0, 0}, {1, 0, 0}, 1, 1, {1, 1, 1});
      continue;
    }
    const auto random = [i](int which) { return random_unit(i, which, 461); };
    // Grass is dense at the verge and sparse farther out.
    const Vec2f d = turn(random(0));
    const float out = random(1) * random(1), r = shore_m(d) * (1.10f + 0.9f * out);
    const float x = d.x * r, z = d.y * r, size = mix(0.55f, 1.0f, random(2));
    const Vec3f root{x, ground_y(x, z) - 0.03f, z};
    const float dry = random(3);
    const Vec3f tint = mix(Vec3f{0.50f, 0.72f, 0.20f}, Vec3f{0.85f, 0.80f, 0.38f}, dry * dry);
    for (int k = 0; k < kBlades; ++k) {
      const auto vary = [&](int which) { return random_unit(i * kBlades + k, which, 467); };
      const Vec2f c = turn(vary(0));
      const Vec3f away{c.x, 0, c.y};
      const float height = size * (0.16f + 0.22f * vary(1));
      blade(b, kGrass, 1, root + away * (0.05f * vary(2)), away * (height * (0.3f + 0.6f * vary(3))), height,
            0.022f + 0.012f * vary(4), tint);
    }
  }
}

void bush(PartBuilder& b, int level) {
  leafy_ball(b, kLeaves, level + 1, {0, 0.55f, 0}, 0.85f);
  leafy_ball(b, kLeaves, level, {0.7f, 0.35f, 0.3f}, 0.60f);
  leafy_ball(b, kLeaves, level, {-0.55f, 0.30f, 0.4f}, 0.55f);
}

void tree(PartBuilder& b, int level) {
  const auto stem = [](float t) { return Vec3f{0.35f * t * t, 3.2f * t - 0.3f, 0.15f * t}; };
  b.tube(kBark, level + 3, level + 1, 0.20f, stem, {1, 0, 0}, false, {1, 3});
  leafy_ball(b, kLeaves, level + 2, {0.30f, 4.35f, 0.10f}, 1.75f);
  leafy_ball(b, kLeaves, level + 1, {-0.95f, 3.55f, 0.45f}, 1.25f);
  leafy_ball(b, kLeaves, level + 1, {1.35f, 3.65f, -0.50f}, 1.30f);
  leafy_ball(b, kLeaves, level, {0.45f, 3.30f, 1.05f}, 1.05f);
  leafy_ball(b, kLeaves, level, {0.05f, 5.45f, -0.20f}, 1.10f);
}

void pine(PartBuilder& b, int level) {
  constexpr float kHeight = 8.0f, kTiers = 5.0f;
  // A coarse tree leaves out detail that its faces cannot resolve.
  const float fine = std::min(1.0f, static_cast<float>(level) / 4.0f), depth = 0.4f * fine, droop = 0.34f * fine;
  const auto stem = [](float t) { return Vec3f{0, 1.6f * t - 0.3f, 0}; };
  b.tube(kBark, level + 3, 1, 0.17f, stem, {1, 0, 0}, false, {1, 2});
  b.surface(
      kPineLeaves, level + 4, 6 * level + 1,
      [&](float u, float v) {
        const Vec2f c = turn(1.0f - u);
        // Boughs in tiers, each drooping over the next.
        const float tiers = kTiers * v - std::floor(kTiers * v), taper = 1.0f - v;
        const float tier = droop * (tiers < 0.75f ? 0.5f - tiers / 0.75f : 4.0f * tiers - 3.5f);
        const float t = clamp01(v), closing = std::min(1.0f, 14.0f * t);
        const float bump = rough({c.x, t * kHeight * 0.6f, c.y}, 2.6f, 3, 471);
        const float r = 1.75f * closing * taper * (1.0f + tier + depth * (bump - 0.5f));
        const Vec3f p{c.x * r, 0.9f + t * (kHeight - 0.9f), c.y * r};
        return SurfacePoint{p, {0, 1, 0}, {u * 4.0f, -t * kHeight}, leaf_shade(bump + tier, 0.0f)};
      },
      Normals::kSmooth, Poles::kBoth);
}

}  // namespace shoal::pond
