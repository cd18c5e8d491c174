// The displaced surface of the water in the direct pass.
#pragma once

#include "refraction/frame_data.h"

namespace shoal::inline SHOAL_ISA_NS {

void displaced_region(FrameData& f, std::size_t region);

}  // namespace shoal::inline SHOAL_ISA_NS
