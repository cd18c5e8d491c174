// ray-traced: the reference. Every pixel's ray is traced through the water, by reflection, refraction and total
// internal reflection, and lit as the rasterizer lights it: the same triangles, attributes, textures and shading
// function.
//
// Water is its plane, with the waves' normals bent to valid ones, or, displaced, the height field itself:
// rays may cross it again and again, from both sides.
//
// Source  Whitted 1980; Li et al., Sec. 4 (recursive tracing of Perlin water).
// Differs Texture filtering follows ray differentials (Igehy 1999) as the raster methods do, not cones. A ray beyond
//         the depth or below the weight sees the background, so that a white scene stays white.
// Error   trace/nearest_hit.h: which triangle a ray hits; raster/resolve.h: the point on it.
#include "refraction/methods/kernels.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

struct Options {
  int depth = 4;
  float weight = 0.001f;
  bool reflection = true, refraction = true;
};
constexpr MethodOption kOptions[] = {
    method_option<&Options::depth>("depth", 1, 8, "water interfaces that a path may cross, plus one"),
    method_option<&Options::weight>("weight", 0, 1, "rays of less weight see the background"),
    method_option<&Options::reflection>("reflection", "trace reflected rays"),
    method_option<&Options::refraction>("refraction", "trace refracted rays"),
};

void trace(const TraceIn& in, const TraceOut& out, std::size_t region) {
  const Options& options = in.state.options_as<Options>();
  trace_region(in, {options.depth, options.weight, options.reflection, options.refraction, in.reflects_scene}, out,
               region);
}

// The flat-water map that hits are measured through.
BroadPhase flat_map(const WaterBody& body, const View& view) { return make_broad_phase(body, view); }

}  // namespace

Method ray_traced() {
  MethodKernels kernels;
  kernels.map = &flat_map;
  kernels.draws_layer = false;
  kernels.traces = true;
  kernels.trace = &trace;
  return {"ray-traced",
          MethodCategory::kTraced,
          "the reference: recursive reflection and refraction",
          "Whitted 1980; Li et al.; Liu et al. 2020, reference [6]",
          kernels,
          option_list<Options>(kOptions)};
}

}  // namespace shoal::inline SHOAL_ISA_NS
