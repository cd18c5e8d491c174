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
#include "refraction/broad/path_length_map.h"
#include "refraction/narrow/plane_intersection.h"
#include "refraction/methods/image_space.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

enum Option { kAsPrinted, kTessellate, kOptionCount };
constexpr MethodOption kOptions[kOptionCount] = {
    {"as-printed", "false", "the algorithms to the letter, misprints included", MethodOption::Kind::kBool, 0, 1},
    kTessellateOption,
};

struct Liu2020 : TrueRays {
  static constexpr bool kShadesBefore = true, kWholeScene = false;
  static constexpr int kSplitsEdges = kTessellate;

  static PathLengthMap own_map(const FrameData& f, const WaterPass& water) {
    return {water.optics, f.method_option[kAsPrinted] != 0.0f};
  }

  static LayerPlace look(const LookUp& l) {
    if (l.f.method_option[kAsPrinted] != 0.0f) return printed_look(l);
    const Ray<WideF> ray{l.at.crossing_world, l.at.refracted};
    const Vec3<WideF> met = ray.origin_world + ray.direction_world * plane_look(l, ray);
    return project_place(l.f.view, own_map(l.f, l.water).position(met));
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
  return {"liu-2020",
          "path-length-preserving broad phase, plane narrow phase, shaded before",
          "Liu, Han and Fei 2020",
          ShadeBeforeStages<Liu2020>::kernels(),
          kOptions,
          kOptionCount};
}

}  // namespace shoal::inline SHOAL_ISA_NS
