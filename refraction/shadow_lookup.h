// What a point sees of the sun, from a shadow map.
#pragma once

#include "core/vec_lanes.h"
#include "refraction/shadow_map.h"

namespace shoal::inline SHOAL_ISA_NS {

static_assert(kShadowCell == 8, "the look-up shifts by 3");

// The farthest tap's centre is 1.5 texels off on either axis: on a plane, this much along the normal times the sine to
// the sun clears all nine (their depths are those of the plane at their centres).
inline constexpr float kNormalOffsetTexels = 2.2f;
// An interpolated normal and its triangle's own that agree less than this (cosine) are taken to agree so much.
inline constexpr float kMinAgreement = 0.5f;

// Weighted share of nine taps of one level that see the sun.
//
//   map       a level of the map of the medium that the points are in
//   position  world; normal: unit, of the surface, towards the sun's side
//   facet     unit, of the triangle itself, of either side: the texels lie on it, so it says how steep they are (where
//             the interpolated normal faces the sun and the facet does not, its own texels would shade it)
//   lanes     that are wanted; the others get anything from 0 to 1
// Returns 0 (in shadow) to 1, and which of the lanes are inside of the level. The edge is two texels wide and moves
// smoothly. Source: percentage-closer filtering (Reeves, Salesin, Cook 1987) over a box of two texels round the
// bilinear position; normal offset as Holbert (2011). Error: none for points farther from a shadow's edge than
// kNormalOffsetTexels + 1.5 texels along the surface (tests/refraction/test_shadow.cpp).
__attribute__((noinline)) inline WideF level_visibility(const ShadowMap& map, Vec3<WideF> position, Vec3<WideF> normal,
                                                        Vec3<WideF> facet, WideM lanes, WideM& inside) {
  const WideF zero(0.0f), one(1.0f);
  if (map.bend.bent) {
    const Vec3<WideF> plane_normal = broadcast<WideF>(map.bend.normal), shear = broadcast<WideF>(map.bend.shear);
    const WideF depth_m = max(-dot(position - broadcast<WideF>(map.bend.origin), plane_normal), zero);
    position = position + shear * depth_m;
    // Sheared normals: the inverse transpose of I - shear normal^T.
    const auto turned = [&](Vec3<WideF> n) SHOAL_LAMBDA {
      return select<WideF>(depth_m > zero, normalize(n + plane_normal * dot(shear, n)), n);
    };
    normal = turned(normal), facet = turned(facet);
  }
  const Vec3<WideF> forward = broadcast<WideF>(map.view.camera.forward_world);
  const WideF cosine = dot(normal, forward), facet_cosine = dot(facet, forward);
  const WideF least_cosine2 = min(cosine * cosine, facet_cosine * facet_cosine);
  const WideF sine = sqrt(max(one - least_cosine2, zero));
  const WideF agreement = max(abs(dot(normal, facet)), WideF(kMinAgreement));
  position = position + normal * (sine * WideF(kNormalOffsetTexels * map.texel_m) / agreement);

  const ClipVertex<WideF> at = project(map.view, position);
  const WideF first(0.0f), last(static_cast<float>(map.grid.width_px - 3));
  const WideF x_px = at.x + WideF(map.view.centre_px.x - 1.0f), y_px = at.y + WideF(map.view.centre_px.y - 1.0f);
  const WideF x = clamp(x_px, first, last), y = clamp(y_px, first, last);
  inside = lanes & (x == x_px) & (y == y_px);
  const WideF column = floor(x), row = floor(y);
  const WideF fx = x - column, fy = y - row;
  const WideF nearest = at.z + WideF(map.bias);

  const WideF weight_x[3] = {one - fx, one, fx}, weight_y[3] = {one - fy, one, fy};
  WideI column_slot[3], row_slot[3];
  for (int i = 0; i < 3; ++i) {
    const WideI cx = to_int_trunc(column) + WideI(i), cy = to_int_trunc(row) + WideI(i);
    column_slot[i] = ((cx >> 2) << 4) + (cx & WideI(3));
    row_slot[i] = ((cy >> 2) * WideI(map.grid.blocks_x) << 4) + ((cy & WideI(3)) << 2);
  }
  // Where no tap can differ from the middle one, it decides.
  const WideF middle = gather(map.depth.data(), row_slot[1] + column_slot[1], lanes, zero);
  const WideI cell = (to_int_trunc(row) >> 3) * WideI(map.grid.width_px / kShadowCell) + (to_int_trunc(column) >> 3);
  const WideF steepness = gather(map.steepness.data(), cell, lanes, zero);
  const WideM lit = middle + steepness <= nearest, dark = middle - steepness > nearest;
  if (none(lanes & !(lit | dark))) return select(lit, one, zero);

  WideF seen = zero;
  for (int j = 0; j < 3; ++j) {
    WideF in_row = zero;
    for (int i = 0; i < 3; ++i) {
      const WideF depth = gather(map.depth.data(), row_slot[j] + column_slot[i], lanes, zero);
      in_row = in_row + select(depth <= nearest, weight_x[i], zero);
    }
    seen = seen + in_row * weight_y[j];
  }
  return select(lit, one, select(dark, zero, seen * WideF(0.25f)));
}

// The same from the finest level that holds each point; 1 (lit) outside of all.
SHOAL_INLINE WideF sun_visibility(const SunMap& map, Vec3<WideF> position, Vec3<WideF> normal, Vec3<WideF> facet,
                                  WideM lanes) {
  WideF seen(1.0f);
  for (const ShadowMap& level : map.levels) {
    WideM inside;
    const WideF here = level_visibility(level, position, normal, facet, lanes, inside);
    seen = select(inside, here, seen);
    lanes = lanes & !inside;
    if (none(lanes)) break;
  }
  return seen;
}

}  // namespace shoal::inline SHOAL_ISA_NS
