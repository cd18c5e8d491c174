// two-phase: ours, the default. Exact path solver, error-bounded subdivision, and the true refracted ray against the
// triangles that the refracted layer shows, under waves too; each point is shaded once, where that ray truly hits. No
// ray is traced: a GPU without ray tracing could run it.
//
// Source  Steel 2024 (horizontal-preserving virtual space); Liu et al. 2020 (broad and narrow phase).
// Differs From both: the solver is exact (path_solver.h), edges are split to a bound in pixels (broad_phase.h), and the
//         point is an intersection instead of a sample of a shaded picture (narrow/search_layer.h), so no texture or
//         edge is resampled.
#include "refraction/methods/method.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

struct Options {
  int planes = 4, way = 4;
  bool neighbours = true, behind = false;
};
constexpr MethodOption kOptions[] = {
    method_option<&Options::planes>("planes", 0, 4, "steps from plane to plane, after the pixel's own"),
    method_option<&Options::way>("way", 0, 8, "pixels on the way to a hit that are searched for nearer ones"),
    method_option<&Options::neighbours>("neighbours", "search the nine pixels about the place of the hit"),
    method_option<&Options::behind>("behind", "draw and search second layers, behind those of flat water"),
};

struct TwoPhase : TrueRays {
  static constexpr MethodCategory kCategory = MethodCategory::kRaster;
  static constexpr bool kSearchesLayers = true;

  static LayerSearch layer_search(const MethodState& state) {
    const Options& o = state.options_as<Options>();
    return {o.planes, o.way, o.neighbours, o.behind, true};
  }
  static void narrow(const RasterNarrowIn& in, const NarrowOut& out, std::size_t region) {
    search_refracted(in, &rays_of_method<TwoPhase>, layer_search(in.state), out.hits, region);
  }
};

}  // namespace

Method two_phase() {
  return ray_method<TwoPhase>("two-phase",
                              "exact solver, bounded subdivision, true rays against the triangles of rasterized layers",
                              "Shoal; after Steel 2024 and Liu et al. 2020", option_list<Options>(kOptions));
}

}  // namespace shoal::inline SHOAL_ISA_NS
