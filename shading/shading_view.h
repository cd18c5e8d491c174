// What shading reads of a scene: plain data without lanes, the same for every instruction set.
#pragma once

#include <cstdint>

#include "raster/geometry_view.h"
#include "shading/light_medium.h"
#include "shading/material.h"

namespace shoal {

struct SunShadows;

// Sixteen points that may lie in the sun's shadow.
struct alignas(64) ShadowQuery {
  float position_world[3][16];
  float facet_world[3][16];  // unit: the normal of each point's own triangle, on either side
};

// Shadows by rays instead of maps: a function of a room that shading does not include.
struct ShadowRays {
  // Which points the sun does not reach. `bend` is of the water above the points, null in the air; bit i of `lanes`
  // stands for point i, and the result has bits of `lanes` alone.
  std::uint32_t (*blocked)(const void* context, const ShadowQuery&, const SunBend* bend, std::uint32_t lanes) = nullptr;
  const void* context = nullptr;
};

// Everything that it points to outlives it.
struct ShadingView {
  GeometryView geometry;
  const Material* materials = nullptr;  // with the frame's texture filtering
  const Texture* textures = nullptr;    // that the materials refer to
  const Lighting* lighting = nullptr;
  const SunShadows* sun_shadows = nullptr;  // maps: null or empty where there are none
  ShadowRays shadow_rays;                   // blocked == nullptr: there are none, and maps are read
};

}  // namespace shoal
