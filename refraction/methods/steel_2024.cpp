// steel-2024: a broad phase that keeps what is horizontal and finds the apparent depth by a fixed point, and a narrow
// phase by parallax mapping.
//
// Source  Steel 2024, the description of "bowfishing-blitz": virtual_depth, refracted_virt_pos, and the lighting of the
//         water's fragments.
// Differs The listing's signs (a depth below the water is negative where the start uses it), its names that are not
//         defined and its three indices (1.333, 4/3, 1.33) are one index of the scene, by |depth|. |look.xy| /
//         |refracted.xy| is n by Snell's law; the quotient is 0 / 0 looking straight down. A layer's point is where the
//         pixel's ray hits the triangle, so no depth ratio needs to be kept. Under water, and in an orthographic view,
//         the fixed point has no solution or no eye: the exact map is used. Edges are split as hybrid has them split
//         (the source leaves that to the mesh). The underwater picture has the frame's own resolution.
#include "refraction/broad/fixed_point_map.h"
#include "refraction/methods/image_space.h"
#include "refraction/narrow/march_depth.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

// Where nothing is drawn the ray counts as this long, so that its direction alone matters.
constexpr float kOpen_m = 1e4f;

struct Options {
  int steps = 4;
  bool pom = false;
  int pom_steps = 128;
  bool tessellate = true;
};
constexpr MethodOption kOptions[] = {
    method_option<&Options::steps>("steps", 1, 64, "steps of the fixed point"),
    method_option<&Options::pom>("pom", "parallax occlusion mapping: march to what the bent ray hits"),
    method_option<&Options::pom_steps>("pom-steps", 1, 4096, "pixels that the march may go"),
    method_option<&Options::tessellate>("tessellate", "split edges that the broad phase bends"),
};

struct Steel2024 : TrueRays {
  static constexpr bool kWholeScene = false;

  static FixedPointMap own_map(const WaterOptics& optics, const MethodState& state) {
    return {optics.exact, state.options_as<Options>().steps};
  }
  static bool splits_edges(const MethodState& state) { return state.options_as<Options>().tessellate; }

  // uw_dist_planar: the rest of the view ray beyond the surface, in the layer's space.
  static WideF distance_beyond(const SampleIn& in) {
    const LayerView& layer = in.narrow.layer;
    const WideF drawn = WideF::load(layer.depth() + layer.grid().offset(in.block.x_px, in.block.y_px));
    const WideM shows = in.lanes & (drawn > WideF(0.0f));
    const WideF depth_m = view_depth_m(in.view(), select(shows, drawn, WideF(1.0f)));
    const WideF beyond = max((depth_m - in.at.t) * length(in.view_ray.direction_world), WideF(0.0f));
    return select(shows, beyond, WideF(kOpen_m));
  }

  // The same parallax in the mirrored scene, whose virtual space is its own.
  static LayerPlace<WideF> planar_place(const SampleIn& in) {
    const Vec3<WideF> direction = mirrored_direction(in, in.at.reflected);
    return project_place(in.view(), in.at.crossing_world + direction * distance_beyond(in));
  }

  static LayerPlace<WideF> sample_place(const SampleIn& in) {
    const Options& options = in.options<Options>();
    const Vec3<WideF> n = in.at.plane_normal;
    // virt_z_ratio: what flat water's ray is shrunk by along the normal to be the straight view ray again.
    const ExactRay<WideF> flat = exact_ray(in.optics().exact, in.view_ray);
    const WideF flat_cos = max(-dot(flat.refracted, n), WideF(1e-3f));
    const WideF ratio = -dot(flat.incident, n) * flat.eta / flat_cos;
    const Vec3<WideF> along = n * dot(in.at.refracted, n);
    const Vec3<WideF> virtual_direction = normalize(in.at.refracted - along + along * ratio);

    const LayerPlace<WideF> parallax =
        project_place(in.view(), in.at.crossing_world + virtual_direction * distance_beyond(in));
    if (!options.pom) return parallax;

    DepthMarch how;
    how.solid = true;
    how.max_steps = options.pom_steps;
    const MarchedPlace marched = march_depth(
        in, in.at.crossing_world, in.at.crossing_world + virtual_direction * WideF(kOpen_m), WideF(0.0f), how);
    return select_place(marched.hit, marched.place, parallax);
  }
};

}  // namespace

Method steel_2024() {
  return image_space_method<Steel2024>("steel-2024", "fixed-point apparent depth, parallax narrow phase, image space",
                                       "Steel 2024", option_list<Options>(kOptions));
}

}  // namespace shoal::inline SHOAL_ISA_NS
