// Visibility of the sun from points, by shadow map.
#pragma once

#include "core/vec_lanes.h"
#include "shading/shadow/shadow_map.h"

namespace shoal::inline SHOAL_ISA_NS {

static_assert(kShadowCell == 8, "level_visibility shifts by 3");

// The farthest tap's centre is 1.5 texels away on either axis. On a plane, an offset along the normal of this many
// texels times the sine to the sun clears all nine taps, whose depths are those of the plane at their centres.
inline constexpr float kNormalOffsetTexels = 2.2f;
// Lower bound of the cosine between an interpolated normal and the triangle's own.
inline constexpr float kMinAgreement = 0.5f;

// Where points lie in a level of a map.
struct ShadowPlace {
  WideF x, y;     // texels, of the first tap: within the level
  WideF nearest;  // the points' own depths, less the bias
  WideI middle;   // slot of the middle tap
  WideM inside;   // of the level
};

// Finds where points lie in a level, and prefetches the texels there: the maps are larger than the caches.
//
//   map       a level of the map of the medium that the points are in
//   position  world; normal: unit, of the surface, towards the sun's side
//   facet     unit, of the triangle itself, on either side. The texels lie on the triangle, so its slope counts: where
//   the
//             interpolated normal faces the sun and the triangle does not, its own texels would shade it
// Source: normal offset as Holbert (2011).
__attribute__((noinline)) inline void find_place(const ShadowMap& map, Vec3<WideF> position, Vec3<WideF> normal,
                                                 Vec3<WideF> facet, ShadowPlace& out) {
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
  out.x = clamp(x_px, first, last), out.y = clamp(y_px, first, last);
  out.inside = (out.x == x_px) & (out.y == y_px);
  out.nearest = at.z + WideF(map.bias);
  const WideI column = to_int_trunc(out.x) + WideI(1), row = to_int_trunc(out.y) + WideI(1);
  out.middle = ((row >> 2) * WideI(map.grid.blocks_x) << 4) + ((row & WideI(3)) << 2) + ((column >> 2) << 4) +
               (column & WideI(3));
  alignas(64) std::int32_t slots[16];
  out.middle.store(slots);
  for (const int lane : {0, 3, 5, 6, 9, 10, 12, 15}) __builtin_prefetch(map.depth.data() + slots[lane]);
}

// Weighted share of nine taps of one level that are not in shadow.
//
//   place   of find_place
//   lanes   that are set; the others get a value from 0 to 1
//   inside  becomes the lanes that are inside of the level
// Returns 0 (in shadow) to 1. A shadow's edge is two texels wide and moves smoothly.
// Source: percentage-closer filtering (Reeves, Salesin, Cook 1987) over a box of two texels round the
// bilinear position. Error: none for points farther from a shadow's edge than kNormalOffsetTexels + 1.5 texels along
// the surface (tests/refraction/test_shadow.cpp).
__attribute__((noinline)) inline WideF level_visibility(const ShadowMap& map, const ShadowPlace& place, WideM lanes,
                                                        WideM& inside) {
  const WideF zero(0.0f), one(1.0f);
  inside = lanes & place.inside;
  const WideI column = to_int_trunc(place.x), row = to_int_trunc(place.y);
  // Where no tap can differ from the middle one, it decides.
  const WideF middle = gather(map.depth.data(), place.middle, lanes, zero);
  const WideI cell = (row >> 3) * WideI(map.grid.width_px / kShadowCell) + (column >> 3);
  const WideF steepness = gather(map.steepness.data(), cell, lanes, zero);
  const WideM lit = middle + steepness <= place.nearest, dark = middle - steepness > place.nearest;
  const WideM open = lanes & !(lit | dark);
  if (none(open)) return select(lit, one, zero);

  const WideF fx = place.x - floor(place.x), fy = place.y - floor(place.y);
  const WideF weight_x[3] = {one - fx, one, fx}, weight_y[3] = {one - fy, one, fy};
  WideI column_slot[3], row_slot[3];
  for (int i = 0; i < 3; ++i) {
    const WideI cx = column + WideI(i), cy = row + WideI(i);
    column_slot[i] = ((cx >> 2) << 4) + (cx & WideI(3));
    row_slot[i] = ((cy >> 2) * WideI(map.grid.blocks_x) << 4) + ((cy & WideI(3)) << 2);
  }
  WideF visible = zero;
  for (int j = 0; j < 3; ++j) {
    WideF in_row = zero;
    for (int i = 0; i < 3; ++i) {
      const WideF depth = gather(map.depth.data(), row_slot[j] + column_slot[i], open, zero);
      in_row = in_row + select(depth <= place.nearest, weight_x[i], zero);
    }
    visible = visible + in_row * weight_y[j];
  }
  return select(lit, one, select(dark, zero, visible * WideF(0.25f)));
}

// The same from the finest level that each point is inside of; 1 (lit) outside of all levels.
//   first  of find_place in the map's first level; position, normal, facet: as there
SHOAL_INLINE WideF sun_visibility(const SunMap& map, const ShadowPlace& first, Vec3<WideF> position, Vec3<WideF> normal,
                                  Vec3<WideF> facet, WideM lanes) {
  WideM inside;
  WideF visible = level_visibility(map.levels[0], first, lanes, inside);
  visible = select(inside, visible, WideF(1.0f));
  for (std::size_t i = 1; i < map.levels.size(); ++i) {
    lanes = lanes & !inside;
    if (none(lanes)) break;
    ShadowPlace place;
    find_place(map.levels[i], position, normal, facet, place);
    const WideF here = level_visibility(map.levels[i], place, lanes, inside);
    visible = select(inside, here, visible);
  }
  return visible;
}

}  // namespace shoal::inline SHOAL_ISA_NS
