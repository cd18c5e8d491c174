// One work_item of a pass through the front end: a run of the scene's meshlets, by the pass's vertex program, into its bins.
#pragma once

#include "refraction/passes/water_programs.h"

namespace shoal::inline SHOAL_ISA_NS {

template <class Program>
SHOAL_INLINE void opaque_work_item(FrameData& f, const Program& program, const PassSettings& pass, std::size_t work_item) {
  const std::uint32_t first = static_cast<std::uint32_t>(work_item) * f.bins.meshlets_per_work_item;
  const std::uint32_t end = first + f.bins.meshlets_per_work_item;
  FrontEnd<Program>(f.geometry, program, pass, f.bins.work_items[work_item])
      .run(first, end < f.bins.meshlet_count ? end : f.bins.meshlet_count, kNoId);
}

// The same of the blended meshlets.
//   in_region  a water pass: into the layers' tiles, where they are drawn
template <class Program>
void blended_work_item(FrameData& f, const Program& program, const PassSettings& like, bool in_region, std::size_t work_item) {
  PassSettings pass = like;
  pass.skip_blended = false;
  pass.grid = in_region ? f.layers.regions : f.blended.grid;
  pass.tile_active = in_region ? f.layer_regions.data() : nullptr;
  PassBins& bins = f.blended.bins;
  const std::uint32_t first = static_cast<std::uint32_t>(work_item) * bins.meshlets_per_work_item;
  const std::uint32_t left = bins.meshlet_count - first;
  const std::uint32_t count = left < bins.meshlets_per_work_item ? left : bins.meshlets_per_work_item;
  FrontEnd<Program>(f.geometry, program, pass, bins.work_items[work_item]).run(f.blended.meshlets.data() + first, count);
}

}  // namespace shoal::inline SHOAL_ISA_NS
