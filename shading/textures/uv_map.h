// The texture coordinates of a material's map: one of a vertex's two sets, transformed.
#pragma once

#include <cstdint>

#include "core/math.h"
#include "core/vec.h"

namespace shoal {

// As KHR_texture_transform gives it; `row` is what a pixel needs: u' = row[0] . (u, v, 1), v' = row[1] . (u, v, 1).
struct UvMap {
  std::int32_t set = 0;      // 0 or 1
  bool transformed = false;  // else the rest is the identity
  Vec2f offset{0, 0}, scale{1, 1};
  float rotation = 0;  // radians, of u towards -v: v points down
  float row[2][3] = {{1, 0, 0}, {0, 1, 0}};
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

// Source: KHR_texture_transform, "Overview": translation * rotation * scale.
// Error: sine and cosine as det_sincos; the products are rounded once each.
SHOAL_INLINE UvMap make_uv_map(std::int32_t set, Vec2f offset, float rotation, Vec2f scale) {
  const float c = det_cos(rotation), s = det_sin(rotation);
  UvMap map{set, true, offset, scale, rotation, {}};
  map.row[0][0] = c * scale.x, map.row[0][1] = s * scale.y, map.row[0][2] = offset.x;
  map.row[1][0] = -s * scale.x, map.row[1][1] = c * scale.y, map.row[1][2] = offset.y;
  return map;
}

// Texture coordinates and their change over one pixel.
template <class F>
struct UvPoint {
  Vec2<F> uv, duv_dx, duv_dy;
};

template <class F>
SHOAL_INLINE UvPoint<F> transform_uv(const UvMap& map, const UvPoint<F>& p) {
  const F a(map.row[0][0]), b(map.row[0][1]), c(map.row[1][0]), d(map.row[1][1]);
  const auto linear = [&](Vec2<F> v) SHOAL_LAMBDA { return Vec2<F>{a * v.x + b * v.y, c * v.x + d * v.y}; };
  return {linear(p.uv) + broadcast<F>(Vec2f{map.row[0][2], map.row[1][2]}), linear(p.duv_dx), linear(p.duv_dy)};
}

}  // namespace shoal::inline SHOAL_ISA_NS
