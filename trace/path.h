// Paths from one water interface to the next.
#pragma once

#include "scene/hit_kind.h"
#include "water/nearest_water.h"

namespace shoal::inline SHOAL_ISA_NS {

inline constexpr std::int32_t kAir = -1;

// How far paths are traced; a ray beyond sees the background.
struct TraceLimits {
  int depth = 4;          // water interfaces that a path may cross, plus one
  float weight = 0.001f;  // rays of less weight are not traced
  bool reflection = true, refraction = true;
  bool reflects_scene = true;  // reflected rays may hit the scene, not the background alone (--reflections)
};

// Sixteen rays on their way.
struct Path : WaterQuery {
  RayDifferential<WideF> differential;
  Vec3<WideF> weight = broadcast<WideF>(Vec3f{1, 1, 1});  // of the light that they carry to the pixel
  WideF clear = WideF(1.0f);   // transmittance of the blended triangles on the way, not part of the weight
  int level = 1;               // 1: a ray from the eye
  std::int32_t medium = kAir;  // the body of water that the rays run through
  // The light of rays that leave the scene; null: the background along the ray. Set for rays that filtered waves
  // reflect.
  const Vec3<WideF>* seen_beyond = nullptr;
  // The lanes whose hit the pixel shows, for the hit buffers of the pixels' centres.
  WideM shows = mask_from_bits(0);
  HitKind shown_as = HitKind::kSurface;
  std::int32_t first_body = kNoBody;  // that the ray from the eye crossed
};

}  // namespace shoal::inline SHOAL_ISA_NS
