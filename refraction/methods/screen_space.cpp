// screen-space: the refracted ray, marched through the depth of the frame without its water. What the eye's straight
// rays do not see is missing.
//
// Source  McGuire and Mara 2014, Listing 2; as Liu et al. 2020 compare with it (Figs. 4, 10 and 11).
// Differs The jitter is a fixed 4 x 4 pattern (Bayer's) in place of one of pixel coordinates and time. Where the ray
//         leaves the frame, runs out of steps or of length, the pixel's own unrefracted colour shows.
#include "refraction/methods/image_space.h"
#include "refraction/narrow/march_depth.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

struct Options {
  float stride = 1, thickness = 0.5f, jitter = 0;
  int max_steps = 512;
  float max_distance = 100;
};
constexpr MethodOption kOptions[] = {
    method_option<&Options::stride>("stride", 1, 64, "pixels a step"),
    method_option<&Options::thickness>("thickness", 0.001f, 1000, "metres that what is drawn reaches back"),
    method_option<&Options::jitter>("jitter", 0, 1, "of the first step, in strides"),
    method_option<&Options::max_steps>("max-steps", 1, 16384, "steps of the march"),
    method_option<&Options::max_distance>("max-distance", 0.01f, 1e6f, "metres that the refracted ray goes"),
};

struct ScreenSpace : StraightRays {
  static constexpr bool kWholeScene = true;

  static LayerPlace<WideF> sample_place(const SampleIn& in) { return marched_place(in, in.at.refracted); }
  static LayerPlace<WideF> planar_place(const SampleIn& in) {
    return marched_place(in, mirrored_direction(in, in.at.reflected));
  }

  //   direction  of the ray in the layer's space
  static LayerPlace<WideF> marched_place(const SampleIn& in, const Vec3<WideF>& direction) {
    alignas(64) static constexpr float kBayer[16] = {0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};
    const Options& options = in.options<Options>();
    DepthMarch how;
    how.stride_px = options.stride;
    how.thickness_m = options.thickness;
    how.max_steps = options.max_steps;
    const WideF jitter = WideF::load(kBayer) * WideF(options.jitter / 16.0f);
    const Vec3<WideF> from = in.at.crossing_world;
    return march_depth(in, from, from + direction * WideF(options.max_distance), jitter, how).place;
  }
};

}  // namespace

Method screen_space() {
  return image_space_method<ScreenSpace>("screen-space",
                                         "the refracted ray marched through the depth of the frame without its water",
                                         "McGuire and Mara 2014", option_list<Options>(kOptions));
}

}  // namespace shoal::inline SHOAL_ISA_NS
