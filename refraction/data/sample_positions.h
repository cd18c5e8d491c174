// Where in a pixel its samples are.
#pragma once

#include "core/vec.h"

namespace shoal {

// Offset of sample s of n from the pixel's centre, in pixels: a multiple of 1/256, |offset| <= 1/2; one sample is the
// centre. The points are a Kronecker sequence, shifted so that it is even from its first point on.
//   s  0 to n - 1; n  1 to 256
// Source: Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences" (R2: steps 1/g, 1/g^2 with g the root
// of g^3 = g + 1). Differs: in integers of 2^-32, so that no rounding enters.
Vec2f sample_position(int s, int n);

}  // namespace shoal
