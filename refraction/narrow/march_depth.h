// A march through a depth buffer, along a straight line of the buffer's own space, a pixel or a few at a step.
//
// Source  McGuire and Mara 2014, Listing 2: end points to pixels, then linear steps of P, Q = X / w and k = 1 / w along
//         the longer axis; a hit where the step's range of depth meets [scene, scene + thickness].
// Differs Each step is worked out from its number, not added up. With thickness infinite the first step behind the
//         buffer counts, brought to where it was crossed (parallax occlusion mapping: Tatarchuk 2006).
#pragma once

#include "refraction/narrow/sample_place.h"

namespace shoal::inline SHOAL_ISA_NS {

struct DepthMarch {
  float stride_px = 1;    // > 0
  float thickness_m = 0;  // of what is drawn, along the view axis; > 0
  bool solid = false;     // what is drawn reaches back without end; thickness_m is not used
  int max_steps = 1;
};

struct MarchedPlace {
  LayerPlace<WideF> place;  // the texel hit; solid: between two texels, where the line went behind
  WideM hit;
};

//   in        the pixels
//   from, to  ends of the line in the space that the refracted layer is drawn in, world metres
//   jitter    of the first step, in strides, 0 to 1
// Returns the hit within the frame. A line that leaves the frame, goes behind the eye or runs out of steps hits
// nothing, and its place is the pixel's own.
MarchedPlace march_depth(const SampleIn& in, Vec3<WideF> from, Vec3<WideF> to, WideF jitter, const DepthMarch& how);

}  // namespace shoal::inline SHOAL_ISA_NS
