// The pixels of a traced method (refraction/passes/trace_pass.h).
#include "refraction/passes/trace_pass.h"

#include <atomic>

#include "refraction/data/capture.h"
#include "refraction/passes/finish_block.h"
#include "trace/path_tracer.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

// The queries of the paths.
struct TracedRays {
  const TraceIn& in;
  RayCounts& counts;
  NearestHit first_hits(const Path& path, WideF t_far) const {
    return nearest_hits(*in.trace.bvh, in.scene.shading, path.ray, path.differential, {WideI(kNoId), t_far}, path.lanes,
                        path.t_near);
  }
  void count(RayCounts::Kind kind, WideM lanes) const {
    count_rays(counts, kind, static_cast<std::uint64_t>(__builtin_popcount(to_bits(lanes))));
  }
  const Bvh16* blended() const { return in.trace.blended; }
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
  void secondary(WideM lanes) {
    if (in.view.capture) store_plane(out.hits.secondary, block.offset, WideI(1), lanes);
  }
  void shown(const Path& path, const Vec3<WideF>& position, WideI id, WideM lanes) {
    if (!in.view.capture) return;
    const BroadPhase& exact = in.water[static_cast<std::size_t>(path.first_body)].exact;
    const Vec3<WideF> image = path.shown_as == HitKind::kSurface ? virtual_position(exact, position) : position;
    store_hits(out.hits, block.offset, path.shown_as, id, position, image, lanes);
  }
};

}  // namespace

void trace_region(const TraceIn& in, const TraceLimits& limits, const TraceOut& out, std::size_t region) {
  const float exposure = exposure_scale(in.post);
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

}  // namespace shoal::inline SHOAL_ISA_NS
