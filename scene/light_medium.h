// A body of water as shading takes it.
#pragma once

#include <cstdint>

#include "shading/light_medium.h"
#include "shading/material.h"
#include "water/body.h"

namespace shoal {

// How the first directional light reaches points in a body's water; without one, light comes straight down.
//   body      its flat surface, index of refraction and absorption
//   lighting  of the scene
//   sun_map   the body's shadow map: SunShadows::map_index
// Returns the medium. The light's cosine to the surface counts as 0.05 to 1, and its squared cosine under water as at
// least 0.01.
LightMedium light_medium(const WaterBody& body, const Lighting& lighting, std::int32_t sun_map);

}  // namespace shoal
