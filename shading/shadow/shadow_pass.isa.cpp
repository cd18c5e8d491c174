// The sun's depth passes (shading/shadow/shadow_map.h): one copy an ISA.
#include "shading/shadow/shadow_pass.h"
#include "raster/visibility.h"
#include "refraction/pixel_stage.h"
#include "refraction/passes/water_programs.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

bool casts(const ShadowPass& pass, const Meshlet& meshlet) {
  const Material& m = pass.geometry.materials[meshlet.material];
  return !m.unlit && m.alpha_mode != AlphaMode::kBlend;
}

// The whole scene, straight.
struct SunProgram {
  static constexpr bool kWarped = false;
  const ShadowPass& pass;

  template <class F>
  SHOAL_INLINE ClipVertex<F> vertex(Vec3<F> position_world) const {
    return project(pass.map->view, position_world);
  }
  bool meshlet_outside(const Meshlet& meshlet) const { return !casts(pass, meshlet); }
};

// One side of a plane, the far one sheared. A shear keeps edges straight, so nothing is split.
struct BentSunProgram {
  static constexpr bool kWarped = true;
  const ShadowPass& pass;

  template <class F>
  SHOAL_INLINE ClipVertex<F> vertex(Vec3<F> position_world) const {
    if (!pass.sheared) return project(pass.map->view, position_world);
    const SunBend& bend = pass.map->bend;
    const F depth_m = -dot(position_world - broadcast<F>(bend.origin), broadcast<F>(bend.normal));
    return project(pass.map->view, position_world + broadcast<F>(bend.shear) * depth_m);
  }
  SHOAL_INLINE Plane clip_plane() const { return pass.keep; }
  SHOAL_INLINE WideM inside(Vec3<WideF> p) const {
    return dot(broadcast<WideF>(pass.keep.normal_world), p) + WideF(pass.keep.offset_m) >= WideF(0.0f);
  }
  bool meshlet_inside(const Meshlet& meshlet) const {
    const BoxRange range = box_range(pass.keep, meshlet.bounds_min_world, meshlet.bounds_max_world);
    return range.lo > 1e-5f * (abs(range.hi) + abs(pass.keep.offset_m));
  }
  bool meshlet_outside(const Meshlet& meshlet) const {
    const BoxRange range = box_range(pass.keep, meshlet.bounds_min_world, meshlet.bounds_max_world);
    return range.hi < -1e-5f * (abs(range.lo) + abs(pass.keep.offset_m)) || !casts(pass, meshlet);
  }
  SHOAL_INLINE bool box_outside_view(Vec3f, Vec3f) const { return false; }
  SHOAL_INLINE bool meshlet_bends(const Meshlet&) const { return false; }
  SHOAL_INLINE WideM edge_bends(Vec3<WideF>, Vec3<WideF>) const { return mask_from_bits(0); }
};

// Alpha-tested casters: the texel's ray, bent at the plane for what lies below.
struct ShadowAlpha {
  static constexpr bool kTests = true;
  const FrameData& f;
  const ShadowPass* pass;  // the one being drawn

  WideM operator()(std::int32_t id, int x_px, int y_px, WideM cover) const {
    const View& view = pass->map->view;
    Ray<WideF> ray = pixel_ray(view, to_float(WideI(x_px) + block_x()) + WideF(0.5f),
                               to_float(WideI(y_px) + block_y()) + WideF(0.5f));
    RayDifferential<WideF> differential = pixel_ray_differential<WideF>(view);
    if (pass->sheared) {
      const SunBend& bend = pass->map->bend;
      const Vec3<WideF> n = broadcast<WideF>(bend.normal), along = ray.direction_world;
      const WideF scale = WideF(1.0f) / dot(along, n);
      const auto to_plane = [&](Vec3<WideF> v) SHOAL_LAMBDA { return v - along * (dot(v, n) * scale); };
      ray.origin_world = broadcast<WideF>(bend.origin) + to_plane(ray.origin_world - broadcast<WideF>(bend.origin));
      ray.direction_world = broadcast<WideF>(bend.refracted_world);
      differential.origin_dx = to_plane(differential.origin_dx);
      differential.origin_dy = to_plane(differential.origin_dy);
    }
    return mask_from_bits(alpha_bits(f, ray, differential, id, to_bits(cover)));
  }
};

}  // namespace

void shadow_front_end(const ShadowPass& pass, PassBins& bins, std::size_t work_item) {
  const std::uint32_t first = static_cast<std::uint32_t>(work_item) * bins.meshlets_per_work_item;
  const std::uint32_t last =
      first + bins.meshlets_per_work_item < bins.meshlet_count ? first + bins.meshlets_per_work_item : bins.meshlet_count;
  if (pass.clipped) {
    const BentSunProgram program{pass};
    FrontEnd<BentSunProgram>(pass.geometry, program, pass.pass, bins.work_items[work_item]).run(first, last, kNoId);
  } else {
    const SunProgram program{pass};
    FrontEnd<SunProgram>(pass.geometry, program, pass.pass, bins.work_items[work_item]).run(first, last, kNoId);
  }
}

void draw_shadow_tile(const FrameData& f, const std::vector<ShadowPass>& passes, const std::vector<PassBins>& bins,
                      VisibilityBuffer& out, std::size_t tile) {
  const PassSettings& pass = passes[0].pass;
  const int size = pass.grid.tile_px;
  const int x0 = static_cast<int>(tile % static_cast<std::size_t>(pass.grid.tiles_x)) * size;
  const int y0 = static_cast<int>(tile / static_cast<std::size_t>(pass.grid.tiles_x)) * size;
  ShadowAlpha alpha{f, nullptr};
  TileRaster<ShadowAlpha> raster(out, alpha, x0, y0, min(x0 + size, pass.width_px), min(y0 + size, pass.height_px));
  raster.clear();
  for (std::size_t i = 0; i < passes.size(); ++i) {
    alpha.pass = &passes[i];
    for (const WorkItemBins& work_item : bins[i].work_items) raster.draw(work_item, static_cast<std::uint32_t>(tile));
  }
}

}  // namespace shoal::inline SHOAL_ISA_NS
