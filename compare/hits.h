// Compares the hit buffers of a method with those of the reference: does the method show the right point?
#pragma once

#include <cstdint>
#include <vector>

#include "compare/statistics.h"
#include "refraction/renderer.h"

namespace shoal {

// What a frame must have been drawn with.
inline constexpr std::uint32_t kHitAovs =
    1u << static_cast<int>(Aov::kWaterMask) | 1u << static_cast<int>(Aov::kHitKind) |
    1u << static_cast<int>(Aov::kHitPosition) | 1u << static_cast<int>(Aov::kHitId) |
    1u << static_cast<int>(Aov::kHitSecondary);

// A point that is farther from the reference's than this is on the wrong surface.
inline constexpr double kWrongSurface_m = 0.1;

struct Percentiles {
  double median = 0, p95 = 0, p99 = 0;  // NaN where there is nothing
};

struct HitComparison {
  std::uint64_t water_pixels = 0;              // of the reference
  std::uint64_t compared_pixels = 0;           // where reference and method both show a surface
  Percentiles error_px, error_m;               // over these
  double wrong_object = 0, wrong_surface = 0;  // shares of water_pixels; NaN where there are none
  double secondary_share = 0;  // of water_pixels: the reference's ray crosses a secondary water interface
  double wrong_object_primary = 0, wrong_surface_primary = 0;  // shares of the other water pixels

  // Row by row from the top.
  PixelMask water;                  // the reference's
  std::vector<float> error_map_px;  // -1 where not both show a surface
  std::vector<std::uint8_t> wrong;  // bits of Wrong, 0 off the water
  enum Wrong : std::uint8_t { kWrongObject = 1, kWrongSurface = 2, kWrongKind = 4 };
};

// Compares what a method shows at the reference's water pixels with what the reference shows there.
//
//   scene              at the frames' time: its objects (a glTF primitive of a node each) and bodies of water
//   camera             of both frames
//   reference, method  frames of the same size with kHitAovs
// The hit error is the distance of the two points, in metres, and in pixels of the screen that both are mapped to
// through the pixel's body of water, taken flat; where one of them maps to behind the camera it is the frame's
// diagonal. A wrong object is another object or another kind of hit; a wrong surface a point more than kWrongSurface_m
// off, or another kind. Throws UsageError for frames of other sizes or without the buffers.
HitComparison compare_hits(const RenderScene& scene, const Camera& camera, const Frame& reference, const Frame& method);

// A buffer of a frame, or null.
const AovImage* find_aov(const Frame& frame, Aov aov);

}  // namespace shoal
