// Rays that go on from water: where they meet water again.
#pragma once

#include "trace/nearest_hit.h"

namespace shoal::inline SHOAL_ISA_NS {

inline constexpr std::int32_t kNowhere = -1;

// Sixteen rays among the bodies of water.
struct WaterQuery {
  Ray<WideF> ray;  // world
  WideM lanes = mask_from_bits(0);
  float t_near = 0;              // in the direction's lengths
  std::int32_t from = kNowhere;  // the body that they start on: if its surface is a plane they do not meet it again
  Vec3<WideF> lift = broadcast<WideF>(Vec3f{0, 0, 0});  // to where they start on that one's side, if it is displaced
};

// The refracted or the mirrored rays of a block, to meet water again.
//   rays  as the eye's rays leave `water`
SHOAL_INLINE WaterQuery onward(const WaterPass& water, const WaterRays<WideF>& rays, bool mirrored, WideM lanes) {
  WaterQuery query{mirrored ? rays.reflected : rays.refracted, lanes};
  query.from = water.index;
  if (!is_displaced(*water.body, water.surface)) return query;
  const ExactRay<WideF>& at = rays.at_surface;
  const Vec3<WideF> lift = at.normal * surface_lift(*water.body, *water.surface, at.crossing_world);
  query.lift = mirrored ? lift : -lift;
  return query;
}

struct WaterMet {
  WideF t;     // in the direction's lengths; kEndless: they meet none
  WideI body;  // kNowhere: none
};

// Seen along the normal, is p inside of the outline?
SHOAL_INLINE WideM in_outline(const WaterBody& body, Vec3<WideF> p) {
  const Vec3<WideF> normal = broadcast<WideF>(body.normal);
  WideM inside = mask_from_bits(0);
  for (std::size_t i = 0; i + 2 < body.outline.size(); i += 3) {
    WideM here = mask_from_bits(0xFFFFu);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3f a = body.outline[i + k], edge = body.outline[i + (k + 1) % 3] - a;
      // A millionth of the edge to spare: no gap between two triangles.
      const float slack = -1e-6f * dot(edge, edge);
      here = here & (dot(cross(broadcast<WideF>(edge), p - broadcast<WideF>(a)), normal) >= WideF(slack));
    }
    inside = inside | here;
  }
  return inside;
}

__attribute__((noinline)) inline WideF meet_waves(const WaterQuery& query, const WaterPass& water) {
  Ray<WideF> ray = query.ray;
  if (water.index == query.from) ray.origin_world = ray.origin_world + query.lift;
  return meet_displaced(*water.body, *water.surface, ray, WideF(query.t_near), query.lanes);
}

// Where rays meet the nearest body of water: its plane within the outline, a millionth of the sides to spare, or, where
// it is displaced, the height field.
// Error: where it is displaced, as meet_displaced.
SHOAL_INLINE WaterMet nearest_water(const FrameData& f, const WaterQuery& query) {
  WaterMet met{WideF(kEndless), WideI(kNowhere)};
  for (const WaterPass& water : f.water) {
    const WaterBody& body = *water.body;
    if (is_displaced(body, water.surface)) {
      const WideF t = meet_waves(query, water);
      const WideM nearer = query.lanes & (t < met.t);
      met.t = select(nearer, t, met.t);
      met.body = select(nearer, WideI(water.index), met.body);
      continue;
    }
    if (water.index == query.from) continue;
    const Vec3<WideF> normal = broadcast<WideF>(body.normal);
    const WideF approach = dot(query.ray.direction_world, normal);
    const WideF height = dot(broadcast<WideF>(body.origin) - query.ray.origin_world, normal);
    const WideM crosses = query.lanes & (approach != WideF(0.0f));
    const WideF t = height / select(crosses, approach, WideF(1.0f));
    const WideM nearer = crosses & (t > WideF(0.0f)) & (t >= WideF(query.t_near)) & (t < met.t);
    if (none(nearer)) continue;
    const WideM here = nearer & in_outline(body, query.ray.origin_world + query.ray.direction_world * t);
    met.t = select(here, t, met.t);
    met.body = select(here, WideI(water.index), met.body);
  }
  return met;
}

}  // namespace shoal::inline SHOAL_ISA_NS
