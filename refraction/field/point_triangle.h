// Squared distance of a point from a triangle.
#pragma once

#include "core/vec_lanes.h"

namespace shoal::inline SHOAL_ISA_NS {

// Squared distance of p, seen from a segment's start, from the segment.
template <class F>
SHOAL_INLINE F segment_distance2(Vec3<F> from_start, Vec3<F> edge) {
  const F along = clamp(dot(from_start, edge) / max(dot(edge, edge), F(1e-30f)), F(0.0f), F(1.0f));
  const Vec3<F> off = from_start - edge * along;
  return dot(off, off);
}

//   p       the point
//   a, b, c corners, any unit; a triangle without area is its edges
// Returns the squared distance, finite for finite input.
// Source: the nearer of the plane, where the point's foot is inside, and the three edges.
// Error: of the distance, 4e-6 of the greatest coordinate (tests/refraction/test_distance_field.cpp).
template <class F>
SHOAL_INLINE F triangle_distance2(Vec3<F> p, Vec3<F> a, Vec3<F> b, Vec3<F> c) {
  const Vec3<F> ab = b - a, bc = c - b, ca = a - c, pa = p - a, pb = p - b, pc = p - c;
  const Vec3<F> n = cross(ab, -ca);
  const F area2 = dot(n, n), height = dot(n, pa);
  const F in_ab = dot(cross(n, ab), pa), in_bc = dot(cross(n, bc), pb), in_ca = dot(cross(n, ca), pc);
  const MaskOf<F> over = (area2 > F(0.0f)) & (in_ab >= F(0.0f)) & (in_bc >= F(0.0f)) & (in_ca >= F(0.0f));
  const F edges = min(min(segment_distance2(pa, ab), segment_distance2(pb, bc)), segment_distance2(pc, ca));
  return select(over, min(height * height / select(area2 > F(0.0f), area2, F(1.0f)), edges), edges);
}

}  // namespace shoal::inline SHOAL_ISA_NS
