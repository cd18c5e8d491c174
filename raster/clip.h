// Clipping: a triangle against a plane in the world (before the vertex program), and against near plane and guard band
// in clip space (after it).
//
// Watertight: a new vertex on an edge is computed from the edge's inner and outer end alone, so two triangles that
// share the edge get the same bits. Plane order is fixed.
//
// Source  Sutherland, Hodgman 1974.
#pragma once

#include "core/vec.h"
#include "core/wide/lanes.h"
#include "raster/camera.h"
#include "raster/setup.h"

namespace shoal {

// The side with dot(normal, p) + offset >= 0 is kept.
struct Plane {
  Vec3f normal_world;
  float offset_m;
};

// Three corners, and at most one more for each plane: one in the world, or near and four sides.
inline constexpr int kMaxClipped = 9;

template <class V>
struct Polygon {
  V vertex[kMaxClipped];
  int count;
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

SHOAL_INLINE Vec3f interpolate(Vec3f inner, Vec3f outer, float t) { return inner + (outer - inner) * t; }
SHOAL_INLINE ClipVertex<float> interpolate(const ClipVertex<float>& inner, const ClipVertex<float>& outer, float t) {
  return {inner.x + (outer.x - inner.x) * t, inner.y + (outer.y - inner.y) * t, inner.z + (outer.z - inner.z) * t,
          inner.w + (outer.w - inner.w) * t};
}

//   distance  float operator()(V): signed, in any unit; inside is >= 0. A NaN counts as outside.
template <class V, class Distance>
SHOAL_INLINE Polygon<V> clip_polygon(const Polygon<V>& in, Distance distance) {
  Polygon<V> out;
  out.count = 0;
  for (int i = 0; i < in.count; ++i) {
    const V& a = in.vertex[i];
    const V& b = in.vertex[i + 1 == in.count ? 0 : i + 1];
    const float da = distance(a), db = distance(b);
    const bool a_in = da >= 0.0f, b_in = db >= 0.0f;
    if (a_in && out.count < kMaxClipped) out.vertex[out.count++] = a;
    if (a_in != b_in && out.count < kMaxClipped) {
      out.vertex[out.count++] = a_in ? interpolate(a, b, da / (da - db)) : interpolate(b, a, db / (db - da));
    }
  }
  return out;
}

SHOAL_INLINE float plane_distance(const Plane& plane, Vec3f p) { return dot(plane.normal_world, p) + plane.offset_m; }

// Against a plane in the world.
inline Polygon<Vec3f> clip_to_plane(Vec3f a, Vec3f b, Vec3f c, const Plane& plane) {
  return clip_polygon(Polygon<Vec3f>{{a, b, c}, 3}, [&](Vec3f p) { return plane_distance(plane, p); });
}

// Against near plane and guard band. No vertex of the result is behind the eye.
inline Polygon<ClipVertex<float>> clip_to_guard(const ClipVertex<float>& a, const ClipVertex<float>& b,
                                                const ClipVertex<float>& c) {
  using V = ClipVertex<float>;
  Polygon<V> p = clip_polygon(Polygon<V>{{a, b, c}, 3}, [](const V& v) { return v.w - v.z; });
  p = clip_polygon(p, [](const V& v) { return v.w * kGuardPx - v.x; });
  p = clip_polygon(p, [](const V& v) { return v.w * kGuardPx + v.x; });
  p = clip_polygon(p, [](const V& v) { return v.w * kGuardPx - v.y; });
  p = clip_polygon(p, [](const V& v) { return v.w * kGuardPx + v.y; });
  return p;
}

}  // namespace shoal::inline SHOAL_ISA_NS
