// Colours of error maps: dark to bright, violet to yellow, lightness rising throughout, so that they also read in grey.
#pragma once

#include <cstdint>
#include <vector>

#include "compare/hits.h"

namespace shoal {

struct Rgb8 {
  std::uint8_t r, g, b;
};

// t in [0, 1]; beyond: the ends. After Smith and van der Walt's "magma" (2015, CC0), nine of its colours interpolated.
Rgb8 magma(double t);

// FLIP's error, 0 to 1, in magma; pixels that do not count in `mask` at a quarter of their colour.
std::vector<std::uint8_t> flip_map_rgb(const std::vector<float>& error, const PixelMask& mask);

// The hit error's scale: its logarithm from here to there.
inline constexpr double kHitScaleLow_px = 0.01, kHitScaleHigh_px = 100;
inline constexpr Rgb8 kNoWaterColor{28, 34, 40}, kSameKindColor{60, 72, 84}, kWrongKindColor{64, 224, 208};

// The hit error in magma by its logarithm; grey where there is no water, a lighter grey where truth and method show the
// same kind that is no surface, turquoise where they show different kinds.
std::vector<std::uint8_t> hit_map_rgb(const HitComparison& hits);

}  // namespace shoal
