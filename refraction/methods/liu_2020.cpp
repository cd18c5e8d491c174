// liu-2020: a broad phase that keeps the length of each path, and a narrow phase that takes what flat water shows at a
// pixel for a plane.
//
// Source  Liu, Han and Fei 2020: Algorithm 1 (broad phase), Algorithm 2 and eqs. 1-3 (narrow phase).
// Differs Algorithm 1, line 8 moves every crossing along the camera's forward direction; it is along the line to the
//         vertex, and line 11 misses the camera's position. Line 7 is solved exactly. Edges are split as two-phase has
//         them split (the paper recommends it after Fig. 12; tessellate=false: as it was).
//         Algorithm 2 leaves open which space P and N are in and turns the view ray as the normal turns. Here they are
//         the world's (the triangle's own plane), the ray is Snell's, and the point met goes through the broad phase
//         before it is projected: so flat water shows each pixel itself.
//         as-printed=true has line 8, the turned view ray and the projection as they are printed.
#include "refraction/narrow/plane_look.h"
#include "refraction/shade_before.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

enum Option { kAsPrinted, kTessellate, kOptionCount };
constexpr MethodOption kOptions[kOptionCount] = {
    {"as-printed", "false", "the algorithms to the letter, misprints included", MethodOption::Kind::kTruth, 0, 1},
    {"tessellate", "true", "split edges that the broad phase bends", MethodOption::Kind::kTruth, 0, 1},
};

// Algorithm 1. On the eye's side of the plane: as the exact broad phase has it.
class PathLengthMap {
 public:
  PathLengthMap(const FrameData& f, const WaterPass& water)
      : bp_(water.optics),
        as_printed_(f.method_option[kAsPrinted] != 0.0f),
        splits_(f.method_option[kTessellate] != 0.0f),
        ratio_(bp_.eye_below ? 1.0f / bp_.path.ior : bp_.path.ior) {
    const Vec3f ahead = bp_.view_direction - bp_.far_normal * dot(bp_.view_direction, bp_.far_normal);
    const float size = length(ahead);
    // Straight down the printed line 8 has no direction.
    ahead_ = size > 1e-6f ? ahead * (1.0f / size) : Vec3f{0, 0, 0};
  }

  bool splits() const { return splits_; }

  // By Snell's law the way beyond the plane, b / cos w, is n times that to the exact image straight behind the same
  // crossing: v / cos a = b tan w / (tan a cos a) = (b / cos w) / n. So the point at the path's length is the crossing
  // and n times the rest.
  template <class F>
  SHOAL_INLINE Vec3<F> position(Vec3<F> world) const {
    if (bp_.path.identity) return world;
    if (as_printed_ && !bp_.orthographic) return printed_position(world);
    const Vec3<F> image = virtual_position(bp_, world);
    const F v = max(far_distance(bp_, image), F(0.0f));
    if (bp_.orthographic) return image + broadcast<F>(bp_.view_direction) * (v * F(stretch()));
    const F sum = F(bp_.eye_distance_m) + v;
    const F beyond = v / select(sum > F(0.0f), sum, F(1.0f));
    const Vec3<F> eye = broadcast<F>(bp_.eye_world);
    return eye + (image - eye) * (F(1.0f) + F(ratio_ - 1.0f) * beyond);
  }

  // The image is the exact one, moved along its view ray.
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
  bool as_printed_, splits_;
  float ratio_;  // n_far / n_eye
  Vec3f ahead_;
};

struct Liu2020 {
  static constexpr bool kFollowsWaves = true, kShadesBefore = true, kWholeScene = false;
  using Map = PathLengthMap;
  static BroadPhase map(const WaterBody& body, const View& view) { return make_broad_phase(body, view); }

  template <class F>
  SHOAL_INLINE static WaterRays<F> rays(const WaterPass& water, Ray<F> view_ray, RayDifferential<F> differential) {
    return bent_rays(water, view_ray, differential);
  }

  static LayerPlace look(const LookUp& l) {
    if (l.f.method_option[kAsPrinted] != 0.0f) return printed_look(l);
    const Ray<WideF> ray{l.at.crossing_world, l.at.refracted};
    const Vec3<WideF> met = ray.origin_world + ray.direction_world * plane_look(l, ray);
    return project_place(l.f.view, PathLengthMap(l.f, l.water).position(met));
  }

  // Algorithm 2 to the letter: the view ray, turned as the waves turn the normal (two mirrors in a row), meets the
  // plane in the world and is projected as it is.
  static LayerPlace printed_look(const LookUp& l) {
    const Vec3<WideF> a = l.at.plane_normal, s = a + l.at.normal, d = reflect(l.at.incident, a);
    const Ray<WideF> ray{l.at.crossing_world, d - s * (WideF(2.0f) * dot(s, d) / dot(s, s))};
    return project_place(l.f.view, ray.origin_world + ray.direction_world * plane_look(l, ray));
  }
};

}  // namespace

Method liu_2020() {
  return {"liu-2020", "path-length-preserving broad phase, plane narrow phase, shaded before",
          "Liu, Han and Fei 2020", ShadeBeforeStages<Liu2020>::kernels(), kOptions, kOptionCount};
}

}  // namespace shoal::inline SHOAL_ISA_NS
