#include "scene/light_medium.h"

#include "scene/sun_bend.h"
#include "water/optics.h"

namespace shoal {

LightMedium light_medium(const WaterBody& body, const Lighting& lighting, std::int32_t sun_map) {
  LightMedium medium;
  medium.plane_origin = body.origin, medium.plane_normal = body.normal;
  medium.absorption_per_m = body.absorption_per_m;
  medium.sun_map = sun_map;
  float cosine = 1.0f;
  if (!lighting.directional.empty()) {
    const Vec3f direction = lighting.directional[0].direction_world;
    cosine = min(max(-dot(direction, body.normal), 0.05f), 1.0f);
    medium.bend = bend_of(body, direction);
  }
  const float eta = 1.0f / body.ior;
  const float sine2 = eta * eta * (1.0f - cosine * cosine);
  const float cosine_water = sqrt(max(1.0f - sine2, 0.01f));
  medium.path_per_depth = 1.0f / cosine_water;
  medium.transmitted = 1.0f - fresnel_dielectric(cosine, eta);
  return medium;
}

}  // namespace shoal
