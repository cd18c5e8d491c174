// Yee's perceptual metric, as OpenImageIO has it.
#pragma once

#include <cstdint>

#include "compare/flip.h"
#include "compare/statistics.h"

namespace shoal {

// Pixels in which an observer would see a difference, at 100 cd/m^2 of ambient light.
//
//   a, b             of the same size
//   mask             pixels that count: elsewhere b is taken as equal to a
//   fov_degrees      of the picture's width, as seen by the observer
//   threads          1 or more
// Slow: a pyramid of the whole picture.
// Source: Yee, Pattanaik, Greenberg 2001, as in OpenImageIO's compare_Yee.
// Differs: OpenImageIO 2.4 sees hardly any difference in luminance alone (a grey square on another grey counts 0).
std::uint64_t yee_failed_pixels(const LinearPicture& a, const LinearPicture& b, const PixelMask& mask,
                                float fov_degrees, int threads);

}  // namespace shoal
