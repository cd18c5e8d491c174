// Packets of rays that advance along one axis, and the boxes that any of their rays may enter.
#pragma once

#include "core/ray.h"
#include "core/vec_lanes.h"
#include "trace/bvh16.h"

namespace shoal::inline SHOAL_ISA_NS {

// Rays form one packet frustum where all their directions have, along some axis, the same sign and at least this size.
inline constexpr float kMinAlong = 0.2f;

SHOAL_INLINE float min_of(WideF v, WideM lanes) { return reduce_min(select(lanes, v, WideF(3e38f))); }
SHOAL_INLINE float max_of(WideF v, WideM lanes) { return reduce_max(select(lanes, v, WideF(-3e38f))); }
SHOAL_INLINE WideF along(const Vec3<WideF>& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

// The axis along which all rays of a packet advance, and its sign.
struct Heading {
  int axis = 0;
  float sense = 0;  // 1 or -1; 0: none
};

// The common heading of all lanes, or, where there is none, that of the first lane.
inline Heading find_heading(const Ray<WideF>& ray, WideM lanes) {
  Heading best;
  float most = kMinAlong;
  for (int a = 0; a < 3; ++a) {
    const WideF d = along(ray.direction_world, a);
    const float up = min_of(d, lanes), down = -max_of(d, lanes);
    if (up > most) best = {a, 1.0f}, most = up;
    if (down > most) best = {a, -1.0f}, most = down;
  }
  if (best.sense != 0.0f) return best;
  const int lane = __builtin_ctz(to_bits(lanes));
  most = 0;
  for (int a = 0; a < 3; ++a) {
    const float d = extract(along(ray.direction_world, a), lane);
    if (abs(d) > most) best = {a, d > 0.0f ? 1.0f : -1.0f}, most = abs(d);
  }
  return best;
}

// The frustum of a packet of rays: at a depth along its axis all rays lie in an interval on either of the other axes,
// and the ends of the intervals move in proportion to the depth.
// Source: Reshetov et al. 2005 (one box test for all of a packet's rays: here by intervals along an axis).
struct PacketFrustum {
  int axis[3];
  float sense;
  float base_lo, base_hi;  // where they start, along the axis
  float lo[2], hi[2];      // where they start, along the others
  float slope_lo[2], slope_hi[2];
  WideF per_t;  // depth by length

  // Intervals are wider than their rounding.
  PacketFrustum(const Ray<WideF>& ray, const Heading& heading, WideM lanes) : sense(heading.sense) {
    axis[0] = heading.axis, axis[1] = (heading.axis + 1) % 3, axis[2] = (heading.axis + 2) % 3;
    const WideF main = along(ray.direction_world, axis[0]);
    per_t = abs(main);
    const WideF inverse = WideF(1.0f) / select(lanes, per_t, WideF(1.0f));
    const auto starts = [&](int a, float& from, float& to) SHOAL_LAMBDA {
      const WideF o = along(ray.origin_world, a);
      from = min_of(o, lanes), to = max_of(o, lanes);
      const float by = 1e-6f * max(abs(from), abs(to));
      from -= by, to += by;
    };
    starts(axis[0], base_lo, base_hi);
    for (int k = 0; k < 2; ++k) {
      starts(axis[k + 1], lo[k], hi[k]);
      const WideF slope = along(ray.direction_world, axis[k + 1]) * inverse;
      slope_lo[k] = min_of(slope, lanes), slope_hi[k] = max_of(slope, lanes);
      slope_lo[k] -= 2e-6f * (1.0f + abs(slope_lo[k])), slope_hi[k] += 2e-6f * (1.0f + abs(slope_hi[k]));
    }
  }

  // Whether the rays spread so little that one traversal for all of them costs less than one for each. Measured on
  // bench_trace (docs/PERFORMANCE.md).
  bool is_narrow() const { return slope_hi[0] - slope_lo[0] + (slope_hi[1] - slope_lo[1]) < kMaxSpread; }
  static constexpr float kMaxSpread = 0.75f;

  // The boxes that any of the rays may enter before `reach`.
  //   enter  the least depth at which a ray may enter each box
  SHOAL_INLINE WideM passes(const Bvh16::Boxes& boxes, float reach, WideF& enter) const {
    const bool up = sense > 0.0f;
    const WideF first = WideF::load((up ? boxes.lo : boxes.hi)[axis[0]]),
                last = WideF::load((up ? boxes.hi : boxes.lo)[axis[0]]);
    enter = max((first - WideF(up ? base_hi : base_lo)) * WideF(sense), WideF(0.0f));
    const WideF leave = min((last - WideF(up ? base_lo : base_hi)) * WideF(sense), WideF(reach));
    WideM in = enter <= leave;
    for (int k = 0; k < 2; ++k) {
      const WideF from = WideF(lo[k]) + (slope_lo[k] < 0.0f ? leave : enter) * WideF(slope_lo[k]);
      const WideF to = WideF(hi[k]) + (slope_hi[k] < 0.0f ? enter : leave) * WideF(slope_hi[k]);
      in = in & (from <= WideF::load(boxes.hi[axis[k + 1]])) & (to >= WideF::load(boxes.lo[axis[k + 1]]));
    }
    return in;
  }
};

}  // namespace shoal::inline SHOAL_ISA_NS
