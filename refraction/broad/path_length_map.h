// Liu et al.'s broad phase: a point beyond the water is drawn at the length of its bent path from the eye, along the
// direction that the path leaves in. On the eye's side of the plane it is the exact map (broad_phase.h).
//
// Source  Liu, Han and Fei 2020, Algorithm 1.
// Differs Line 8 is along the line to the vertex, and line 11 adds the camera's position; line 7 is solved exactly.
#pragma once

#include "refraction/broad/broad_phase.h"

namespace shoal::inline SHOAL_ISA_NS {

class PathLengthMap {
 public:
  //   exact       the plane, seen from the eye; must outlive the map
  //   as_printed  with line 8 as it is printed: along the camera's forward direction
  PathLengthMap(const BroadPhase& exact, bool as_printed)
      : bp_(exact),
        as_printed_(as_printed && !exact.orthographic),
        ratio_(bp_.eye_below ? 1.0f / bp_.path.ior : bp_.path.ior) {
    const Vec3f ahead = bp_.view_direction - bp_.far_normal * dot(bp_.view_direction, bp_.far_normal);
    const float size = length(ahead);
    // Straight down the printed line 8 has no direction.
    ahead_ = size > 1e-6f ? ahead * (1.0f / size) : Vec3f{0, 0, 0};
  }

  // Where a world position appears: on its image's view ray, at the length of its path.
  //   world  finite
  // Error: 3e-6 of the size of the coordinates (point, eye and exact image together)
  // (tests/refraction/test_published_maps.cpp).
  //
  // By Snell's law the way beyond the plane, b / cos w, is n times that to the exact image straight behind the same
  // crossing: v / cos a = b tan w / (tan a cos a) = (b / cos w) / n. So the point at the path's length is the crossing
  // and n times the rest.
  template <class F>
  SHOAL_INLINE Vec3<F> position(Vec3<F> world) const {
    if (bp_.path.identity) return world;
    if (as_printed_) return printed_position(world);
    const Vec3<F> image = virtual_position(bp_, world);
    const F v = max(far_distance(bp_, image), F(0.0f));
    if (bp_.orthographic) return image + broadcast<F>(bp_.view_direction) * (v * F(stretch()));
    const F sum = F(bp_.eye_distance_m) + v;
    const F beyond = v / select(sum > F(0.0f), sum, F(1.0f));
    const Vec3<F> eye = broadcast<F>(bp_.eye_world);
    return eye + (image - eye) * (F(1.0f) + F(ratio_ - 1.0f) * beyond);
  }

  // A box that holds the images of a world box: they are the exact ones, moved along their view rays.
  void bounds(Vec3f lo, Vec3f hi, Vec3f& out_lo, Vec3f& out_hi) const {
    if (as_printed_) {
      out_lo = Vec3f{-1e30f, -1e30f, -1e30f}, out_hi = Vec3f{1e30f, 1e30f, 1e30f};
      return;
    }
    virtual_bounds(bp_, lo, hi, out_lo, out_hi);
    if (bp_.path.identity) return;
    if (bp_.orthographic) {
      const float most = max(box_distances(bp_, lo, hi).far_hi_m, 0.0f) * bp_.far_scale * stretch();
      const Vec3f way = bp_.view_direction * most, none{0, 0, 0};
      out_lo = out_lo + min(way, none), out_hi = out_hi + max(way, none);
      return;
    }
    const Vec3f a = out_lo - bp_.eye_world, b = out_hi - bp_.eye_world;
    out_lo = bp_.eye_world + min(a, a * ratio_), out_hi = bp_.eye_world + max(b, b * ratio_);
  }

 private:
  float stretch() const { return (ratio_ - 1.0f) / std::fmax(bp_.view_cosine, 1e-6f); }

  // Lines 2 to 11, with the crossing at x along the camera's forward direction.
  template <class F>
  SHOAL_INLINE Vec3<F> printed_position(Vec3<F> world) const {
    const PointPath<F> path = point_path(bp_, world);
    const Vec3<F> eye = broadcast<F>(bp_.eye_world), n = broadcast<F>(bp_.far_normal);
    const Vec3<F> to_crossing = path.crossing_world - eye;
    const F x = length(to_crossing - n * dot(to_crossing, n));
    const Vec3<F> p = n * F(bp_.eye_distance_m) + broadcast<F>(ahead_) * x;
    const F size = length(p), pathlen = path.eye_side_m + path.far_side_m;
    return eye + p * (pathlen / select(size > F(0.0f), size, F(1.0f)));
  }

  const BroadPhase& bp_;
  bool as_printed_;
  float ratio_;  // n_far / n_eye
  Vec3f ahead_;
};

}  // namespace shoal::inline SHOAL_ISA_NS
