// Objects of the scene `pond`: pots, arrows, rocks and the jetty.
#include <cmath>
#include <iterator>

#include "scene/procedural/pond_parts.h"
#include "scene/procedural/shapes.h"

namespace shoal::pond {
namespace {

// From the middle of its foot, over belly, neck and lip, to the middle of its inside: share of the way, radius, height.
struct Girth {
  float t, radius, height;
};
constexpr Girth kProfile[] = {
    {0.00f, 0.000f, 0.000f}, {0.08f, 0.125f, 0.000f}, {0.20f, 0.212f, 0.105f}, {0.27f, 0.238f, 0.175f},
    {0.33f, 0.245f, 0.235f}, {0.39f, 0.236f, 0.295f}, {0.45f, 0.205f, 0.350f}, {0.50f, 0.160f, 0.390f},
    {0.55f, 0.130f, 0.420f}, {0.60f, 0.135f, 0.450f}, {0.67f, 0.170f, 0.483f}, {0.71f, 0.166f, 0.505f},
    {0.75f, 0.148f, 0.503f}, {0.82f, 0.108f, 0.420f}, {0.90f, 0.170f, 0.280f}, {1.00f, 0.000f, 0.080f}};

Vec2f pot_profile(float t) {
  for (std::size_t i = 1; i < std::size(kProfile); ++i) {
    const Girth &a = kProfile[i - 1], &b = kProfile[i];
    if (t <= b.t) {
      const float s = clamp01((t - a.t) / (b.t - a.t));
      return {mix(a.radius, b.radius, s), mix(a.height, b.height, s)};
    }
  }
  return {0.0f, 0.08f};
}

void pot(PartBuilder& b, int material, int level) {
  turned_solid(b, material, 2 * level + 3, level < 3 ? level + 2 : 2 * level, pot_profile, [](float t) {
    return Vec3f{1, 1, 1} * (t > 0.75f ? mix(0.75f, 0.25f, (t - 0.75f) / 0.25f) : mix(0.7f, 1.0f, clamp01(t * 4.0f)));
  });
}

// A broad head that tapers to its point.
Vec2f arrow_head(float t) {
  constexpr float kWidest = 0.67f;
  const float back = clamp01((t - kWidest) / (1.0f - kWidest));
  return {t < kWidest ? 0.05f * t / kWidest : 0.05f * (1.0f - back), 0.13f * std::min(1.0f, t / kWidest) - 0.09f};
}

}  // namespace

void blue_pot(PartBuilder& b, int level) { pot(b, kBluePot, level); }
void green_pot(PartBuilder& b, int level) { pot(b, kGreenPot, level); }

void arrow(PartBuilder& b, int level) {
  constexpr float kLength = 0.95f;
  b.tube(kShaft, level + 2, 1, 0.0125f,
         [](float t) {
           return Vec3f{0, mix(0.02f, kLength, t), 0};
         },
         {1, 0, 0}, false, {1, 4});
  turned_solid(b, kHead, level + 2, 3, arrow_head, [](float) { return Vec3f{1, 1, 1}; });
  for (int i = 0; i < 3; ++i) {
    const Vec2f c = turn(static_cast<float>(i) / 3.0f);
    const Vec3f out{c.x, 0, c.y}, side{-c.y, 0, c.x};
    b.surface(kFletching, 1, level, [&](float u, float v) {
      const float wide = 0.012f + 0.05f * u * (1.0f - 0.45f * v);
      const Vec3f p = out * wide + Vec3f{0, kLength - 0.27f + 0.24f * v - 0.05f * u, 0};
      return SurfacePoint{p, side, {u, v}, i == 0 ? Vec3f{1.0f, 0.85f, 0.25f} : Vec3f{1, 1, 1}};
    });
  }
}

void boulder(PartBuilder& b, int level) { rock(b, kRock, level, {0, 0, 0}, {0.5f, 0.38f, 0.45f}, 1.0f, 411); }
void slab(PartBuilder& b, int level) { rock(b, kRock, level, {0, 0, 0}, {0.6f, 0.26f, 0.48f}, 1.0f, 431); }

void jetty(PartBuilder& b, int level) {
  // From the bank at -x out over the water.
  constexpr float kFrom = -12.2f, kTo = -5.4f, kMiddle = -1.6f, kHalf = 0.65f, kDeck = 0.42f;
  constexpr int kPlanks = 34, kPosts = 5;
  if (level < 2) {
    b.box(kPlank, 1, {kFrom, kDeck - 0.05f, kMiddle - kHalf}, {kTo, kDeck, kMiddle + kHalf}, 1.2f);
  } else {
    for (int i = 0; i < kPlanks; ++i) {
      const float pitch = (kTo - kFrom) / static_cast<float>(kPlanks), x = kFrom + pitch * static_cast<float>(i);
      const float shift = 0.05f * (random_unit(i, 0, 441) - 0.5f), l = 0.75f + 0.25f * random_unit(i, 1, 441);
      b.box(kPlank, std::max(1, level / 6), {x + 0.012f, kDeck - 0.045f, kMiddle - kHalf + shift},
            {x + pitch - 0.012f, kDeck, kMiddle + kHalf + shift}, 1.2f, {l, l, l});
    }
  }
  for (const float side : {-1.0f, 1.0f}) {
    const float z = kMiddle + side * (kHalf - 0.14f);
    b.box(kPlank, 1, {kFrom, kDeck - 0.16f, z - 0.04f}, {kTo, kDeck - 0.05f, z + 0.04f}, 1.2f, {0.6f, 0.6f, 0.6f});
    for (int i = 0; i < kPosts; ++i) {
      const float x = mix(kFrom + 1.2f, kTo - 0.15f, static_cast<float>(i) / static_cast<float>(kPosts - 1));
      const float at = kMiddle + side * (kHalf + 0.07f), foot = ground_y(x, at) - 0.3f;
      b.tube(kPlank, level + 3, level, 0.075f,
             [&](float t) {
               return Vec3f{x, mix(foot, kDeck + 0.28f, t), at};
             },
             {1, 0, 0}, false, {1, 2}, {0.75f, 0.72f, 0.68f});
    }
  }
}

}  // namespace shoal::pond
