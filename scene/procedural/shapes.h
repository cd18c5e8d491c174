// Shapes that several procedural scenes use: spheres, rocks, leaves, and the placement of copies.
#pragma once

#include "scene/procedural/mesh_builder.h"

namespace shoal {

// Returns a direction of about unit length, with the front outside.
//   u, v  in [0, 1]: u goes around once, v from the bottom to the top, which lie exactly on the axis
Vec3f sphere_direction(float u, float v);

// Returns three-dimensional roughness in [0, 1] from two lattices. It depends on the position alone, so that adjacent
// faces agree.
float rough(Vec3f p, float scale, int octaves, std::uint32_t seed);

// Returns a pseudorandom number in [0, 1), computed with integers.
float random_unit(int i, int which, std::uint32_t seed);

// Returns the shade of leaves: brighter outside and above, darker in hollows.
Vec3f leaf_shade(float bump, float upward);

// Adds a bush or the crown of a tree.
void leafy_ball(PartBuilder& b, int material, int level, Vec3f centre, float radius);

// Adds a boulder of half size `half` around `centre`, smooth at coarse levels.
void rock(PartBuilder& b, int material, int level, Vec3f centre, Vec3f half, float uv_metres, std::uint32_t seed,
          Vec3f color = {1, 1, 1});

// Adds a blade at `foot` whose tip bends over by `lean`, of `width` at its foot; two quads a level.
void blade(PartBuilder& b, int material, int level, Vec3f foot, Vec3f lean, float height, float width, Vec3f color);

// Adds a solid of revolution about the y axis, closed at both ends. Normals follow the rows, so that few rows still
// appear round.
//   profile  Vec2f(float t): (radius, height) from the lower to the upper end of the axis, the front on its right
//   color    Vec3f(float t)
template <class Fn, class ColorFn>
void turned_solid(PartBuilder& b, int material, int around, int up, Fn&& profile, ColorFn&& color) {
  b.surface(
      material, around, up,
      [&](float u, float v) {
        const float row = 1.0f / static_cast<float>(up);
        const Vec2f c = turn(1.0f - u), p = profile(v), before = profile(std::max(0.0f, v - row)),
                    after = profile(std::min(1.0f, v + row));
        // The normal lies between those of the rows on both sides.
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

// Returns the matrix that scales, tips about x, turns about the vertical and moves to `at`.
//   turned, tipped  shares of a full turn
Mat4 placed(Vec3f at, float turned, float scale = 1.0f, float tipped = 0.0f);

}  // namespace shoal
