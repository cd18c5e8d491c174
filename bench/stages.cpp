#include "bench/stages.h"

#include <algorithm>

#include "bench/harness.h"
#include "bench/scenes.h"
#include "raster/geometry_view.h"

namespace shoal::bench {

Stages::Stages(const RenderScene& scene, int width_px, int height_px, int threads)
    : kernels_(frame_kernels(isa())), pool_(threads) {
  FrameData& f = frame_;
  f.scene = &scene;
  f.settings.width_px = width_px, f.settings.height_px = height_px;
  f.grid = make_frame_grid(width_px, height_px);
  f.bin_grid = make_bin_grid(width_px, height_px, f.settings.tile_px);
  f.geometry = view_of(scene.geometry, scene.materials);
  // As the renderer does: about 128 work_items, of at least four meshlets.
  const std::size_t meshlets = scene.geometry.meshlets.size();
  f.bins.meshlet_count = static_cast<std::uint32_t>(meshlets);
  f.bins.meshlets_per_work_item = static_cast<std::uint32_t>(std::max<std::size_t>(4, (meshlets + 127) / 128));
  f.bins.work_items.resize((meshlets + f.bins.meshlets_per_work_item - 1) / f.bins.meshlets_per_work_item);
  f.direct.resize(f.grid);
  look(first_camera(scene));
}

void Stages::look(const Camera& camera) {
  FrameData& f = frame_;
  const int width = f.settings.width_px, height = f.settings.height_px;
  f.view = make_view(camera, width, height, {0, 0});
  f.frustum = make_frustum(f.view, 0, 0, width - 1, height - 1);
  f.direct_pass = PassSettings{};
  f.direct_pass.width_px = width, f.direct_pass.height_px = height;
  f.direct_pass.centre_px = f.view.centre_px;
  f.direct_pass.grid = f.bin_grid;
  f.direct_pass.x_max = width - 1, f.direct_pass.y_max = height - 1;
}

void Stages::front_end() {
  pool_.for_each(frame_.bins.work_items.size(), [&](std::size_t work_item, int) { kernels_.direct_front_end(frame_, work_item); });
}

void Stages::tiles() {
  const std::size_t count =
      static_cast<std::size_t>(frame_.bin_grid.tiles_x) * static_cast<std::size_t>(frame_.bin_grid.tiles_y);
  pool_.for_each(count, [&](std::size_t tile, int) {
    kernels_.draw_tile(frame_, frame_.direct, kernels_.direct_alpha, nullptr, nullptr, tile);
  });
}

std::uint64_t Stages::triangles_in() const {
  std::uint64_t sum = 0;
  for (const WorkItemBins& work_item : frame_.bins.work_items) sum += work_item.triangles_in;
  return sum;
}
std::uint64_t Stages::triangles_out() const {
  std::uint64_t sum = 0;
  for (const WorkItemBins& work_item : frame_.bins.work_items) sum += work_item.triangles_out;
  return sum;
}

}  // namespace shoal::bench
