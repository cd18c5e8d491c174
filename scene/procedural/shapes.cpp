#include "scene/procedural/shapes.h"

#include <cmath>

#include "scene/procedural/textures.h"

namespace shoal {

Vec3f sphere_direction(float u, float v) {
  const Vec2f a = turn(1.0f - u), e = turn(0.5f * v - 0.25f);
  const float ring = v == 0.0f || v == 1.0f ? 0.0f : e.x;
  return {ring * a.x, v == 0.0f ? -1.0f : (v == 1.0f ? 1.0f : e.y), ring * a.y};
}

float rough(Vec3f p, float scale, int octaves, std::uint32_t seed) {
  return 0.5f * (fractal_noise(p.x * scale + 3.1f * p.y, p.z * scale - 2.3f * p.y, 0, octaves, seed) +
                 fractal_noise(p.y * scale + 1.7f * p.x, p.x * scale + 2.9f * p.z, 0, octaves, seed + 7));
}

float random_unit(int i, int which, std::uint32_t seed) {
  return static_cast<float>(hash_lattice(i, which, seed) >> 8) * (1.0f / 16777216.0f);
}

Vec3f leaf_shade(float bump, float upward) {
  return Vec3f{1, 1, 1} * clamp01(0.55f + 0.40f * clamp01(bump * 1.3f) + 0.10f * upward);
}

void leafy_ball(PartBuilder& b, int material, int level, Vec3f centre, float radius) {
  // A coarse ball is smooth, because its faces are too large for the leaves.
  const float depth = 0.36f * std::min(1.0f, static_cast<float>(level) / 6.0f);
  b.surface(
      material, 2 * level + 2, level + 2,
      [&](float u, float v) {
        const Vec3f d = sphere_direction(u, v);
        const float bump = rough(d * radius + centre, 9.0f / std::sqrt(radius / 0.44f), 3, 201);
        return SurfacePoint{centre + d * (radius * (1.0f + depth * (bump - 0.5f))),
                            d,
                            {u * 5.0f * radius, v * 2.5f * radius},
                            leaf_shade(bump, d.y)};
      },
      Normals::kSmooth, Poles::kBoth);
}

void rock(PartBuilder& b, int material, int level, Vec3f centre, Vec3f half, float uv_metres, std::uint32_t seed,
          Vec3f color) {
  const float depth = std::min(1.0f, static_cast<float>(level) / 6.0f);
  const float size = (half.x + half.y + half.z) * (1.0f / 3.0f), around = 6.2831853f * size / uv_metres;
  // The number of repeats is whole, so that the seam closes.
  const float repeats = std::max(1.0f, std::floor(around + 0.5f));
  b.surface(
      material, 2 * level + 3, level + 2,
      [&](float u, float v) {
        const Vec3f d = sphere_direction(u, v);
        const float big = rough(d * 0.5f, 2.4f, 2, seed), fine = rough(d, 3.5f, 3, seed + 3);
        const float r = 1.0f + depth * (0.85f * (big - 0.5f) + 0.22f * (fine - 0.5f));
        const Vec3f p{d.x * half.x * r, d.y * half.y * r, d.z * half.z * r};
        const float shade = clamp01((0.62f + 0.5f * fine) * (0.85f + 0.15f * d.y));
        return SurfacePoint{centre + p, d, {u * repeats, (1.0f - v) * 0.5f * repeats}, color * shade};
      },
      Normals::kSmooth, Poles::kBoth);
}

void blade(PartBuilder& b, int material, int level, Vec3f foot, Vec3f lean, float height, float width, Vec3f color) {
  const Vec3f across = normalize(cross(Vec3f{0, 1, 0}, lean)) * width;
  const Vec3f fold = normalize(lean) * (0.25f * width);
  b.surface(
      material, 2, level,
      [&](float u, float v) {
        const float share = 2.0f * u - 1.0f, taper = 0.5f * (1.0f - v) * (1.0f + v);
        const Vec3f p = foot + lean * (v * v) + Vec3f{0, height * v * (1.0f - 0.12f * v), 0} +
                        across * (share * taper) - fold * ((1.0f - share * share) * taper);
        return SurfacePoint{p, {0, 1, 0}, {u, v}, color * mix(0.55f, 1.0f, clamp01(v * 1.4f))};
      },
      Normals::kSmooth, Poles::kV1);
}

Mat4 placed(Vec3f at, float turned, float scale, float tipped) {
  const Vec2f c = turn(turned), t = turn(tipped);
  const Vec3f x_row = Vec3f{c.x, c.y * t.y, c.y * t.x} * scale, y_row = Vec3f{0, t.x, -t.y} * scale,
              z_row = Vec3f{-c.y, c.x * t.y, c.x * t.x} * scale;
  return from_rows({x_row.x, x_row.y, x_row.z, at.x}, {y_row.x, y_row.y, y_row.z, at.y},
                   {z_row.x, z_row.y, z_row.z, at.z});
}

}  // namespace shoal
