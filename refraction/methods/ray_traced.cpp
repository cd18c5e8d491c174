// ray-traced: the truth. Every pixel's ray is followed through the water, by reflection, refraction and total internal
// reflection, and lit as the rasterizer lights it: the same triangles, attributes, textures and shading function.
//
// Water is its plane, with the waves' normals bent to what a plane can bear, or, displaced, the height field itself:
// rays may meet it again and again, from both sides.
//
// Source  Whitted 1980; Li et al., Sec. 4 (recursive tracing of Perlin water).
// Differs Texture filtering follows ray differentials (Igehy 1999) as the raster methods do, not cones. A ray beyond
//         the depth or below the weight sees the background, so that a white scene stays white.
// Error   Which triangle is met is Embree's answer (robust mode); the point on it is our own arithmetic (resolve.h).
#include "refraction/kernels.h"
#include "trace/path_tracer.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

enum Option { kDepth, kWeight, kReflection, kRefraction, kOptionCount };
constexpr MethodOption kOptions[kOptionCount] = {
    {"depth", "4", "surfaces of water that a path may meet, and one", MethodOption::Kind::kInt, 1, 8},
    {"weight", "0.001", "rays that count for less see the background", MethodOption::Kind::kFloat, 0, 1},
    {"reflection", "true", "follow reflected rays", MethodOption::Kind::kBool, 0, 1},
    {"refraction", "true", "follow refracted rays", MethodOption::Kind::kBool, 0, 1},
};

// What paths are asked of: Embree.
struct TracedScene {
  static constexpr bool kBlends = true;
  static WideI first_hits(const FrameData& f, const Path& path, WideF t_far) {
    return shoal::first_hits(f, path.ray, path.differential, path.t_near, t_far, path.lanes);
  }
  static void count(const FrameData& f, RayCounts::Kind kind, WideM lanes) {
    count_rays(f, kind, static_cast<std::uint64_t>(__builtin_popcount(to_bits(lanes))));
  }
};

void trace_region(FrameData& f, std::size_t region) {
  const PostSettings post{f.settings.exposure_stops,
                          f.settings.tone_map == ToneMap::kAces ? ToneCurve::kAces : ToneCurve::kNone};
  const float exposure = exposure_scale(post);
  const TraceLimits limits{static_cast<int>(f.method_option[kDepth]), f.method_option[kWeight],
                           f.method_option[kReflection] != 0.0f, f.method_option[kRefraction] != 0.0f};
  for_each_block(f.grid, region, [&](const Block& block) SHOAL_LAMBDA {
    BlockColor color;
    if (f.capture) shade_detail::capture_clear(f, block);
    Path path;
    path.ray = block_rays(f.view, block);
    path.differential = pixel_ray_differential<WideF>(f.view);
    path.weight = broadcast<WideF>(Vec3f{1, 1, 1});
    path.lanes = block.in_frame;
    path.t_near = f.view.camera.near_m;
    path.medium = f.eye_in_water;
    TracedScene::count(f, RayCounts::kPrimary, path.lanes);
    Tracer<TracedScene>(f, block, limits, color).follow(path);
    if (f.accumulate) finish_block(f, block, post, exposure, color);
  });
}

// The flat-water map that hits are measured through.
BroadPhase flat_map(const WaterBody& body, const View& view) { return make_broad_phase(body, view); }

}  // namespace

Method ray_traced() {
  MethodKernels kernels{};
  kernels.map = &flat_map;
  kernels.trace = &trace_region;
  return {"ray-traced",
          "the truth: recursive reflection and refraction, by Embree",
          "Whitted 1980; Li et al.; Liu et al. 2020, reference [6]",
          kernels,
          kOptions,
          kOptionCount,
          false};
}

}  // namespace shoal::inline SHOAL_ISA_NS
