// What rays are traced against. Only hybrid and traced methods, and the shared stages for traced reflections and shadow
// rays, receive it: a raster method has no way to it.
#pragma once

#include "trace/bvh16.h"

namespace shoal {

// Both outlive the frame and are not written by it.
struct TraceView {
  const Bvh16* bvh = nullptr;      // over the opaque triangles, where anything traces rays
  const Bvh16* blended = nullptr;  // over the blended ones, for traced methods; null: there are none
};

}  // namespace shoal
