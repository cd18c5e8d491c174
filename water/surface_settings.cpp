#include "water/surface_settings.h"

namespace shoal {
namespace {

struct Defaults {
  float slope, wavelength_m;
  int octaves;
};

// Of gradient-waves: Steel's own, whose RMS slope is 0.035 and whose coarser layer has cells of 0.364 m.
Defaults defaults_of(SurfaceKind kind) {
  switch (kind) {
    case SurfaceKind::kPerlin:
      return {0.05f, 1.0f, 4};
    case SurfaceKind::kGradientWaves:
      return {0.035f, 0.364f, 2};
    case SurfaceKind::kRipples:
      return {0.05f, 0.3f, 1};
    case SurfaceKind::kRippleFilter:
      return {0.05f, 0.3f, 1};
    case SurfaceKind::kGerstner:
      return {0.1f, 2.0f, 4};
    case SurfaceKind::kSpectrum:
      return {0.08f, 2.0f, 1};
    case SurfaceKind::kFlat:
    case SurfaceKind::kSum:
      break;
  }
  return {0.0f, 1.0f, 1};
}

}  // namespace

SurfaceSettings resolve_surface(const SurfaceSettings& settings) {
  SurfaceSettings s = settings;
  const Defaults defaults = defaults_of(s.kind);
  if (!s.wavelength_m) s.wavelength_m = defaults.wavelength_m;
  if (!s.octaves) s.octaves = defaults.octaves;
  if (!s.tile_m) s.tile_m = 8.0f * *s.wavelength_m;
  if (s.kind == SurfaceKind::kSpectrum) {
    int side = 16;
    while (2 * side <= (s.grid == 0 ? 128 : s.grid) && side < 512) side *= 2;
    s.grid = side;
  }
  if (!s.reach_m) s.reach_m = 10.0f * *s.wavelength_m;
  if (!s.slope && !s.amplitude_m && s.kind != SurfaceKind::kSum && s.kind != SurfaceKind::kFlat)
    s.slope = defaults.slope;
  for (SurfaceSettings& part : s.parts) part = resolve_surface(part);
  return s;
}

}  // namespace shoal
