// Sunlight under water as plain data, apart from the body of water itself (scene/light_medium.h makes it from one).
#pragma once

#include <cstdint>

#include "core/vec.h"

namespace shoal {

// The refraction of parallel sunlight at one plane.
struct SunBend {
  bool bent = false;      // false: the light goes straight on, and the rest is not set
  Vec3f origin, normal;   // of the plane; the sun is on the normal's side
  Vec3f shear;            // metres along the plane for each metre of depth
  Vec3f refracted_world;  // unit: the direction in which the light travels below the plane
};

// How sunlight reaches points in a body of water.
struct LightMedium {
  Vec3f plane_origin{0, 0, 0}, plane_normal{0, 1, 0};  // of the flat surface; normal: unit
  Vec3f absorption_per_m{0, 0, 0};
  float path_per_depth = 1;  // metres along the refracted sunlight for each metre of depth: 1 / cosine under water
  float transmitted = 1;     // share that passes the flat surface: 1 less Fresnel's reflectance
  SunBend bend;              // for shadow rays
  std::int32_t sun_map = 0;  // into SunShadows::maps
};

}  // namespace shoal
