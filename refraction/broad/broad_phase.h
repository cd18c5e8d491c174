// The broad phase: where a point on the far side of flat water appears to the eye.
//
// A point P on the other side of the plane from the eye is moved along the plane's normal to its virtual position V, at
// the apparent distance v from the plane: the straight line from the eye to V crosses the plane where the refracted
// path to P does (refraction/broad/path_solver.h). Positions along the plane are kept, so what is over what is kept
// too, and world positions stay affine on a virtual triangle's projection onto the plane.
//
// The map goes on past the plane, so that geometry may be clipped a little beyond it:
// - from the thin side (air, for ior > 1) it is the identity there, and continuous;
// - from the dense side the plane itself appears lifted to v0(d) = max(0, sqrt(m) d - eye distance), the edge of
//   Snell's window, and a point on the eye's side at distance h from the plane is drawn at v0(d) - h: continuous and
//   monotone along the normal. Its error is all of v0: such a point is really seen in place, by the direct pass. What
//   the extension draws lies outside of the window, where no refracted ray looks.
#pragma once

#include <cmath>
#include <limits>

#include "raster/camera.h"
#include "refraction/broad/path_solver.h"
#include "water/body.h"
#include "water/exact_ray.h"

namespace shoal {

// One plane seen from one eye. Plain data, made by make_broad_phase.
struct BroadPhase {
  Vec3f eye_world;  // orthographic: the camera's position, on the frame's plane
  Vec3f plane_origin;
  Vec3f normal;            // the body's, unit
  Vec3f far_normal;        // +-normal, towards the side that the eye is not on
  float eye_height_m = 0;  // signed, along the body's normal
  float eye_distance_m = 0;
  bool eye_below = false;  // the eye is on the water's side
  bool eye_is_thin = true;
  bool orthographic = false;
  // Orthographic: the angle is one for all, v = far_scale * distance. Beyond the critical angle (or along the plane)
  // nothing of the far side shows: far_side_visible is false and the map the identity.
  float far_scale = 1;
  bool far_side_visible = true;
  Vec3f view_direction;   // unit
  float view_cosine = 1;  // dot(view_direction, far_normal); perspective: unused
  float px_per_unit = 1;  // pixels a metre at view depth 1 (perspective), or anywhere (orthographic)
  float near_m = 0.05f;
  PathConstants path;
};

// The path between the eye and one point through flat water.
template <class F>
struct PointPath {
  Vec3<F> virtual_world;
  Vec3<F> crossing_world;    // on the plane; the point itself where it is on the eye's side
  F eye_side_m, far_side_m;  // lengths on either side; 0 on the far one where the point is on the eye's side
};

// Split an edge whose edge_deviation_px exceeds this: the deviation anywhere in a triangle none of whose edges does
// then stays below kInteriorBoundPx. A map of constant curvature has 4/3 of the edges' deviation inside; measured over
// 2e5 triangles, both sides, through the plane too, it is 1.57 at most, 1.39 in 99.99 % (test_broad_phase.cpp).
inline constexpr float kInteriorBoundPx = 0.25f;
inline constexpr float kEdgeThresholdPx = 0.15f;
// The longest edge that may stay, in its own distance from the eye.
inline constexpr float kEdgeReach = 1.5f;

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

//   origin_world, normal   a point of the plane; unit
//   ior                    n_below / n_above, 1/3 to 3 (above: where the normal points)
// An eye in the plane counts as above. An orthographic eye is on the side that its rays come from.
SHOAL_INLINE BroadPhase make_broad_phase(Vec3f origin_world, Vec3f normal, float ior, const View& view) {
  BroadPhase bp;
  const Camera& camera = view.camera;
  bp.eye_world = camera.position_world;
  bp.plane_origin = origin_world;
  bp.normal = normal;
  bp.eye_height_m = dot(camera.position_world - origin_world, normal);
  bp.orthographic = camera.orthographic;
  bp.view_direction = camera.forward_world;
  const float along = dot(camera.forward_world, normal);
  bp.eye_below = camera.orthographic ? along > 0.0f : bp.eye_height_m < 0.0f;
  bp.eye_distance_m = std::fabs(bp.eye_height_m);
  bp.far_normal = bp.eye_below ? normal : -normal;
  bp.path = path_constants(ior);
  bp.eye_is_thin = bp.eye_below == bp.path.water_is_thin;
  bp.view_cosine = std::fabs(along);
  bp.px_per_unit = std::sqrt(std::fmax(dot(view.row_x, view.row_x), dot(view.row_y, view.row_y)));
  bp.near_m = camera.near_m;
  if (bp.orthographic && !bp.path.identity) {
    const double c = static_cast<double>(bp.view_cosine), r = bp.eye_is_thin ? 1.0 / bp.path.ratio : bp.path.ratio;
    const double cos2 = 1.0 - r * r * (1.0 - c * c);  // of the far side's angle, r = n_eye / n_far
    bp.far_side_visible = cos2 > 0.0 && c > 0.0;
    // tan far / tan eye = r c / cos far; v is distance times that.
    bp.far_scale = bp.far_side_visible ? static_cast<float>(r * c / std::sqrt(cos2)) : 1.0f;
  }
  return bp;
}
SHOAL_INLINE BroadPhase make_broad_phase(const WaterBody& body, const View& view) {
  return make_broad_phase(body.origin, body.normal, body.ior, view);
}

// The flat surface as view rays cross it.
SHOAL_INLINE WaterSide eye_side(const BroadPhase& bp) {
  return {bp.plane_origin, -bp.far_normal, bp.eye_below ? bp.path.ior : 1.0f / bp.path.ior};
}
template <class F>
SHOAL_INLINE ExactRay<F> exact_ray(const BroadPhase& bp, Ray<F> ray) {
  return exact_ray(eye_side(bp), ray);
}

// Distance of a point from the plane, positive on the far side: what virtual_position refracts.
template <class F>
SHOAL_INLINE F far_distance(const BroadPhase& bp, Vec3<F> position_world) {
  return dot(position_world - broadcast<F>(bp.plane_origin), broadcast<F>(bp.far_normal));
}

// Where a world position appears.
//
//   position_world  finite
// Returns the virtual position, metres, world space; on the eye's side the extension above. ior 1 returns the argument.
// Source: Steel (2024), horizontal-preserving virtual space.
// Differs: exact path (path_solver.h) for any plane, both sides and orthographic views.
// Error: 4e-7 of the size of the coordinates (point, eye and image together); nothing along a plane whose normal is an
//        axis (tests/refraction/test_broad_phase.cpp).
template <class F>
SHOAL_INLINE Vec3<F> virtual_position(const BroadPhase& bp, Vec3<F> position_world) {
  if (bp.path.identity) return position_world;
  const Vec3<F> n = broadcast<F>(bp.far_normal);
  const F far_m = max(far_distance(bp, position_world), F(0.0f));
  F v;
  if (bp.orthographic) {
    v = far_m * F(bp.far_scale);
  } else {
    const Vec3<F> from_eye = position_world - broadcast<F>(bp.eye_world);
    const Vec3<F> across = from_eye - n * dot(from_eye, n);
    v = virtual_distance(bp.path, bp.eye_is_thin, F(bp.eye_distance_m), far_m, length(across));
  }
  return position_world + n * (v - far_m);
}

// Where a world position appears in the plane as a mirror.
template <class F>
SHOAL_INLINE Vec3<F> mirrored_position(const BroadPhase& bp, Vec3<F> p) {
  const Vec3<F> n = broadcast<F>(bp.normal);
  const F height = dot(p - broadcast<F>(bp.plane_origin), n);
  return p - n * (height + height);
}

// The whole path to a point, for `shoal probe` and absorption.
//   position_world  finite
template <class F>
SHOAL_INLINE PointPath<F> point_path(const BroadPhase& bp, Vec3<F> position_world) {
  const Vec3<F> eye = broadcast<F>(bp.eye_world), n = broadcast<F>(bp.far_normal);
  const Vec3<F> forward = broadcast<F>(bp.view_direction);
  const Vec3<F> image = virtual_position(bp, position_world);
  const F far_m = far_distance(bp, position_world), v = far_distance(bp, image);
  Vec3<F> crossing;
  if (bp.orthographic) {
    crossing = image - forward * (v / F(std::fmax(bp.view_cosine, 1e-6f)));
  } else {
    // Similar triangles over eye and image; both distances are >= 0, so nothing cancels.
    const F a = F(bp.eye_distance_m), sum = a + v;
    crossing = eye + (image - eye) * (a / select(sum > F(0.0f), sum, F(1.0f)));
    crossing = crossing - n * far_distance(bp, crossing);
  }
  const MaskOf<F> refracted = far_m > F(0.0f);
  crossing = select(refracted, crossing, position_world);
  const F eye_m = bp.orthographic ? dot(crossing - eye, forward) : length(crossing - eye);
  return {image, crossing, eye_m, select(refracted, length(position_world - crossing), F(0.0f))};
}

// How far the straight edge between two virtual vertices is from the virtual image of the edge, in pixels.
//
//   a, b    world positions of the ends;  va, vb  their virtual positions
//   view    the view that bp was made from
// Returns the longest distance of the virtual positions at t = 1/4, 1/2, 3/4, at the plane for an edge through it, and
// from the dense side at 1/16 and 15/16 (its map bends sharply near the plane) from the points at the same t of the
// virtual edge, times pixels per unit over the least view depth of all of these and the ends, at least near's. Or, if
// larger, kEdgeThresholdPx times the square of the edge's length over kEdgeReach times its distance from the eye:
// a triangle of longer edges could have the eye's foot far inside of it, where no edge sees how the map bends.
// Exchanging the ends gives the same bits, so two triangles on an edge decide alike.
template <class F>
SHOAL_INLINE F edge_deviation_px(const BroadPhase& bp, const View& view, Vec3<F> a, Vec3<F> b, Vec3<F> va, Vec3<F> vb) {
  if (bp.path.identity) return F(0.0f);
  const Vec3<F> row_w = broadcast<F>(view.row_w), eye = broadcast<F>(view.camera.position_world);
  const Vec3<F> to_a = va - eye, to_b = vb - eye;
  F depth = min(dot(row_w, to_a), dot(row_w, to_b)), distance2 = min(dot(to_a, to_a), dot(to_b, to_b));
  F worst2 = F(0.0f);
  const auto sample = [&](F s, F t) {
    const Vec3<F> image = virtual_position(bp, a * s + b * t);
    const Vec3<F> off = image - (va * s + vb * t), to_image = image - eye;
    worst2 = max(worst2, dot(off, off));
    depth = min(depth, dot(row_w, to_image));
    distance2 = min(distance2, dot(to_image, to_image));
  };
  sample(F(0.75f), F(0.25f));
  sample(F(0.5f), F(0.5f));
  sample(F(0.25f), F(0.75f));
  if (!bp.eye_is_thin && !bp.orthographic) {
    sample(F(0.0625f), F(0.9375f));
    sample(F(0.9375f), F(0.0625f));
  }
  // Where the edge goes through the plane.
  const F ha = far_distance(bp, a), hb = far_distance(bp, b);
  const MaskOf<F> one_below = min(ha, hb)<F(0.0f), one_above = max(ha, hb)> F(0.0f);
  const MaskOf<F> through = one_below & one_above;
  if (any(through)) {
    const F sum = select(through, abs(ha) + abs(hb), F(1.0f));
    sample(select(through, abs(hb) / sum, F(0.5f)), select(through, abs(ha) / sum, F(0.5f)));
  }
  const F scale = F(bp.px_per_unit);
  if (bp.orthographic) return sqrt(worst2) * scale;
  const Vec3<F> edge = a - b;
  const F reach = dot(edge, edge) * F(kEdgeThresholdPx / (kEdgeReach * kEdgeReach)) / max(distance2, F(1e-30f));
  const MaskOf<F> bends = bp.eye_is_thin ? max(ha, hb) > F(0.0f) : distance2 >= F(0.0f);
  return max(sqrt(worst2) * scale / max(depth, F(bp.near_m)), select(bends, reach, F(0.0f)));
}
template <class F>
SHOAL_INLINE F edge_deviation_px(const BroadPhase& bp, const View& view, Vec3<F> a, Vec3<F> b) {
  return edge_deviation_px(bp, view, a, b, virtual_position(bp, a), virtual_position(bp, b));
}

// A world box as the broad phase sees it: ranges of the distances that the map depends on.
struct BoxDistances {
  float far_lo_m, far_hi_m;        // signed distance from the plane, positive on the far side
  float across_lo_m, across_hi_m;  // horizontal distance from the eye's axis, >= 0
};

SHOAL_INLINE BoxDistances box_distances(const BroadPhase& bp, Vec3f box_min, Vec3f box_max) {
  const Vec3f centre = (box_min + box_max) * 0.5f, half = (box_max - box_min) * 0.5f, n = bp.far_normal;
  const float reach = std::fabs(n.x) * half.x + std::fabs(n.y) * half.y + std::fabs(n.z) * half.z;
  const float middle = far_distance(bp, centre);
  const Vec3f from_eye = centre - bp.eye_world;
  const float along = dot(from_eye, n);
  const float d = length(from_eye - n * along);
  // Half the diagonal, seen along the normal: the longest of the four.
  float radius2 = 0.0f;
  for (int corner = 0; corner < 4; ++corner) {
    const Vec3f e = {half.x, (corner & 1) != 0 ? -half.y : half.y, (corner & 2) != 0 ? -half.z : half.z};
    const Vec3f flat = e - n * dot(e, n);
    radius2 = max(radius2, dot(flat, flat));
  }
  const float radius = std::sqrt(radius2);
  // Rounding of the coordinates that went in.
  const float size = std::fabs(centre.x) + std::fabs(centre.y) + std::fabs(centre.z) + half.x + half.y + half.z +
                     length(from_eye) + length(bp.plane_origin);
  const float pad = 1e-6f * size;
  return {middle - reach - pad, middle + reach + pad, max(d - radius - pad, 0.0f), d + radius + pad};
}

// A box that holds a world box's points moved along the normal to distances lo to hi from the plane, positive on the
// far side, rounding included.
SHOAL_INLINE void lifted_bounds(const BroadPhase& bp, Vec3f box_min, Vec3f box_max, float lo, float hi, Vec3f& out_min,
                                Vec3f& out_max) {
  // V = (P's foot on the plane) + far_normal * distance, each component by itself.
  const Vec3f centre = (box_min + box_max) * 0.5f, half = (box_max - box_min) * 0.5f, n = bp.far_normal;
  const Vec3f foot = centre - n * far_distance(bp, centre);
  const Vec3f lift = n * (0.5f * (lo + hi)), spread = n * (0.5f * (hi - lo));
  const auto reach = [&](Vec3f row, float along_normal) {
    return std::fabs(row.x) * half.x + std::fabs(row.y) * half.y + std::fabs(row.z) * half.z + std::fabs(along_normal);
  };
  const Vec3f extent = {reach({1.0f - n.x * n.x, n.x * n.y, n.x * n.z}, spread.x),
                        reach({n.y * n.x, 1.0f - n.y * n.y, n.y * n.z}, spread.y),
                        reach({n.z * n.x, n.z * n.y, 1.0f - n.z * n.z}, spread.z)};
  const Vec3f middle = foot + lift;
  const float size = length(centre) + length(half) + length(bp.plane_origin) + length(bp.eye_world) +
                     max(std::fabs(lo), std::fabs(hi));
  const float pad = 2e-6f * size;
  const Vec3f margin = extent + Vec3f{pad, pad, pad};
  out_min = middle - margin;
  out_max = middle + margin;
}

// A box that holds the virtual images of all points of a world box, those on the eye's side included.
//
//   box_min, box_max  world, metres, min <= max, finite
//   out_min, out_max  the images' bounds, rounding included
// The apparent distance grows with the distance from the plane, and with the horizontal distance it falls seen from the
// thin side and grows seen from the dense one; so its range over the box is between two of its corners.
// Tight for planes along the axes; for others loose by the box's extent along the normal at most.
SHOAL_INLINE void virtual_bounds(const BroadPhase& bp, Vec3f box_min, Vec3f box_max, Vec3f& out_min, Vec3f& out_max) {
  out_min = box_min;
  out_max = box_max;
  if (bp.path.identity || !bp.far_side_visible) return;
  const BoxDistances box = box_distances(bp, box_min, box_max);
  const auto apparent = [&](float far_m, float across_m) {
    const float far_side_m = max(far_m, 0.0f);
    const float v = bp.orthographic
                        ? far_side_m * bp.far_scale
                        : virtual_distance(bp.path, bp.eye_is_thin, bp.eye_distance_m, far_side_m, across_m);
    return v + min(far_m, 0.0f);
  };
  const float lo = apparent(box.far_lo_m, bp.eye_is_thin ? box.across_hi_m : box.across_lo_m);
  const float hi = apparent(box.far_hi_m, bp.eye_is_thin ? box.across_lo_m : box.across_hi_m);
  lifted_bounds(bp, box_min, box_max, lo, hi, out_min, out_max);
}

// sup of eye_distance |Hessian of v| over all points, seen from the thin side: 0.370 for 1.33, and for every ratio r
// in [1, 3] at most this (0.5 / r is met as r -> 1; test_broad_phase.cpp takes the supremum in double).
SHOAL_INLINE float hessian_bound(float ratio) { return max(0.5f / ratio, 0.24f); }

// The same seen from the dense side, for the points of one box on the far side: over all points it has no bound there.
// With S and q of the path, c = a r^2 / q^3 and E = b + c, the second derivatives of v = b q are
//   v_dd = m b / (E^2 q^3) (r^2 + 3 m S^2 c / E),   v_bd = m S / (q E^2) (c - b / q^2 (r^2 + 3 m S^2 c / E)),
//   |v_bb| <= 4.75 m S^2 / (q E),                   v_d / d = m b / (E (q b + a)) across,
// and each factor is taken at its worst over the box. Returns 1/m; infinity next to the plane outside of the window.
SHOAL_INLINE float dense_hessian_bound(const BroadPhase& bp, const BoxDistances& box) {
  const float a = bp.eye_distance_m, b_lo = max(box.far_lo_m, 0.0f), m = bp.path.m;
  const PathSolution<float> outer = solve_path(bp.path, b_lo, a, box.across_hi_m);
  const PathSolution<float> inner = solve_path(bp.path, box.far_hi_m, a, box.across_lo_m);
  const float s = outer.tan_thin, q = inner.q, r2 = bp.path.ratio * bp.path.ratio;
  const float c = a * r2 / (outer.q * outer.q * outer.q), e = b_lo + c;
  const float bend = min(0.25f / c, 1.0f / e) * (r2 + 3.0f * m * s * s) / (q * q);  // b / E^2 <= 1 / 4c, 1 / E
  const float dd = m * bend / q, bd = m * s / q * max(1.0f / e, bend), bb = 4.75f * m * s * s / (q * e);
  return max(std::sqrt(dd * dd + 2.0f * bd * bd + bb * bb), m / (a + q * b_lo));
}

// What edge_deviation_px cannot exceed for any edge up to a length in a world box: a meshlet that passes needs no look
// at its edges.
//
//   longest_edge_m  >= 0
// Returns pixels: |Hessian| f L^2 / (8 w), with w the least view depth of the box's virtual bounds, or the share of
// kEdgeReach if larger; 0 where the map is linear in the box; infinity where no bound is known: in boxes through the
// plane, and from the dense side in boxes that touch it outside of the window.
SHOAL_INLINE float meshlet_deviation_bound_px(const BroadPhase& bp, const View& view, Vec3f bounds_min,
                                              Vec3f bounds_max, float longest_edge_m) {
  constexpr float kUnknown = std::numeric_limits<float>::infinity();
  if (bp.path.identity || !bp.far_side_visible) return 0.0f;
  const BoxDistances box = box_distances(bp, bounds_min, bounds_max);
  const bool linear_on_eye_side = bp.orthographic || bp.eye_is_thin, linear_on_far_side = bp.orthographic;
  if (linear_on_eye_side && box.far_hi_m <= 0.0f) return 0.0f;
  if (linear_on_far_side && box.far_lo_m >= 0.0f) return 0.0f;
  if (bp.orthographic || box.far_lo_m < 0.0f || bp.eye_distance_m == 0.0f) return kUnknown;
  Vec3f lo, hi;
  virtual_bounds(bp, bounds_min, bounds_max, lo, hi);
  const Vec3f centre = (lo + hi) * 0.5f, half = (hi - lo) * 0.5f, w = view.row_w;
  const float reach = std::fabs(w.x) * half.x + std::fabs(w.y) * half.y + std::fabs(w.z) * half.z;
  const float nearest = max(dot(w, centre - bp.eye_world) - reach, bp.near_m);
  const Vec3f outside = max(max(lo - bp.eye_world, bp.eye_world - hi), Vec3f{0.0f, 0.0f, 0.0f});
  const float length2 = longest_edge_m * longest_edge_m, distance2 = max(dot(outside, outside), 1e-30f);
  const float hessian =
      bp.eye_is_thin ? hessian_bound(bp.path.ratio) / bp.eye_distance_m : dense_hessian_bound(bp, box);
  return max(hessian * bp.px_per_unit * length2 / (8.0f * nearest),
             kEdgeThresholdPx / (kEdgeReach * kEdgeReach) * length2 / distance2);
}

}  // namespace shoal::inline SHOAL_ISA_NS
