// Rays among the bodies of water: which surface each ray crosses first.
#pragma once

#include <span>

#include "water/displaced_surface.h"
#include "water/placed_water.h"

namespace shoal::inline SHOAL_ISA_NS {

inline constexpr std::int32_t kNoBody = -1;
inline constexpr float kEndless = 3e38f;  // a distance beyond every scene, in lengths of a ray's direction

// Sixteen rays among the bodies of water.
struct WaterQuery {
  Ray<WideF> ray;  // world
  WideM lanes = mask_from_bits(0);
  float t_near = 0;             // in lengths of the direction
  std::int32_t from = kNoBody;  // the body that the rays start on; they cannot cross it again where it is a plane
  Vec3<WideF> lift = broadcast<WideF>(Vec3f{0, 0, 0});  // moves their origins off that body where it is displaced
};

struct WaterCrossing {
  WideF t;     // in lengths of the direction; kEndless: the ray crosses no water
  WideI body;  // index; kNoBody: none
};

// Which points lie inside a body's outline, seen along its normal.
//   p  world
// Returns the lanes inside, or within a millionth of a side of a triangle of the outline: no gap opens between two
// triangles.
template <class F>
SHOAL_INLINE MaskOf<F> in_outline(const WaterBody& body, Vec3<F> p) {
  const Vec3<F> normal = broadcast<F>(body.normal);
  MaskOf<F> inside = F(0.0f) > F(1.0f);
  for (std::size_t i = 0; i + 2 < body.outline.size(); i += 3) {
    MaskOf<F> here = F(1.0f) > F(0.0f);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3f a = body.outline[i + k], edge = body.outline[i + (k + 1) % 3] - a;
      const float slack = -1e-6f * dot(edge, edge);
      here = here & (dot(cross(broadcast<F>(edge), p - broadcast<F>(a)), normal) >= F(slack));
    }
    inside = inside | here;
  }
  return inside;
}

__attribute__((noinline)) inline WideF cross_waves(const WaterQuery& query, const PlacedWater& water) {
  Ray<WideF> ray = query.ray;
  if (water.index == query.from) ray.origin_world = ray.origin_world + query.lift;
  return meet_displaced(*water.body, *water.surface, ray, WideF(query.t_near), query.lanes);
}

// The nearest body of water that each ray crosses: its plane within the outline, or, where it is displaced, the height
// field.
//   water  all bodies of the scene
// Returns the distance and the body of each lane of the query.
// Error: where the surface is displaced, as meet_displaced.
SHOAL_INLINE WaterCrossing nearest_water(std::span<const PlacedWater> water, const WaterQuery& query) {
  WaterCrossing found{WideF(kEndless), WideI(kNoBody)};
  for (const PlacedWater& one : water) {
    const WaterBody& body = *one.body;
    if (is_displaced(body, one.surface)) {
      const WideF t = cross_waves(query, one);
      const WideM nearer = query.lanes & (t < found.t);
      found.t = select(nearer, t, found.t);
      found.body = select(nearer, WideI(one.index), found.body);
      continue;
    }
    if (one.index == query.from) continue;
    const Vec3<WideF> normal = broadcast<WideF>(body.normal);
    const WideF approach = dot(query.ray.direction_world, normal);
    const WideF height = dot(broadcast<WideF>(body.origin) - query.ray.origin_world, normal);
    const WideM crosses = query.lanes & (approach != WideF(0.0f));
    const WideF t = height / select(crosses, approach, WideF(1.0f));
    const WideM nearer = crosses & (t > WideF(0.0f)) & (t >= WideF(query.t_near)) & (t < found.t);
    if (none(nearer)) continue;
    const WideM here = nearer & in_outline(body, query.ray.origin_world + query.ray.direction_world * t);
    found.t = select(here, t, found.t);
    found.body = select(here, WideI(one.index), found.body);
  }
  return found;
}

}  // namespace shoal::inline SHOAL_ISA_NS
