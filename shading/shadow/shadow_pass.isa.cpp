// The sun's depth passes (shading/shadow/shadow_pass.h): one copy for each instruction set.
#include "shading/shadow/shadow_pass.h"

#include "raster/front_end.h"
#include "raster/plane_clip.h"
#include "raster/ray_triangle.h"
#include "raster/visibility.h"
#include "shading/shade_hits.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

bool casts(const ShadowPass& pass, const Meshlet& meshlet) { return pass.casts[meshlet.material] != 0; }

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
struct BentSunProgram : PlaneClip {
  const ShadowPass& pass;

  explicit BentSunProgram(const ShadowPass& of) : PlaneClip{of.keep}, pass(of) {}
  template <class F>
  SHOAL_INLINE ClipVertex<F> vertex(Vec3<F> position_world) const {
    if (!pass.sheared) return project(pass.map->view, position_world);
    const SunBend& bend = pass.map->bend;
    const F depth_m = -dot(position_world - broadcast<F>(bend.origin), broadcast<F>(bend.normal));
    return project(pass.map->view, position_world + broadcast<F>(bend.shear) * depth_m);
  }
  bool meshlet_outside(const Meshlet& meshlet) const {
    return all_clipped(meshlet.bounds_min_world, meshlet.bounds_max_world) || !casts(pass, meshlet);
  }
  SHOAL_INLINE bool box_outside_view(Vec3f, Vec3f) const { return false; }
  SHOAL_INLINE bool meshlet_bends(const Meshlet&) const { return false; }
  SHOAL_INLINE WideM edge_bends(Vec3<WideF>, Vec3<WideF>) const { return mask_from_bits(0); }
};

// Alpha-tested casters: the texel's ray, bent at the plane for what lies below.
struct ShadowAlpha {
  static constexpr bool kTests = true;
  const ShadingView& scene;
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
    return mask_from_bits(alpha_bits(scene, ray, differential, id, to_bits(cover)));
  }
};

void shadow_front_end(const ShadowFrontEndIn& in, WorkItemBins& out) {
  const ShadowPass& pass = in.pass;
  if (pass.clipped) {
    const BentSunProgram program(pass);
    FrontEnd<BentSunProgram>(pass.geometry, program, pass.pass, out).run(in.first_meshlet, in.last_meshlet, kNoId);
  } else {
    const SunProgram program{pass};
    FrontEnd<SunProgram>(pass.geometry, program, pass.pass, out).run(in.first_meshlet, in.last_meshlet, kNoId);
  }
}

void draw_shadow_tile(const ShadowTileIn& in, VisibilityBuffer& out) {
  const PassSettings& pass = in.passes[0].pass;
  const int size = pass.grid.tile_px;
  const int x0 = static_cast<int>(in.tile % static_cast<std::size_t>(pass.grid.tiles_x)) * size;
  const int y0 = static_cast<int>(in.tile / static_cast<std::size_t>(pass.grid.tiles_x)) * size;
  ShadowAlpha alpha{in.view, nullptr};
  TileRaster<ShadowAlpha> raster(out, alpha, x0, y0, min(x0 + size, pass.width_px), min(y0 + size, pass.height_px));
  raster.clear();
  for (std::size_t i = 0; i < in.passes.size(); ++i) {
    alpha.pass = &in.passes[i];
    for (const WorkItemBins& work_item : in.bins[i].work_items)
      raster.draw(work_item, static_cast<std::uint32_t>(in.tile));
  }
}

}  // namespace

ShadowKernels make_shadow_kernels() { return {&shadow_front_end, &draw_shadow_tile}; }

}  // namespace shoal::inline SHOAL_ISA_NS
