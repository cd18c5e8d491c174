// Buffers beside the picture, as images.
#pragma once

#include <vector>

#include "refraction/data/targets.h"
#include "refraction/data/water_pass.h"
#include "refraction/renderer.h"

namespace shoal {

struct AovIn {
  const RenderScene& scene;
  const View& view;
  const FrameGrid& frame;
  const Targets& targets;
  const std::vector<WaterOptics>& water;
};

// Fills out.aovs with those of the mask, bit 1 << int(Aov).
void copy_aovs(const AovIn& in, std::uint32_t aovs, Frame& out);
void copy_linear(const Targets& targets, const FrameGrid& frame, Frame& out);

}  // namespace shoal
