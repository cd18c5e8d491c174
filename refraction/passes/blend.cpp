#include "refraction/passes/blend.h"

#include <algorithm>

#include "refraction/passes/water_region.h"

namespace shoal {

void find_blended(FrameData& f, int threads) {
  Blended& blended = f.blended;
  const Geometry& geometry = f.scene->geometry;
  for (std::size_t c = 0; c < geometry.meshlets.size(); ++c)
    if (f.scene->materials.materials[geometry.meshlets[c].material].alpha_mode == AlphaMode::kBlend)
      blended.meshlets.push_back(static_cast<std::uint32_t>(c));
  if (!blended.any()) return;
  blended.bins = make_bins(blended.meshlets.size());
  blended.grid = make_bin_grid(f.grid.width_px, f.grid.height_px, kRegionSize);
  blended.lists.resize(static_cast<std::size_t>(threads));
  for (FragmentLists& lists : blended.lists) lists.allocate();
  blended.direct.resize(f.grid);
  if (f.scene->waters.empty()) return;
  blended.refracted.resize(f.grid);
  blended.mirrored.resize(f.grid);
}

void clear_blended(FrameData& f) {
  for (BlendLayer* layer : {&f.blended.direct, &f.blended.refracted, &f.blended.mirrored})
    std::fill_n(layer->filled.data(), layer->filled.size(), std::uint8_t{0});
}

namespace {

std::size_t region_count(const FrameData& f) {
  return static_cast<std::size_t>(f.grid.regions_x) * static_cast<std::size_t>(f.grid.regions_y);
}

void blend_water_pass(FrameData& f, const FrameKernels& kernels, const MethodKernels& method, const WaterPass& water,
                      ThreadPool& pool) {
  const bool own_map = method.blended_front_end != nullptr && !water.mirrored;
  pool.for_each(f.blended.bins.work_items.size(), [&](std::size_t work_item, int) {
    own_map ? method.blended_front_end(f, water, work_item) : kernels.blended_front_end(f, &water, work_item);
  });
  for (const WorkItemBins& work_item : f.blended.bins.work_items) f.subdivision_capped += work_item.subdivision_capped;
  pool.for_each(region_count(f), [&](std::size_t region, int thread) {
    if (f.region_of_body[region] != 0) method.blend_water(f, water, region, thread);
  });
}

}  // namespace

void blend_water(FrameData& f, const FrameKernels& kernels, const MethodKernels& method, const WaterPass& water,
                 ThreadPool& pool, StageClock& clock) {
  if (!f.blended.any()) return;
  blend_water_pass(f, kernels, method, water, pool);
  if (water.mirrors) blend_water_pass(f, kernels, method, mirrored_pass(water), pool);
  clock.lap("blended.water");
}

void blend_direct(FrameData& f, const FrameKernels& kernels, ThreadPool& pool, StageClock& clock) {
  if (!f.blended.any()) return;
  pool.for_each(f.blended.bins.work_items.size(),
                [&](std::size_t work_item, int) { kernels.blended_front_end(f, nullptr, work_item); });
  pool.for_each(region_count(f), [&](std::size_t region, int thread) { kernels.blend_direct(f, region, thread); });
  clock.lap("blended.direct");
}

}  // namespace shoal
