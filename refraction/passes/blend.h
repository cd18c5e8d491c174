// Blended materials: glass and the like, exact for any order of their triangles.
//
// They never enter the opaque visibility buffers. Their meshlets go through the front ends of the same passes (direct,
// refracted, mirrored) into bins of their own; each sample's fragments in front of what the pass shows are sorted by
// (depth, id) and composited front to back into the pass's BlendLayer. Shading lays the layers over what is behind: the
// refracted and mirrored ones over what those rays show, the direct one over the opaque scene or the water. Each
// fragment's light is absorbed along its own way through the water.
//
// Depth, ids, G-buffer and hit buffers stay those of the opaque scene and the water. Blended materials cast no shadow.
// A scene without any pays a branch a stage.
#pragma once

#include "core/thread_pool.h"
#include "refraction/frame_data.h"
#include "refraction/kernels.h"
#include "refraction/stage_clock.h"

namespace shoal {

// Finds the scene's blended meshlets and, where there are any, makes room for them. Once a renderer.
void find_blended(FrameData& f, int threads);

// Empties the layers, for a new sample.
void clear_blended(FrameData& f);

// What is blended along the rays of a body's water pixels, once its narrow phase is done.
void blend_water(FrameData& f, const FrameKernels& kernels, const MethodKernels& method, const WaterPass& water,
                 ThreadPool& pool, StageClock& clock);

// What is blended in front of all that.
void blend_direct(FrameData& f, const FrameKernels& kernels, ThreadPool& pool, StageClock& clock);

}  // namespace shoal
