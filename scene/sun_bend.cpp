#include "scene/sun_bend.h"

#include <cmath>

#include "core/vec_lanes.h"

namespace shoal {

SunBend bend_of(const WaterBody& body, Vec3f direction) {
  SunBend bend;
  const float cosine = -dot(direction, body.normal), eta = 1.0f / body.ior;
  const float cosine2_below = 1.0f - eta * eta * (1.0f - cosine * cosine);
  if (cosine < kMinSunCosine || cosine2_below < kMinSunCosine * kMinSunCosine || body.ior == 1.0f) return bend;
  const float cosine_below = std::sqrt(cosine2_below);
  bend.bent = true;
  bend.origin = body.origin;
  bend.normal = body.normal;
  bend.refracted_world = normalize(direction * eta + body.normal * (eta * cosine - cosine_below));
  const Vec3f along = direction + body.normal * cosine;  // of the incident ray, along the plane
  bend.shear = along * (1.0f / cosine - eta / cosine_below);
  return bend;
}

}  // namespace shoal
