// liu-2020: a broad phase that keeps the length of each path, and a narrow phase that takes what flat water shows at a
// pixel for a plane.
//
// Source  Liu, Han and Fei 2020: Algorithm 1 (broad phase), Algorithm 2 and eqs. 1-3 (narrow phase).
// Differs Algorithm 1, line 8 moves every crossing along the camera's forward direction; it is along the line to the
//         vertex, and line 11 misses the camera's position. Line 7 is solved exactly. Edges are split as hybrid has
//         them split (the paper recommends it after Fig. 12; tessellate=false: as it was).
//         Algorithm 2 leaves open which space P and N are in and turns the view ray as the normal turns. Here they are
//         the world's (the triangle's own plane), the ray is Snell's, and the point hit goes through the broad phase
//         before it is projected: so flat water shows each pixel itself.
//         as-printed=true has line 8, the turned view ray and the projection as they are printed.
#include "refraction/broad/path_length_map.h"
#include "refraction/methods/image_space.h"
#include "refraction/narrow/plane_intersection.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

struct Options {
  bool as_printed = false, tessellate = true;
};
constexpr MethodOption kOptions[] = {
    method_option<&Options::as_printed>("as-printed", "the algorithms to the letter, misprints included"),
    method_option<&Options::tessellate>("tessellate", "split edges that the broad phase bends"),
};

struct Liu2020 : TrueRays {
  static constexpr bool kWholeScene = false;

  static PathLengthMap own_map(const WaterOptics& optics, const MethodState& state) {
    return {optics.exact, state.options_as<Options>().as_printed};
  }
  static bool splits_edges(const MethodState& state) { return state.options_as<Options>().tessellate; }

  static LayerPlace<WideF> planar_place(const SampleIn& in) { return plane_planar_place(in); }

  static LayerPlace<WideF> sample_place(const SampleIn& in) {
    if (in.options<Options>().as_printed) return printed_place(in);
    const Ray<WideF> ray{in.at.crossing_world, in.at.refracted};
    const Vec3<WideF> hit = ray.origin_world + ray.direction_world * plane_distance(in, ray);
    return project_place(in.view(), own_map(in.optics(), in.narrow.state).position(hit));
  }

  // Algorithm 2 to the letter: the view ray, turned as the waves turn the normal (two mirrors in a row), intersects the
  // plane in the world and is projected as it is.
  static LayerPlace<WideF> printed_place(const SampleIn& in) {
    const Vec3<WideF> a = in.at.plane_normal, s = a + in.at.normal, d = reflect(in.at.incident, a);
    const Ray<WideF> ray{in.at.crossing_world, d - s * (WideF(2.0f) * dot(s, d) / dot(s, s))};
    return project_place(in.view(), ray.origin_world + ray.direction_world * plane_distance(in, ray));
  }
};

}  // namespace

Method liu_2020() {
  return image_space_method<Liu2020>("liu-2020", "path-length-preserving broad phase, plane narrow phase, image space",
                                     "Liu, Han and Fei 2020", option_list<Options>(kOptions));
}

}  // namespace shoal::inline SHOAL_ISA_NS
