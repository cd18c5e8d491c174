// One frame, start to end.
#pragma once

#include "core/thread_pool.h"
#include "refraction/frame_data.h"
#include "refraction/kernels.h"
#include "refraction/stage_clock.h"

namespace shoal {

// Renders one sample of every pixel into frame's buffers; the last sample completes the picture.
void render_sample(FrameData& frame, const FrameKernels& kernels, const MethodKernels& method, ThreadPool& pool,
                   StageClock& clock, class StageDigests* digests);

}  // namespace shoal
