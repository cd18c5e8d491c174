// One sample of a frame as the stages see it: the camera, and what becomes of the sample.
#pragma once

#include <cstdint>

#include "raster/camera.h"
#include "raster/cull.h"
#include "raster/setup.h"

namespace shoal {

// The renderer sets it for each sample; eye_in_water is set by the water stage. All else reads it.
struct ViewState {
  View view;
  Frustum frustum;           // of the whole frame
  PassSettings direct_pass;  // of the direct pass
  int sample = 0, sample_count = 1;
  bool capture = false;     // G-buffer, interface and hit points are stored whole (the sample at the pixel's centre)
  bool accumulate = true;   // the sample enters the picture
  bool last_sample = true;  // the picture is encoded after it
  std::int32_t eye_in_water = -1;  // index of the body that the eye is in, or -1
};

}  // namespace shoal
