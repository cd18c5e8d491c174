// steel-2024: a broad phase that keeps what is horizontal and finds the apparent depth by a fixed point, and a narrow
// phase by parallax mapping.
//
// Source  Steel 2024, the description of "bowfishing-blitz": virtual_depth, refracted_virt_pos, and the lighting of the
//         water's fragments.
// Differs The listing's signs (a depth below the water is negative where the start uses it), its names that are not
//         defined and its three indices (1.333, 4/3, 1.33) are one index of the scene, by |depth|. |look.xy| /
//         |refracted.xy| is n by Snell's law; the quotient is 0 / 0 looking straight down. A layer's point is where the
//         pixel's ray meets the triangle, so no depth ratio needs to be kept. Under water, and in an orthographic view,
//         the fixed point has no solution or no eye: the exact map is used. Edges are split as two-phase has them split
//         (the source leaves that to the mesh). The underwater picture has the frame's own resolution.
#include "refraction/broad/fixed_point_map.h"
#include "refraction/narrow/march_depth.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

enum Option { kSteps, kPom, kPomSteps, kTessellate, kOptionCount };
constexpr MethodOption kOptions[kOptionCount] = {
    {"steps", "4", "of the fixed point", MethodOption::Kind::kInt, 1, 64},
    {"pom", "false", "parallax occlusion mapping: march to what the bent ray meets", MethodOption::Kind::kBool, 0, 1},
    {"pom-steps", "128", "pixels that the march may go", MethodOption::Kind::kInt, 1, 4096},
    kTessellateOption,
};

// Beyond everything: where nothing is drawn, the direction alone counts.
constexpr float kOpen_m = 1e4f;

struct Steel2024 : TrueRays {
  static constexpr bool kShadesBefore = true, kWholeScene = false;
  static constexpr int kSplitsEdges = kTessellate;

  static FixedPointMap own_map(const FrameData& f, const WaterPass& water) {
    return {water.optics, static_cast<int>(f.method_option[kSteps])};
  }

  static LayerPlace look(const LookUp& l) {
    const Vec3<WideF> n = l.at.plane_normal;
    // virt_z_ratio: what flat water's ray is shrunk by along the normal to be the straight view ray again.
    const ExactRay<WideF> flat = exact_ray(l.water.optics, l.view_ray);
    const WideF flat_cos = max(-dot(flat.refracted, n), WideF(1e-3f));
    const WideF ratio = -dot(flat.incident, n) * flat.eta / flat_cos;
    const Vec3<WideF> along = n * dot(l.at.refracted, n);
    const Vec3<WideF> virtual_direction = normalize(l.at.refracted - along + along * ratio);

    // uw_dist_planar: the rest of the view ray, in virtual space.
    const WideF drawn = WideF::load(l.f.refracted.depth.data() + l.f.layers.offset(l.block.x_px, l.block.y_px));
    const WideM shows = l.lanes & (drawn > WideF(0.0f));
    const WideF depth_m = view_depth_m(l.f.view, select(shows, drawn, WideF(1.0f)));
    const WideF beyond = max((depth_m - l.at.t) * length(l.view_ray.direction_world), WideF(0.0f));
    const WideF distance = select(shows, beyond, WideF(kOpen_m));
    const LayerPlace parallax = project_place(l.f.view, l.at.crossing_world + virtual_direction * distance);
    if (l.f.method_option[kPom] == 0.0f) return parallax;

    DepthMarch how;
    how.solid = true;
    how.max_steps = static_cast<int>(l.f.method_option[kPomSteps]);
    const MarchedPlace marched =
        march_depth(l, l.at.crossing_world, l.at.crossing_world + virtual_direction * WideF(kOpen_m), WideF(0.0f), how);
    return select_place(marched.met, marched.place, parallax);
  }
};

}  // namespace

Method steel_2024() {
  return {"steel-2024", "fixed-point apparent depth, parallax narrow phase, shaded before",
          "Steel 2024", ShadeBeforeStages<Steel2024>::kernels(),
          kOptions,     kOptionCount};
}

}  // namespace shoal::inline SHOAL_ISA_NS
