// screen-space: the refracted ray, marched through the depth of the frame without its water. What the eye's straight
// rays do not see is missing.
//
// Source  McGuire and Mara 2014, Listing 2; as Liu et al. 2020 compare with it (Figs. 4, 10 and 11).
// Differs The jitter is a fixed 4 x 4 pattern (Bayer's) in place of one of pixel coordinates and time. Where the ray
//         leaves the frame, runs out of steps or of length, the pixel's own unrefracted colour shows.
#include "refraction/narrow/march_depth.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

enum Option { kStride, kThickness, kJitter, kMaxSteps, kMaxDistance, kOptionCount };
constexpr MethodOption kOptions[kOptionCount] = {
    {"stride", "1", "pixels a step", MethodOption::Kind::kFloat, 1, 64},
    {"thickness", "0.5", "metres that what is drawn reaches back", MethodOption::Kind::kFloat, 0.001f, 1000},
    {"jitter", "0", "of the first step, in strides", MethodOption::Kind::kFloat, 0, 1},
    {"max-steps", "512", "of the march", MethodOption::Kind::kInt, 1, 16384},
    {"max-distance", "100", "metres that the refracted ray goes", MethodOption::Kind::kFloat, 0.01f, 1e6f},
};

struct ScreenSpace : StraightRays {
  static constexpr bool kShadesBefore = true, kWholeScene = true;

  static LayerPlace look(const LookUp& l) {
    alignas(64) static constexpr float kBayer[16] = {0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};
    const float* option = l.f.method_option;
    DepthMarch how;
    how.stride_px = option[kStride];
    how.thickness_m = option[kThickness];
    how.max_steps = static_cast<int>(option[kMaxSteps]);
    const WideF jitter = WideF::load(kBayer) * WideF(option[kJitter] / 16.0f);
    const Vec3<WideF> from = l.at.crossing_world;
    return march_depth(l, from, from + l.at.refracted * WideF(option[kMaxDistance]), jitter, how).place;
  }
};

}  // namespace

Method screen_space() {
  return {"screen-space",
          "the refracted ray marched through the depth of the frame without its water",
          "McGuire and Mara 2014",
          ShadeBeforeStages<ScreenSpace>::kernels(),
          kOptions,
          kOptionCount};
}

}  // namespace shoal::inline SHOAL_ISA_NS
