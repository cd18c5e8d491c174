// What the surface of a body of water does: the user's settings, plain data (DESIGN: `surface`).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace shoal {

enum class SurfaceKind : std::uint8_t {
  kFlat,
  kPerlin,
  kGradientWaves,
  kRipples,
  kRippleFilter,
  kGerstner,
  kSpectrum,
  kSum,
};
enum class WaterGeometry : std::uint8_t { kNormals, kDisplaced };
// Fade curves of gradient noise: Li et al. eq. 2 (quintic, smooth curvature) and eq. 1 (cubic).
enum class NoiseFade : std::uint8_t { kQuintic, kCubic };
// How a ripple dies away with distance and time (Champandard 1999).
enum class RippleFalloff : std::uint8_t { kLinear, kExponential };

// Are the waves filtered over a pixel's footprint (water/filter_surface.h)?
enum class WaveFilter : std::uint8_t { kFootprint, kNone };

// A drop that falls at a place of the plane (metres along axis_x and axis_z from the origin) at a time.
struct RippleDrop {
  float x_m = 0, z_m = 0, time_s = 0;
};

// What is empty has the kind's own default (resolve_surface).
struct SurfaceSettings {
  SurfaceKind kind = SurfaceKind::kFlat;
  WaterGeometry geometry = WaterGeometry::kNormals;
  // RMS of the slope over the body, >= 0; it sets the amplitude. Or the amplitude itself, metres: the greatest height
  // of the longest wave. Slope wins where both are given.
  std::optional<float> slope, amplitude_m;
  std::optional<float> wavelength_m;  // > 0: the longest wave; of noise, the side of a cell of the coarsest layer
  std::optional<int> octaves;         // 1 to 8: layers of noise, waves of gerstner
  float lacunarity = 2.0f;            // each octave's frequency over the last one's, 1 to 4
  float gain = 0.5f;                  // each octave's amplitude over the last one's, 0 to 1
  float speed = 1.0f;                 // factor on time; 0 stands still
  std::uint32_t seed = 1;
  NoiseFade fade = NoiseFade::kQuintic;
  // ripples, ripple-filter
  int sources = 4;                // drops in a lifetime, at places by seed, where `drops` is empty
  std::vector<RippleDrop> drops;  // each falls once
  RippleFalloff falloff = RippleFalloff::kLinear;
  std::optional<float> reach_m;  // > 0: linear: where a ripple ends; exponential: where 1/e of it is left
  float lifetime_s = 4.0f;       // > 0: the same in time; ripple-filter: in which 1/e of a height is left
  // Points a side. ripples: 2 to 1024 to sample them on, 0: exact; spectrum: 16 to 512, a power of two; ripple-filter:
  // 16 to 1024 along the longer side, 0: eight a wavelength, at most 512.
  int grid = 0;
  // gerstner
  float choppiness = 1.0f;  // 0 (plain sines) to 1 (trochoids)
  float direction_deg = 0;  // where the longest wave goes, from +x to +z
  // spectrum: the waves go towards direction_deg
  std::optional<float> tile_m;  // > 0: it repeats after so many metres each way
  // A sum is filtered where all of its parts are.
  WaveFilter filter = WaveFilter::kFootprint;
  // sum
  std::vector<SurfaceSettings> parts;
};

// The settings with every empty optional filled in by its kind's default; parts alike.
SurfaceSettings resolve_surface(const SurfaceSettings& settings);

}  // namespace shoal
