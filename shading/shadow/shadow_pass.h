// The sun's depth passes.
#pragma once

#include "refraction/frame_data.h"

namespace shoal::inline SHOAL_ISA_NS {

// Item `work_item` of a shadow pass into its bins.
void shadow_front_end(const ShadowPass& pass, PassBins& bins, std::size_t work_item);
// Bins to depth, one tile: all passes of a map.
void draw_shadow_tile(const FrameData& f, const std::vector<ShadowPass>& passes, const std::vector<PassBins>& bins,
                      VisibilityBuffer& out, std::size_t tile);

}  // namespace shoal::inline SHOAL_ISA_NS
