// How flat water bends the sun's light.
#pragma once

#include "shading/light_medium.h"
#include "water/body.h"

namespace shoal {

// Planes that the sun grazes at less than this cosine bend nothing: their shear would have no bound.
inline constexpr float kMinSunCosine = 0.05f;

// The refraction of sunlight at a body's flat surface.
//   body       its plane and index of refraction
//   direction  unit, world: the way that the light travels
// Returns where the light goes on below the plane; not bent where the sun is below the plane or grazes it, and where
// the index is 1.
// Source: Snell's law; the shear is the difference of both rays' ways along the plane for each metre of depth.
// Error: 3e-7 of the direction; 3 m along the bent ray the shear is within 3e-6 m, against double
//        (tests/refraction/test_shadow.cpp).
SunBend bend_of(const WaterBody& body, Vec3f direction);

}  // namespace shoal
