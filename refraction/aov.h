// Buffers beside the picture, as images.
#pragma once

#include "refraction/frame_data.h"
#include "refraction/renderer.h"

namespace shoal {

// Fills out.aovs with what f.settings.aovs asks for.
void copy_aovs(const FrameData& f, const RenderScene& scene, Frame& out);
void copy_linear(const FrameData& f, Frame& out);

}  // namespace shoal
