// Paths from water to water.
#pragma once

#include "water/nearest_water.h"

namespace shoal::inline SHOAL_ISA_NS {

inline constexpr std::int32_t kAir = -1;

// How far paths are followed; a ray beyond sees the background.
struct TraceLimits {
  int depth = 4;          // surfaces of water that a path may meet, and one
  float weight = 0.001f;  // rays that count for less are not followed
  bool reflection = true, refraction = true;
};

// Sixteen rays on their way.
struct Path : WaterQuery {
  RayDifferential<WideF> differential;
  Vec3<WideF> weight = broadcast<WideF>(Vec3f{1, 1, 1});  // of what they bring
  WideF clear = WideF(1.0f);                              // what blended triangles on the way let through, beside that
  int level = 1;                                          // 1: from the eye
  std::int32_t medium = kAir;                             // the body of water that they are in
  // What they see where they leave the scene: the background along them, or, mirrored by filtered water, this.
  const Vec3<WideF>* seen_beyond = nullptr;
  // Of the water pixels' hit buffers, at the pixel's centre: what these lanes meet is what the pixel shows.
  WideM shows = mask_from_bits(0);
  HitKind shown_as = HitKind::kSurface;
  std::int32_t first_body = kNowhere;  // that the eye sees
};

// Light that paths bring which are about to meet water again, to the standard limits; the hit buffers of the lanes that
// show it are filled. Rays are looked up in the scene (trace/nearest_hit.h); blended materials on their way
// are not seen.
Vec3<WideF> follow_again(FrameData& f, const Block& block, const Path& path);

}  // namespace shoal::inline SHOAL_ISA_NS
