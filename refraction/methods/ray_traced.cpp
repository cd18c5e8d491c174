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
// Error   Embree finds the triangle that is hit (robust mode); the point on it is our own arithmetic (resolve.h).
#include "refraction/data/capture.h"
#include "refraction/methods/method.h"
#include "refraction/passes/finish_block.h"
#include "trace/path_tracer.h"

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

// The queries of the paths, by Embree.
struct TracedRays {
  const TraceIn& in;
  RayCounts& counts;
  WideI first_hits(const Path& path, WideF t_far) const {
    return shoal::first_hits(*in.trace.rays, in.scene.shading, path.ray, path.differential, path.t_near, t_far,
                             path.lanes);
  }
  void count(RayCounts::Kind kind, WideM lanes) const {
    count_rays(counts, kind, static_cast<std::uint64_t>(__builtin_popcount(to_bits(lanes))));
  }
  const RayQueries* blended() const { return in.any_blended ? in.trace.rays : nullptr; }
};

// What the paths of a block find, into the buffers that the raster stages would leave.
struct BufferRecorder {
  const TraceIn& in;
  const TraceOut& out;
  const Block& block;

  void visible(const Path& path, WideI id, const WaterCrossing& water, WideM hit, WideM wet) {
    const WideI seen = select(hit, id, select(wet, WideI(kFirstWaterId) + water.body, WideI(kNoId)));
    store_masked(out.direct.id.data() + block.offset, seen, path.lanes);
    const std::uint32_t pixels = to_bits(wet);
    if (pixels != 0)
      std::atomic_ref<std::uint64_t>(out.water_pixels)
          .fetch_add(static_cast<std::uint64_t>(__builtin_popcount(pixels)), std::memory_order_relaxed);
    if (!in.view.capture) return;
    WideF t = water.t;
    if (any(hit)) {
      PixelAttributes<WideF> a;
      resolve_attributes(in.scene.geometry(), path.ray, path.differential, id, hit, a);
      t = select(hit, a.t, t);
    }
    const ClipVertex<WideF> clip = project(in.view.view, path.ray.origin_world + path.ray.direction_world * t);
    const WideF depth = select(hit | wet, clip.z / clip.w, WideF(0.0f));
    store_masked(out.direct.depth.data() + block.offset, depth, path.lanes);
  }
  void surface(const SurfaceSample<WideF>& s, WideM lanes) {
    if (in.view.capture) store_surface(out.gbuffer, block.offset, s, lanes);
  }
  void water(const ExactRay<WideF>& at, WideM lanes) {
    if (!in.view.capture) return;
    store_interface_target(out.interface, block.offset, at, lanes);
    store_water(out.gbuffer, out.hits, block.offset, at.crossing_world, at.normal,
                roughness_of_waves(at.slope_variance), lanes);
  }
  void shown(const Path& path, const Vec3<WideF>& position, WideI id, WideM lanes) {
    if (!in.view.capture) return;
    const BroadPhase& exact = in.water[static_cast<std::size_t>(path.first_body)].exact;
    const Vec3<WideF> image = path.shown_as == HitKind::kSurface ? virtual_position(exact, position) : position;
    store_hits(out.hits, block.offset, path.shown_as, id, position, image, lanes);
  }
};

void trace_region(const TraceIn& in, const TraceOut& out, std::size_t region) {
  const float exposure = exposure_scale(in.post);
  const Options& options = in.state.options_as<Options>();
  const TraceLimits limits{options.depth, options.weight, options.reflection, options.refraction, in.reflects_scene};
  const View& view = in.view.view;
  const RayDifferential<float> pixel = pixel_ray_differential<float>(view);
  const TracedRays rays{in, out.counts};
  for_each_block(in.grids.frame, region, [&](const Block& block) SHOAL_LAMBDA {
    BlockColor color;
    BufferRecorder recorder{in, out, block};
    Path path;
    path.ray = block_rays(view, block);
    path.differential = pixel_ray_differential<WideF>(view);
    path.lanes = block.in_frame;
    path.t_near = view.camera.near_m;
    path.medium = in.view.eye_in_water;
    rays.count(RayCounts::kPrimary, path.lanes);
    PathTracer(in.scene, rays, recorder, pixel, limits, color).trace(path);
    if (in.view.accumulate) finish_block(in.view, in.grids.frame, block, in.post, exposure, color, out.lit, out.srgb8);
  });
}

// The flat-water map that hits are measured through.
BroadPhase flat_map(const WaterBody& body, const View& view) { return make_broad_phase(body, view); }

}  // namespace

Method ray_traced() {
  MethodKernels kernels;
  kernels.map = &flat_map;
  kernels.draws_layer = false;
  kernels.trace = &trace_region;
  return {"ray-traced",
          MethodCategory::kTraced,
          "the reference: recursive reflection and refraction, by Embree",
          "Whitted 1980; Li et al.; Liu et al. 2020, reference [6]",
          kernels,
          option_list<Options>(kOptions),
          false};
}

}  // namespace shoal::inline SHOAL_ISA_NS
