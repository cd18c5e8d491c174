// What rays are traced against. Only hybrid and traced methods, and the shared stages for traced reflections and shadow
// rays, receive it: a raster method has no way to it.
#pragma once

#include "trace/bvh16.h"
#include "trace/ray_queries.h"

namespace shoal {

// Both structures outlive the frame and are not written by it.
struct TraceView {
  const Bvh16* bvh = nullptr;        // over the opaque triangles, in scenes with water
  const RayQueries* rays = nullptr;  // of the reference and of traced shadows, else null
};

}  // namespace shoal
