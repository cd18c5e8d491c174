// What tests hand to the oracle and to the renderer alike, and how they read a frame's buffers.
#pragma once

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "refraction/renderer.h"
#include "tests/refraction/double_vector.h"
#include "water/prepare_surface.h"

namespace shoal_test {

// The surfaces of a scene's bodies at a time: numbers, which the oracle evaluates by formulas of its own.
inline std::vector<WaterSurface> surfaces_at(const RenderScene& scene, double time_s) {
  std::vector<WaterSurface> surfaces;
  for (const WaterBody& body : scene.waters)
    surfaces.push_back(prepare_surface(body.surface, time_s, plane_extent(body)));
  return surfaces;
}

inline RenderScene built_in(const std::string& name, std::uint64_t triangles) {
  for (const ProceduralScene& s : procedural_scenes())
    if (name == s.name) return build_render_scene(s.make(triangles));
  return {};
}

inline Camera camera_at(Vec3f eye, Vec3f target, double yfov) {
  const Vec3d f = unit_of(as_double(target) - as_double(eye)), r = unit_of(cross(f, Vec3d{0, 1, 0})), u = cross(r, f);
  Camera c;
  c.position_world = eye;
  c.right_world = as_float(r), c.up_world = as_float(u), c.forward_world = as_float(f);
  c.tan_half_yfov = static_cast<float>(std::tan(0.5 * yfov));
  return c;
}

inline const AovImage& image_of(const Frame& frame, Aov aov) {
  for (const AovImage& image : frame.aovs)
    if (image.aov == aov) return image;
  throw std::runtime_error("no such AOV");
}
inline Vec3d vector_in(const AovImage& image, std::size_t pixel) {
  return {static_cast<double>(image.floats[3 * pixel]), static_cast<double>(image.floats[3 * pixel + 1]),
          static_cast<double>(image.floats[3 * pixel + 2])};
}

}  // namespace shoal_test
