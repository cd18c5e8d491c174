// The two passes of LDR-FLIP, compiled once an instruction set.
#pragma once

#include <vector>

#include "core/blocked_image.h"
#include "core/isa_dispatch.h"

namespace shoal {

// One half of a symmetric or antisymmetric filter: tap 0 in the middle, then to the right (down).
using HalfFilter = std::vector<float>;

// Filters at one resolution. The sums of all taps, or of the positive ones where there are both, are 1.
struct FlipFilters {
  HalfFilter achromatic, red_green;  // contrast sensitivity
  // Blue-yellow is a sum of two Gaussians; its rows carry each one's share.
  HalfFilter blue_yellow_wide, blue_yellow_wide_rows, blue_yellow_narrow, blue_yellow_narrow_rows;
  HalfFilter smooth, edge, point;  // a Gaussian, and its first (antisymmetric) and second derivative
  int reach_px = 0;                // the longest one's taps beside the middle
};

// A picture after the horizontal half of its filters; rows padded to sixteen pixels.
struct FlipRows {
  enum Plane { kAchromatic, kRedGreen, kBlueYellowWide, kBlueYellowNarrow, kSmooth, kEdge, kPoint, kPlanes };
  int width_px = 0, height_px = 0, stride_px = 0;
  AlignedArray<float> plane[kPlanes];
};

// What the linear picture goes through first, a channel at a time.
struct ToneCurve {
  bool aces = false;  // else clamped to [0, 1]
  float scale = 1;    // exposure
};

struct FlipKernels {
  // Rows [begin, end) of a linear RGB picture into the filtered planes.
  //   scratch  4 rows of stride + 2 reach + 32 floats
  void (*filter_rows)(const FlipFilters& filters, const ToneCurve& tone, const float* rgb, int begin, int end,
                      float* scratch, FlipRows& out);
  // The vertical half, and the error of pixels [x_begin, x_end) x [y_begin, y_end); x_begin is a multiple of 16. The
  // larger of the error and what is there is kept.
  void (*combine)(const FlipFilters& filters, const FlipRows& reference, const FlipRows& test, int x_begin, int x_end,
                  int y_begin, int y_end, float* error);
};

SHOAL_ISA_TABLE(FlipKernels, flip_kernels)

}  // namespace shoal
