// A body of water: a flat piece of plane, what is under it, and what its surface does.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/vec.h"
#include "water/surface_settings.h"

namespace shoal {

// All in world space and metres. axis_x, normal and axis_z are unit and orthogonal; a point's height above the plane is
// dot(p - origin, normal).
struct WaterBody {
  std::string name;
  std::uint32_t node = 0xFFFFFFFFu;
  Vec3f origin{0, 0, 0};
  Vec3f axis_x{1, 0, 0};
  Vec3f normal{0, 1, 0};
  Vec3f axis_z{0, 0, 1};
  // Outline on the plane: a triangle list of world positions, counter-clockwise seen from +normal.
  std::vector<Vec3f> outline;
  float depth_m = 0;                            // reach below the plane; the camera is in the water inside of it
  float ior = 1.333f;                           // 1/3 to 3
  Vec3f absorption_per_m{0.35f, 0.07f, 0.03f};  // Beer-Lambert
  SurfaceSettings surface;
};

}  // namespace shoal
