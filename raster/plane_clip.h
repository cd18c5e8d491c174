// Clipping of a pass's geometry at a plane in the world: the part of a warped vertex program (raster/tessellate.h) that
// the passes on one side of a plane share.
#pragma once

#include "core/vec_lanes.h"
#include "raster/clip.h"
#include "raster/geometry.h"

namespace shoal::inline SHOAL_ISA_NS {

// Smallest and greatest signed distance of a box from a plane.
struct BoxRange {
  float lo, hi;
};
SHOAL_INLINE BoxRange box_range(const Plane& plane, Vec3f lo, Vec3f hi) {
  const Vec3f n = plane.normal_world;
  const Vec3f near_corner{n.x > 0 ? lo.x : hi.x, n.y > 0 ? lo.y : hi.y, n.z > 0 ? lo.z : hi.z};
  const Vec3f far_corner{n.x > 0 ? hi.x : lo.x, n.y > 0 ? hi.y : lo.y, n.z > 0 ? hi.z : lo.z};
  return {plane_distance(plane, near_corner), plane_distance(plane, far_corner)};
}

// Points are classified by the same expression as the clipper's, so a triangle that counts as inside is never cut.
struct PlaneClip {
  static constexpr bool kWarped = true;
  Plane keep;  // world: the side that is drawn

  SHOAL_INLINE Plane clip_plane() const { return keep; }
  SHOAL_INLINE WideM inside(Vec3<WideF> p) const {
    return dot(broadcast<WideF>(keep.normal_world), p) + WideF(keep.offset_m) >= WideF(0.0f);
  }
  SHOAL_INLINE bool meshlet_inside(const Meshlet& meshlet) const {
    const BoxRange range = box_range(keep, meshlet.bounds_min_world, meshlet.bounds_max_world);
    return range.lo > 1e-5f * (abs(range.hi) + abs(keep.offset_m));
  }
  // Whether nothing of a box is drawn, beyond doubt.
  SHOAL_INLINE bool all_clipped(Vec3f lo, Vec3f hi) const {
    const BoxRange range = box_range(keep, lo, hi);
    return range.hi < -1e-5f * (abs(range.lo) + abs(keep.offset_m));
  }
};

}  // namespace shoal::inline SHOAL_ISA_NS
