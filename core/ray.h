// A ray, and how it changes from pixel to pixel.
#pragma once

#include "core/vec.h"

namespace shoal {

template <class F>
struct Ray {
  Vec3<F> origin_world;
  Vec3<F> direction_world;  // of any length; see View for the rays of a camera
};

// The change of a ray over one pixel to the right (dx) and over one pixel down (dy).
template <class F>
struct RayDifferential {
  Vec3<F> origin_dx, origin_dy;
  Vec3<F> direction_dx, direction_dy;
};

}  // namespace shoal
