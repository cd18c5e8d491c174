#include "bench/stages.h"

#include "bench/harness.h"
#include "bench/scenes.h"
#include "raster/geometry_view.h"
#include "refraction/renderer.h"

namespace shoal::bench {

Stages::Stages(const RenderScene& scene, int width_px, int height_px, int threads)
    : kernels_(frame_kernels(isa())),
      pool_(threads),
      states_(draw_states(scene.materials.materials)),
      grids_(make_frame_grids(width_px, height_px, FrameSettings{}.tile_px, 0)),
      bins_(make_bins(scene.geometry.meshlets.size())) {
  ShadingView& shading = scene_.shading;
  shading.geometry = view_of(scene.geometry, states_.data());
  shading.materials = scene.materials.materials.data();
  shading.textures = scene.materials.textures.data();
  shading.lighting = &scene.lighting;
  scene_.drawables = scene.geometry.drawables;
  scene_.triangle_count = static_cast<std::int32_t>(scene.geometry.triangles.size());
  allocate(targets_, grids_, TargetNeeds{});
  set_camera(first_camera(scene));
}

void Stages::set_camera(const Camera& camera) {
  const int width = grids_.frame.width_px, height = grids_.frame.height_px;
  view_.view = make_view(camera, width, height, {0, 0});
  view_.frustum = make_frustum(view_.view, 0, 0, width - 1, height - 1);
  PassSettings& pass = view_.direct_pass;
  pass = PassSettings{};
  pass.width_px = width, pass.height_px = height;
  pass.centre_px = view_.view.centre_px;
  pass.grid = grids_.tiles;
  pass.x_max = width - 1, pass.y_max = height - 1;
}

void Stages::front_end() {
  pool_.for_each(bins_.work_items.size(), [&](std::size_t work_item, int) {
    kernels_.direct_front_end({scene_.geometry(), view_}, {bins_}, work_item);
  });
}

void Stages::tiles() {
  const AlphaTestIn alpha{scene_.shading, view_.view, grids_.frame, nullptr, nullptr, nullptr};
  const TilePassIn pass{nullptr, bins_, grids_.tiles, 0, kernels_.direct_alpha_test, alpha};
  pool_.for_each(grids_.tile_count(), [&](std::size_t tile, int) { kernels_.draw_tile(pass, targets_.direct, tile); });
}

std::uint64_t Stages::triangles_in() const {
  std::uint64_t sum = 0;
  for (const WorkItemBins& work_item : bins_.work_items) sum += work_item.triangles_in;
  return sum;
}
std::uint64_t Stages::triangles_out() const {
  std::uint64_t sum = 0;
  for (const WorkItemBins& work_item : bins_.work_items) sum += work_item.triangles_out;
  return sum;
}

}  // namespace shoal::bench
