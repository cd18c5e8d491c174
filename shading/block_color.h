// The colour of one block of pixels before exposure and tone mapping.
#pragma once

#include "core/vec_lanes.h"

namespace shoal::inline SHOAL_ISA_NS {

struct BlockColor {
  Vec3<WideF> radiance{WideF(0.0f), WideF(0.0f), WideF(0.0f)};
  WideF covered{0.0f};  // the share of each pixel that the scene covers of the background
};

}  // namespace shoal::inline SHOAL_ISA_NS
