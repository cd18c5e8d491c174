// Blended materials of the direct pass.
#pragma once

#include "refraction/frame_data.h"

namespace shoal::inline SHOAL_ISA_NS {

// The blended bins over one region, into Blended::direct.
void blend_direct_region(FrameData& f, std::size_t region, int thread);

}  // namespace shoal::inline SHOAL_ISA_NS
