// Uniform surfaces by roughness and view, for tests of a furnace: light of one colour from everywhere.
#pragma once

#include <cmath>
#include <vector>

#include "shading/light.h"

namespace furnace {

using namespace shoal;

inline Vec3d unit(Vec3d v) { return v * (1.0 / std::sqrt(dot(v, v))); }
inline Vec3f to_float3(Vec3d v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }

inline SurfaceSample<float> surface(Vec3f normal, Vec3f color, float metallic, float roughness) {
  SurfaceSample<float> s{};
  s.normal_world = normal;
  s.base_color = color;
  s.alpha = 1;
  s.metallic = metallic;
  s.roughness = roughness;
  return s;
}

// Calls see(metallic, light to the eye) for a surface of each roughness, metal or not, seen at each cosine to its
// normal.
template <class See>
void each_surface(const Lighting& lighting, Vec3d normal, float grey, const std::vector<double>& roughnesses,
                  const std::vector<double>& cosines, See see) {
  const Vec3d aside = unit(cross(normal, std::fabs(normal.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1}));
  for (const double roughness : roughnesses) {
    for (const double cosine : cosines) {
      const Vec3f v = to_float3(normal * cosine + aside * std::sqrt(1 - cosine * cosine));
      for (const float metallic : {0.0f, 1.0f}) {
        const auto s = surface(to_float3(normal), {grey, grey, grey}, metallic, static_cast<float>(roughness));
        see(metallic, shade<float>(s, false, v, lighting, {1, 1, 1}));
      }
    }
  }
}

}  // namespace furnace
