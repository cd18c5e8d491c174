#include "compare/map_color.h"

#include <algorithm>
#include <cmath>

namespace shoal {

namespace {

constexpr Rgb8 kMagma[9] = {{0, 0, 4},      {28, 16, 68},   {79, 18, 123},   {129, 37, 129}, {181, 54, 122},
                            {229, 80, 100}, {251, 135, 97}, {254, 194, 135}, {252, 253, 191}};

void append(std::vector<std::uint8_t>& rgb, Rgb8 c) { rgb.insert(rgb.end(), {c.r, c.g, c.b}); }

}  // namespace

Rgb8 magma(double t) {
  const double at = std::clamp(t, 0.0, 1.0) * 8;
  const int i = std::min(static_cast<int>(at), 7);
  const Rgb8 a = kMagma[i], b = kMagma[i + 1];
  const auto mix = [&](std::uint8_t x, std::uint8_t y) {
    return static_cast<std::uint8_t>(x + (y - x) * (at - i) + 0.5);
  };
  return {mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b)};
}

std::vector<std::uint8_t> flip_map_rgb(const std::vector<float>& error, const PixelMask& mask) {
  std::vector<std::uint8_t> rgb;
  rgb.reserve(error.size() * 3);
  for (std::size_t i = 0; i < error.size(); ++i) {
    Rgb8 c = magma(static_cast<double>(error[i]));
    if (!mask.empty() && !mask[i]) {
      c = {static_cast<std::uint8_t>(c.r / 4), static_cast<std::uint8_t>(c.g / 4), static_cast<std::uint8_t>(c.b / 4)};
    }
    append(rgb, c);
  }
  return rgb;
}

std::vector<std::uint8_t> hit_map_rgb(const HitComparison& hits) {
  std::vector<std::uint8_t> rgb;
  rgb.reserve(hits.wrong.size() * 3);
  const double low = std::log10(kHitScaleLow_px), range = std::log10(kHitScaleHigh_px) - low;
  for (std::size_t i = 0; i < hits.wrong.size(); ++i) {
    if (!hits.water[i]) {
      append(rgb, kNoWaterColor);
    } else if (hits.wrong[i] & HitComparison::kWrongKind) {
      append(rgb, kWrongKindColor);
    } else if (hits.error_map_px[i] < 0) {
      append(rgb, kSameKindColor);
    } else {
      const double px = std::max(static_cast<double>(hits.error_map_px[i]), 1e-9);
      append(rgb, magma((std::log10(px) - low) / range));
    }
  }
  return rgb;
}

}  // namespace shoal
