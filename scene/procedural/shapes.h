// Shapes that several procedural scenes stand things on: spheres, rocks, leaves, and where copies are placed.
#pragma once

#include "scene/procedural/mesh_builder.h"

namespace shoal {

// Over the unit square, u once round and v from the bottom to the top, exactly on the axis there: about unit, the front
// outside.
Vec3f sphere_direction(float u, float v);

// Three-dimensional roughness in [0, 1] from two lattices: a function of the place alone, so that touching faces agree.
float rough(Vec3f p, float scale, int octaves, std::uint32_t seed);

// In [0, 1), by integers alone.
float random_unit(int i, int which, std::uint32_t seed);

// Leaves are brighter outside and above, darker in the hollows.
Vec3f leaf_shade(float bump, float upward);

// A bush or a tree's crown.
void leafy_ball(PartBuilder& b, int material, int level, Vec3f centre, float radius);

// A boulder of half size `half` round `centre`; smooth while it is coarse.
void rock(PartBuilder& b, int material, int level, Vec3f centre, Vec3f half, float uv_metres, std::uint32_t seed,
          Vec3f color = {1, 1, 1});

// A blade that stands at `foot` and bends over by `lean` at its tip, `width` broad at its foot; two quads a level.
void blade(PartBuilder& b, int material, int level, Vec3f foot, Vec3f lean, float height, float width, Vec3f color);

// A solid of revolution about the y axis, closed at both ends: profile(t) is (radius, height), from the lower to the
// upper end of the axis, the front to its right. Normals follow the rows, so that few of them still look round.
//   color  Vec3f(float t)
template <class Fn, class ColorFn>
void turned_solid(PartBuilder& b, int material, int around, int up, Fn&& profile, ColorFn&& color) {
  b.surface(
      material, around, up,
      [&](float u, float v) {
        const float row = 1.0f / static_cast<float>(up);
        const Vec2f c = turn(1.0f - u), p = profile(v), before = profile(std::max(0.0f, v - row)),
                    after = profile(std::min(1.0f, v + row));
        // Between those of the rows on both sides.
        const auto facing = [c](Vec2f from, Vec2f to) {
          const Vec3f n{c.x * (to.y - from.y), from.x - to.x, c.y * (to.y - from.y)};
          return n / std::max(length(n), 1e-9f);
        };
        const Vec3f slope = normalize(facing(before, p) + facing(p, after));
        const Vec3f normal = v == 0.0f ? Vec3f{0, -1, 0} : v == 1.0f ? Vec3f{0, 1, 0} : slope;
        return SurfacePoint{{c.x * p.x, p.y, c.y * p.x}, normal, {u, v}, color(v)};
      },
      Normals::kGiven, Poles::kBoth);
}

// Turned about the vertical by a share of a full turn, after tipping about x.
Mat4 placed(Vec3f at, float turned, float scale = 1.0f, float tipped = 0.0f);

}  // namespace shoal
