// Objects of the scene `pool`: balls, rings, ladder, loungers and parasols.
#include <cmath>

#include "scene/procedural/pool_parts.h"

namespace shoal::pool {
namespace {

struct Placed {
  Vec3f centre, axis;
  float radius, tube;
};

// Half under, barely under, on the floor, on the deck.
constexpr Placed kBalls[] = {{{-0.9f, 0.05f, 0.75f}, {0.45f, 0.80f, 0.40f}, 0.27f, 0},
                             {{2.1f, 0.09f, -1.15f}, {-0.70f, 0.50f, 0.35f}, 0.22f, 0},
                             {{0.85f, 0, 0.95f}, {0.30f, 0.50f, 0.80f}, 0.21f, 0},
                             {{-3.1f, 0.37f, 3.5f}, {0.60f, 0.70f, -0.30f}, 0.27f, 0}};
// Afloat, tilted half under, sunk, and a small one to dive for.
constexpr Placed kRings[] = {{{-2.35f, 0.025f, -0.75f}, {0.05f, 1.0f, 0.03f}, 0.42f, 0.125f},
                             {{2.7f, -0.02f, 0.95f}, {0.72f, 0.62f, 0.35f}, 0.40f, 0.115f},
                             {{-0.35f, 0, -1.0f}, {-0.10f, 1.0f, 0.0f}, 0.38f, 0.10f},
                             {{2.6f, 0, -0.55f}, {-0.10f, 1.0f, 0.0f}, 0.17f, 0.03f}};

struct Frame {
  Vec3f x, y, z;
};
Frame frame_about(Vec3f axis) {
  const Vec3f y = normalize(axis), x = normalize(cross(y, Vec3f{0.2f, 0.1f, 1.0f}));
  return {x, y, cross(x, y)};
}

// On the floor where no height is given: darker towards the ground it lies on.
Vec3f rest(const Placed& p, float half_height) {
  return p.centre.y == 0 ? Vec3f{p.centre.x, floor_y(p.centre.x) + half_height, p.centre.z} : p.centre;
}
Vec3f under_shade(Vec3f normal) { return Vec3f{1, 1, 1} * (0.80f + 0.20f * clamp01(0.5f + 0.8f * normal.y)); }

// A box with rounded edges, from a sphere's grid pulled apart along the axes.
void rounded_box(PartBuilder& b, int material, int n, Vec3f centre, Vec3f half, float r, const Frame& f, Vec3f tint) {
  const int around = 4 * n, up = 2 * n + 1;
  const Vec3f core{half.x - r, half.y - r, half.z - r};
  const auto pull = [](float d, float by) { return std::fabs(d) < 1e-4f ? 0.0f : (d > 0 ? by : -by); };
  b.surface(
      material, around, up,
      [&](float u, float v) {
        const Vec2f a = turn(0.5f / static_cast<float>(around) - u), e = turn(0.5f * v - 0.25f);
        const bool pole = v == 0.0f || v == 1.0f;
        const float ring = pole ? 0.0f : e.x;
        const Vec3f d{ring * a.x, pole ? (v == 0.0f ? -1.0f : 1.0f) : e.y, ring * a.y};
        const Vec3f p{d.x * r + pull(d.x, core.x), d.y * r + pull(d.y, core.y), d.z * r + pull(d.z, core.z)};
        const Vec3f n_world = f.x * d.x + f.y * d.y + f.z * d.z;
        return SurfacePoint{centre + f.x * p.x + f.y * p.y + f.z * p.z,
                            normalize(n_world),
                            {p.x / 1.2f, p.z / 1.2f},
                            tint * (0.75f + 0.25f * clamp01(0.5f + 0.8f * n_world.y))};
      },
      Normals::kGiven, Poles::kBoth);
}

constexpr Frame kUpright{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

}  // namespace

template <int kWhich>
void ball(PartBuilder& b, int level) {
  const Placed& p = kBalls[kWhich];
  const Frame f = frame_about(p.axis);
  const Vec3f centre = rest(p, p.radius);
  b.surface(
      kBall, 2 * level + 2, level + 2,
      [&](float u, float v) {
        const Vec2f a = turn(1.0f - u), e = turn(0.5f * v - 0.25f);
        const bool pole = v == 0.0f || v == 1.0f;
        const float ring = pole ? 0.0f : e.x;
        const Vec3f n =
            normalize(f.x * (ring * a.x) + f.y * (pole ? (v == 0.0f ? -1.0f : 1.0f) : e.y) + f.z * (ring * a.y));
        return SurfacePoint{centre + n * p.radius, n, {u, 1.0f - v}, under_shade(n)};
      },
      Normals::kGiven, Poles::kBoth);
}

template <int kWhich>
void ring(PartBuilder& b, int level) {
  const Placed& p = kRings[kWhich];
  const Frame f = frame_about(p.axis);
  const Vec3f centre = rest(p, p.tube);
  b.surface(kWhich == 3 ? kDiveRing : kRing, 2 * level + 2, level + 2, [&](float u, float v) {
    const Vec2f a = turn(1.0f - u), c = turn(v + 0.5f);
    const Vec3f out = f.x * a.x + f.z * a.y, n = normalize(out * c.x + f.y * c.y);
    const Vec3f at = centre + out * (p.radius + p.tube * c.x) + f.y * (p.tube * c.y);
    return SurfacePoint{at, n, {u, v}, under_shade(n)};
  });
}

template void ball<0>(PartBuilder&, int);
template void ball<1>(PartBuilder&, int);
template void ball<2>(PartBuilder&, int);
template void ball<3>(PartBuilder&, int);
template void ring<0>(PartBuilder&, int);
template void ring<1>(PartBuilder&, int);
template void ring<2>(PartBuilder&, int);
template void ring<3>(PartBuilder&, int);

void ladder(PartBuilder& b, int level) {
  constexpr float kX = 3.1f, kHalfWidth = 0.27f, kBack = -3.15f, kFront = -2.42f, kSpring = 0.62f, kFoot = -1.25f;
  constexpr float kRadius = 0.5f * (kFront - kBack);
  for (const float side : {-kHalfWidth, kHalfWidth}) {
    // From the deck up, over, and down the wall; the bend gets its share of the length.
    const auto path = [&](float t) {
      if (t < 0.15f) return Vec3f{kX + side, mix(kDeckY, kSpring, t / 0.15f), kBack};
      if (t < 0.47f) {
        const Vec2f c = turn(0.5f - 0.5f * (t - 0.15f) / 0.32f);
        return Vec3f{kX + side, kSpring + kRadius * c.y, 0.5f * (kBack + kFront) + kRadius * c.x};
      }
      return Vec3f{kX + side, mix(kSpring, kFoot, (t - 0.47f) / 0.53f), kFront};
    };
    b.tube(kChrome, level + 2, 4 + 4 * level, 0.021f, path, {1, 0, 0}, false, {1, 8});
  }
  for (const float y : {-0.24f, -0.52f, -0.80f, -1.08f}) {
    rounded_box(b, kChrome, std::max(1, level / 4), {kX, y, kFront + 0.03f}, {kHalfWidth, 0.015f, 0.05f}, 0.012f,
                kUpright, {1, 1, 1});
  }
}

void lounger(PartBuilder& b, int level) {
  const int n = std::max(1, level / 2);
  const Vec3f white{1, 1, 1};
  // Slatted frame and legs, then the mattress with its raised back.
  b.box(kWood, 1, {-0.34f, 0.24f, -0.95f}, {0.34f, 0.30f, 0.95f}, 1.2f);
  for (const float x : {-0.30f, 0.24f}) {
    for (const float z : {-0.85f, 0.75f}) b.box(kWood, 1, {x, 0, z}, {x + 0.06f, 0.24f, z + 0.08f}, 1.2f);
  }
  rounded_box(b, kCushion, n, {0, 0.355f, 0.325f}, {0.32f, 0.055f, 0.61f}, 0.045f, kUpright, white);
  const Frame back{{1, 0, 0}, normalize({0, 0.82f, 0.57f}), normalize({0, -0.57f, 0.82f})};
  rounded_box(b, kCushion, n, {0, 0.56f, -0.57f}, {0.32f, 0.055f, 0.40f}, 0.045f, back, white);
  rounded_box(b, kShutter, n, {0, 0.80f, -0.76f}, {0.20f, 0.05f, 0.10f}, 0.045f, back, white);
  b.box(kWood, 1, {-0.02f, 0.30f, -0.88f}, {0.02f, 0.66f, -0.84f}, 1.2f);
}

void parasol(PartBuilder& b, int level) {
  constexpr float kRim = 1.55f, kRimY = 2.18f, kTopY = 2.72f;
  const int around = level < 4 ? 8 : 8 * (1 + level / 4), up = std::max(1, level / 2);
  // Eight ribs hold the cloth; it sags a little between them.
  const auto cloth = [&](float u, float radius_share, float drop) {
    const Vec2f c = turn(1.0f - u);
    const float across = u * 8.0f - std::floor(u * 8.0f), sag = 4.0f * across * (1.0f - across) * radius_share;
    const float r = kRim * radius_share * (1.0f - 0.055f * sag);
    const float rise = 1.0f - radius_share;
    const float y = mix(kRimY, kTopY, rise * (1.15f - 0.15f * rise)) - drop - 0.03f * sag;
    return Vec3f{c.x * r, y, c.y * r};
  };
  b.surface(
      kAwning, around, up,
      [&](float u, float v) {
        return SurfacePoint{cloth(u, 1.0f - v, 0), {0, 1, 0}, {u, v}, {1, 1, 1}};
      },
      Normals::kSmooth, Poles::kV1);
  b.surface(
      kAwning, around, up,
      [&](float u, float v) {
        return SurfacePoint{cloth(u, v, 0.012f), {0, -1, 0}, {u, 1.0f - v}, {0.6f, 0.6f, 0.6f}};
      },
      Normals::kSmooth, Poles::kV0);
  b.tube(kWood, level + 3, 2, 0.03f,
         [&](float t) {
           return Vec3f{0, mix(0.0f, kTopY + 0.12f, t), 0};
         },
         {1, 0, 0}, false, {1, 2});
  b.lathe(kMarble, level + 5, 2, {0, 0, 0},
          [](float t) {
            return Vec2f{t < 1 ? 0.26f : 0.0f, t > 0 ? 0.09f : 0.0f};
          },
          Poles::kV1, {1, 1});
}

}  // namespace shoal::pool
