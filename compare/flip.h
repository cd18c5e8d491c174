// FLIP: how different two pictures look when one flips between them, 0 to 1 a pixel.
//
// LDR-FLIP filters both pictures as the eye's contrast sensitivity does at a distance, compares colours in a space of
// even steps, and raises the error where edges and points differ. HDR-FLIP is its maximum over a range of exposures.
//
// Source: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild: FLIP: A Difference Evaluator for
// Alternating Images, HPG 2020; Andersson, Nilsson, Shirley, Akenine-Moller: Visualizing Errors in Rendered High
// Dynamic Range Images, Eurographics 2021 (short papers).
#pragma once

#include <cstdint>
#include <vector>

#include "core/isa.h"
#include "core/thread_pool.h"

namespace shoal {

// Linear light, BT.709 primaries, rows from the top, RGB interleaved.
struct LinearPicture {
  int width_px = 0, height_px = 0;
  std::vector<float> rgb;
};

// Decodes sRGB.
//   rgb  3 codes a pixel, rows from the top
LinearPicture linear_from_srgb8(int width_px, int height_px, const std::uint8_t* rgb);

// The papers' default: 0.7 m from a monitor 0.7 m and 3840 pixels wide.
inline constexpr float kDefaultPixelsPerDegree = 67.02f;

struct FlipSettings {
  float pixels_per_degree = kDefaultPixelsPerDegree;  // 1 to 10000
  Isa isa = best_isa();                               // the bytes do not depend on it
};

// The error of each pixel, 0 to 1, rows from the top.
//
//   reference, test  of the same size; below 0 and NaN count as 0, above 1 as 1
// Equal bytes for any threads and ISA, and the same when the pictures are exchanged.
// Differs: filters are taken apart into rows and columns, which they are; taps below 1e-7 of the middle one are left
//          out. sRGB's white is that of the chromaticity (0.31271, 0.32902).
// Error: mean 0.0001 against published values (tests/compare/test_flip.cpp).
std::vector<float> ldr_flip(const LinearPicture& reference, const LinearPicture& test, const FlipSettings& settings,
                            ThreadPool& pool);

struct HdrFlip {
  std::vector<float> error;  // 0 to 1, rows from the top
  float first_stops = 0, last_stops = 0;
  int exposures = 0;
};

// The maximum over exposures, evenly between the one where the reference's brightest pixel and the one where its median
// luminance is tone mapped (ACES) to 0.85, about a stop apart, two at least.
//
//   reference, test  of the same size; below 0 and NaN count as 0, above 1e9 as 1e9
// Not the same when the pictures are exchanged: the exposures are the reference's.
// Differs: the median is over pixels that are not black, so that a half black picture has a range too; a black
//          reference has the one exposure of 0 stops.
HdrFlip hdr_flip(const LinearPicture& reference, const LinearPicture& test, const FlipSettings& settings,
                 ThreadPool& pool);

// The exposures of a reference: those three numbers without the error.
HdrFlip exposure_range(const LinearPicture& reference);

}  // namespace shoal
