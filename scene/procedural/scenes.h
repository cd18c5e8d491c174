// The built-in scenes, a file each, and what they share: placing cameras, water and the sun.
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

// A node at `at`, looking along its -z at `target`, with +y as near to up as can be.
//   yfov  radians
void add_camera(Scene& scene, const char* name, Vec3f at, Vec3f target, float yfov);

// Level water at `at`.
void add_water(Scene& scene, const char* name, Vec3f at, const WaterSpec& spec);

// A directional light and a clear sky around it.
//   to_sun     towards the light, of any length
//   intensity  irradiance over `color`, lux in glTF's terms
void add_sun(Scene& scene, Vec3f to_sun, Vec3f color, float intensity);

}  // namespace shoal
