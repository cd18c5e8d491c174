// One item of a pass through the front end: a run of the scene's chunks, by the pass's vertex program, into its bins.
#pragma once

#include "refraction/water_programs.h"

namespace shoal::inline SHOAL_ISA_NS {

template <class Program>
SHOAL_INLINE void opaque_item(FrameData& f, const Program& program, const PassSettings& pass, std::size_t item) {
  const std::uint32_t first = static_cast<std::uint32_t>(item) * f.bins.chunks_per_item;
  const std::uint32_t end = first + f.bins.chunks_per_item;
  FrontEnd<Program>(f.geometry, program, pass, f.bins.items[item])
      .run(first, end < f.bins.chunk_count ? end : f.bins.chunk_count, kNoId);
}

// The same of the blended chunks.
//   in_region  a water pass: into the layers' tiles, where they are drawn
template <class Program>
void blended_item(FrameData& f, const Program& program, const PassSettings& like, bool in_region, std::size_t item) {
  PassSettings pass = like;
  pass.skip_blended = false;
  pass.grid = in_region ? f.layers.regions : f.blended.grid;
  pass.tile_active = in_region ? f.layer_regions.data() : nullptr;
  PassBins& bins = f.blended.bins;
  const std::uint32_t first = static_cast<std::uint32_t>(item) * bins.chunks_per_item;
  const std::uint32_t left = bins.chunk_count - first;
  const std::uint32_t count = left < bins.chunks_per_item ? left : bins.chunks_per_item;
  FrontEnd<Program>(f.geometry, program, pass, bins.items[item]).run(f.blended.chunks.data() + first, count);
}

}  // namespace shoal::inline SHOAL_ISA_NS
