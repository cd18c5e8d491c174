// Surfaces of every kind, for tests that walk them.
#pragma once

#include <string>
#include <vector>

#include "water/prepare_surface.h"

namespace surface_cases {

using namespace shoal;

struct Case {
  std::string name;
  SurfaceSettings settings;
};

inline SurfaceSettings of_kind(SurfaceKind kind) {
  SurfaceSettings s;
  s.kind = kind;
  s.seed = 7;
  return s;
}

inline std::vector<Case> all() {
  std::vector<Case> cases;
  for (const int octaves : {1, 4, 8}) {
    SurfaceSettings s = of_kind(SurfaceKind::kPerlin);
    s.octaves = octaves;
    cases.push_back({"perlin " + std::to_string(octaves), s});
  }
  SurfaceSettings cubic = of_kind(SurfaceKind::kPerlin);
  cubic.fade = NoiseFade::kCubic;
  cubic.octaves = 2;
  cubic.lacunarity = 1.7f;
  cases.push_back({"perlin cubic", cubic});
  cases.push_back({"gradient-waves", of_kind(SurfaceKind::kGradientWaves)});
  cases.push_back({"ripples", of_kind(SurfaceKind::kRipples)});
  SurfaceSettings exponential = of_kind(SurfaceKind::kRipples);
  exponential.falloff = RippleFalloff::kExponential;
  exponential.sources = 9;
  cases.push_back({"ripples exponential", exponential});
  for (const int octaves : {1, 5}) {
    SurfaceSettings s = of_kind(SurfaceKind::kGerstner);
    s.octaves = octaves;
    s.slope = 0.2f;
    cases.push_back({"gerstner " + std::to_string(octaves), s});
  }
  SurfaceSettings sea = of_kind(SurfaceKind::kSpectrum);
  sea.grid = 64;
  cases.push_back({"spectrum", sea});
  SurfaceSettings filter = of_kind(SurfaceKind::kRippleFilter);
  filter.wavelength_m = 1.0f;
  cases.push_back({"ripple-filter", filter});
  SurfaceSettings sum = of_kind(SurfaceKind::kSum);
  sum.parts = {of_kind(SurfaceKind::kGerstner), cubic};
  cases.push_back({"sum", sum});
  return cases;
}

inline constexpr PlaneExtent kBody = {-12.0f, -7.0f, 12.0f, 9.0f};

}  // namespace surface_cases
