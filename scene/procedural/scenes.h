// The built-in scenes, one file each, and functions that they share: cameras, water and the sun.
#pragma once

#include "scene/scene.h"

namespace shoal {

Scene make_pool(std::uint64_t triangles);
Scene make_box(std::uint64_t triangles);
Scene make_ball(std::uint64_t triangles);
Scene make_knot(std::uint64_t triangles);
Scene make_furnace(std::uint64_t triangles);
Scene make_tank(std::uint64_t triangles);
Scene make_pond(std::uint64_t triangles);

// Adds a camera at `at` that looks at `target` with +y up.
//   yfov  radians
void add_camera(Scene& scene, const char* name, Vec3f at, Vec3f target, float yfov);

// Adds horizontal water at `at`.
void add_water(Scene& scene, const char* name, Vec3f at, const WaterSpec& spec);

// Adds a directional light and a clear sky.
//   to_sun     towards the light, of any length
//   intensity  irradiance over `color`, lux in glTF's terms
void add_sun(Scene& scene, Vec3f to_sun, Vec3f color, float intensity);

}  // namespace shoal
