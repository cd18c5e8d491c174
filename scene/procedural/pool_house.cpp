// The house of the scene `pool`: columns, arcade, the shaded gallery with its doors, and the roof.
#include <cmath>

#include "scene/procedural/pool_parts.h"

namespace shoal::pool {
namespace {

constexpr float kSpring = 2.55f, kArchRadius = 1.2f, kWallTop = 4.35f;
constexpr float kLeft = -0.5f * kBay * kBays, kRight = -kLeft;
constexpr Vec3f kWhite{1, 1, 1};

// Tuscan: a torus and a fillet, a shaft that swells and narrows, a necking, an echinus. (radius, height) by t.
Vec2f column_profile(float t) {
  struct Knot {
    float t, radius, y;
  };
  static constexpr Knot kKnots[] = {{0.00f, 0.225f, 0.14f}, {0.06f, 0.255f, 0.17f}, {0.12f, 0.255f, 0.21f},
                                    {0.17f, 0.215f, 0.24f}, {0.19f, 0.205f, 0.27f}, {0.22f, 0.185f, 0.30f},
                                    {0.45f, 0.186f, 1.00f}, {0.72f, 0.158f, 2.16f}, {0.75f, 0.178f, 2.18f},
                                    {0.79f, 0.178f, 2.21f}, {0.82f, 0.160f, 2.23f}, {0.88f, 0.165f, 2.31f},
                                    {0.95f, 0.225f, 2.36f}, {1.00f, 0.235f, 2.39f}};
  constexpr int kCount = static_cast<int>(std::size(kKnots));
  int k = 0;
  while (k + 2 < kCount && t > kKnots[k + 1].t) ++k;
  const float s = clamp01((t - kKnots[k].t) / (kKnots[k + 1].t - kKnots[k].t));
  return {mix(kKnots[k].radius, kKnots[k + 1].radius, s), mix(kKnots[k].y, kKnots[k + 1].y, s)};
}

// One bay of the arcade: both faces, the soffit, and the pale ring round the arch.
void arch(PartBuilder& b, int level, float x0) {
  const int around = 2 * level, thick = 1;
  const float xc = x0 + 0.5f * kBay, xl = xc - kArchRadius, xr = xc + kArchRadius;
  const Vec3f up{0, kWallTop - kSpring, 0};
  const auto on_arch = [&](float u, float r) {
    const Vec2f c = turn(0.5f - 0.5f * u);
    return Vec2f{xc + r * c.x, kSpring + r * std::max(0.0f, c.y)};
  };
  const auto face = [&](float u, float v, float z, float sign) {
    const Vec2f a = on_arch(sign > 0 ? u : 1.0f - u, kArchRadius);
    const Vec3f p{a.x, mix(a.y, kWallTop, v), z};
    return SurfacePoint{p, {0, 0, sign}, {p.x / 3.0f, -p.y / 3.0f}, kWhite * (sign > 0 ? 1.0f : 0.55f)};
  };
  const int rows = std::max(1, level / 4);
  b.surface(kStucco, around, rows, [&](float u, float v) { return face(u, v, kArcadeFront, 1.0f); });
  b.quad(kStucco, 1, 1, {x0, kSpring, kArcadeFront}, {xl - x0, 0, 0}, up, 3.0f);
  b.quad(kStucco, 1, 1, {xr, kSpring, kArcadeFront}, {x0 + kBay - xr, 0, 0}, up, 3.0f);
  b.surface(kStucco, around, thick, [&](float u, float v) {
    const Vec2f a = on_arch(1.0f - u, kArchRadius), n = turn(0.5f * u);
    const float z = mix(kArcadeFront, kArcadeBack, v);
    const float shade = mix(0.85f, 0.62f, v);
    return SurfacePoint{{a.x, a.y, z}, {-n.x, -n.y, 0}, {u * 1.25f, z / 3.0f}, kWhite * shade};
  });
  if (level < 2) return;
  b.surface(kStucco, around, rows, [&](float u, float v) { return face(u, v, kArcadeBack, -1.0f); });
  b.quad(kStucco, 1, 1, {xl, kSpring, kArcadeBack}, {x0 - xl, 0, 0}, up, 3.0f, kWhite * 0.55f);
  b.quad(kStucco, 1, 1, {x0 + kBay, kSpring, kArcadeBack}, {xr - x0 - kBay, 0, 0}, up, 3.0f, kWhite * 0.55f);
  const Vec3f back{0, 0, kArcadeBack - kArcadeFront};
  b.quad(kStucco, 1, 1, {x0, kSpring, kArcadeBack}, {xl - x0, 0, 0}, -back, 3.0f, kWhite * 0.7f);
  b.quad(kStucco, 1, 1, {xr, kSpring, kArcadeBack}, {x0 + kBay - xr, 0, 0}, -back, 3.0f, kWhite * 0.7f);
  // The ring: its front, and its outer edge.
  constexpr float kOut = 0.035f, kWide = 0.20f;
  b.surface(kMarble, around, 1, [&](float u, float v) {
    const Vec2f p = on_arch(u, kArchRadius + kWide * v);
    return SurfacePoint{{p.x, p.y, kArcadeFront + kOut}, {0, 0, 1}, {u * 3.0f, v * 0.2f}, kWhite};
  });
  b.surface(kMarble, around, 1, [&](float u, float v) {
    const Vec2f p = on_arch(u, kArchRadius + kWide), n = turn(0.5f - 0.5f * u);
    return SurfacePoint{
        {p.x, p.y, mix(kArcadeFront + kOut, kArcadeFront, v)}, {n.x, n.y, 0}, {u * 3.0f, v * 0.05f}, kWhite};
  });
  b.surface(kMarble, around, 1, [&](float u, float v) {
    const Vec2f p = on_arch(u, kArchRadius), n = turn(0.5f - 0.5f * u);
    return SurfacePoint{
        {p.x, p.y, mix(kArcadeFront, kArcadeFront + kOut, v)}, {-n.x, -n.y, 0}, {u * 3.0f, v * 0.05f}, kWhite};
  });
}

// A pair of glazed doors between shutters, on the gallery's wall.
void french_window(PartBuilder& b, float x) {
  constexpr float kZ = kDeckBack, kHalf = 0.55f, kTop = 2.45f, kShade = 0.62f;
  const Vec3f tint = kWhite * kShade;
  b.box(kMarble, 1, {x - kHalf - 0.12f, kDeckY, kZ}, {x + kHalf + 0.12f, kTop + 0.14f, kZ + 0.05f}, 1.2f, tint);
  for (const float side : {-1.0f, 1.0f}) {
    const float inner = side < 0 ? x - kHalf : x + 0.02f, outer = side < 0 ? x - 0.02f : x + kHalf;
    b.box(kShutter, 1, {inner, kDeckY, kZ + 0.05f}, {outer, kTop, kZ + 0.09f}, 1.2f, tint);
    for (int row = 0; row < 3; ++row) {
      const float y = kDeckY + 0.45f + 0.62f * static_cast<float>(row);
      b.quad(kGlass, 1, 1, {inner + 0.08f, y, kZ + 0.092f}, {outer - inner - 0.16f, 0, 0}, {0, 0.54f, 0}, 1.2f);
    }
    const float hinge = x + side * (kHalf + 0.14f);
    b.box(kShutter, 1, {std::min(hinge, hinge + side * 0.55f), kDeckY + 0.02f, kZ},
          {std::max(hinge, hinge + side * 0.55f), kTop, kZ + 0.045f}, 0.6f, tint);
  }
}

}  // namespace

void column(PartBuilder& b, int level) {
  b.box(kMarble, 1, {-0.28f, 0, -0.28f}, {0.28f, 0.14f, 0.28f}, 1.2f, kWhite * 0.95f);
  b.lathe(kMarble, level + 4, level < 4 ? 2 * level : 4 * level, {0, 0, 0}, column_profile, Poles::kOpen, {1.0f, 2.0f});
  b.box(kMarble, 1, {-0.27f, 2.39f, -0.27f}, {0.27f, kSpring - kDeckY, 0.27f}, 1.2f, kWhite * 0.95f);
}

void arcade(PartBuilder& b, int level) {
  for (int bay = 0; bay < kBays; ++bay) arch(b, level, kLeft + kBay * static_cast<float>(bay));
  // Cornice, and the piers that close the ends.
  b.box(kMarble, 1, {kLeft - 0.12f, kWallTop, kArcadeBack}, {kRight + 0.12f, kWallTop + 0.14f, kArcadeFront + 0.12f},
        1.2f);
  if (level < 2) return;
  b.box(kMarble, 1, {kLeft - 0.06f, kWallTop - 0.08f, kArcadeBack}, {kRight + 0.06f, kWallTop, kArcadeFront + 0.06f},
        1.2f);
}

void house(PartBuilder& b, int level) {
  const int nx = 3 * level, ny = level;
  b.surface(kOchre, nx, ny, [](float u, float v) {
    const float x = mix(kLeft, kRight, u), y = mix(kDeckY, kWallTop, v);
    const float shade = 0.66f - 0.22f * smooth_step(1.5f, kWallTop, y) - 0.12f * smooth_step(0.5f, kDeckY, y);
    return SurfacePoint{{x, y, kDeckBack}, {0, 0, 1}, {x / 3.0f, -y / 3.0f}, kWhite * shade};
  });
  b.quad(kWood, 1, 1, {kLeft, kWallTop, kDeckBack}, {kRight - kLeft, 0, 0}, {0, 0, kArcadeBack - kDeckBack}, 1.2f,
         kWhite * 0.42f);
  for (const float side : {-1.0f, 1.0f}) {
    const float inner = side * kRight, outer = side * (kRight + 0.35f);
    b.box(kStucco, 1, {std::min(inner, outer), 0, kDeckBack - 0.4f}, {std::max(inner, outer), kWallTop, kArcadeFront},
          3.0f);
  }
  if (level < 2) return;
  for (int bay = 0; bay < kBays; ++bay) {
    const float x = kLeft + kBay * (static_cast<float>(bay) + 0.5f);
    french_window(b, x);
    // Beams under the gallery's ceiling.
    for (const float dx : {-0.75f, 0.0f, 0.75f}) {
      b.box(kWood, 1, {x + dx - 0.06f, kWallTop - 0.16f, kDeckBack}, {x + dx + 0.06f, kWallTop, kArcadeBack}, 1.2f,
            kWhite * 0.42f);
    }
  }
}

void roof(PartBuilder& b, int level) {
  constexpr float kEaveZ = kArcadeFront + 0.45f, kEaveY = kWallTop + 0.12f, kRidgeZ = -9.2f, kRidgeY = 6.05f;
  constexpr float kX = kRight + 0.6f, kRow = 0.2f;
  // Rows of half-round tiles, as soon as there are vertices enough to shape them.
  const int columns = level < 6 ? 2 * level : level * 48;
  const bool round = static_cast<float>(columns) * kRow > 6.0f * kX;
  const auto height = [&](float x, float along) {
    if (!round) return 0.0f;
    const float row = x / kRow - std::floor(x / kRow), course = along / 0.3f - std::floor(along / 0.3f);
    const float hump = 4.0f * row * (1.0f - row);
    return 0.055f * hump + 0.02f * (1.0f - course);
  };
  const float slope_length =
      std::sqrt((kEaveZ - kRidgeZ) * (kEaveZ - kRidgeZ) + (kRidgeY - kEaveY) * (kRidgeY - kEaveY));
  b.surface(
      kRoof, columns, std::max(1, level / 3),
      [&](float u, float v) {
        const float x = mix(-kX, kX, u);
        const Vec3f p{x, mix(kEaveY, kRidgeY, v) + height(x, 0.0f), mix(kEaveZ, kRidgeZ, v)};
        return SurfacePoint{p, {0, 1, 0}, {x / 1.2f, -v * slope_length / 1.2f}, kWhite};
      },
      Normals::kSmooth);
  b.quad(kRoof, 1, 1, {kX, kEaveY, 2 * kRidgeZ - kEaveZ}, {-2 * kX, 0, 0}, {0, kRidgeY - kEaveY, kEaveZ - kRidgeZ},
         1.2f);
  b.box(kWood, 1, {-kX, kEaveY - 0.10f, kEaveZ - 0.10f}, {kX, kEaveY + 0.01f, kEaveZ - 0.02f}, 1.2f, kWhite * 0.8f);
  b.quad(kWood, 1, 1, {-kX, kEaveY - 0.01f, kArcadeFront}, {2 * kX, 0, 0}, {0, 0, kEaveZ - kArcadeFront}, 1.2f,
         kWhite * 0.5f);
  for (const float side : {-1.0f, 1.0f}) {
    const Vec3f eave{side * (kRight + 0.35f), kEaveY, kRidgeZ};
    b.surface(
        kStucco, 1, 1,
        [&](float u, float v) {
          const float z = side * mix(kEaveZ - kRidgeZ, kRidgeZ - kEaveZ, u) * (1.0f - v);
          return SurfacePoint{eave + Vec3f{0, (kRidgeY - kEaveY) * v, z}, {side, 0, 0}, {u * 2.0f, -v * 0.5f}, kWhite};
        },
        Normals::kGiven, Poles::kV1);
  }
}

}  // namespace shoal::pool
