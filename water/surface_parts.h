// How each kind of surface fills the data of a frame: internal to water/.
#pragma once

#include <vector>

#include "water/surface_data.h"
#include "water/surface_settings.h"

namespace shoal::surface_parts {

struct Request {
  const SurfaceSettings& settings;  // resolved
  float amplitude_m;
  double time_s;  // times the settings' speed
  PlaneExtent extent;
};

// Each adds its terms to the surface and its share to the bounds.
void add_perlin(const Request& request, WaterSurface& surface);
void add_gradient_waves(const Request& request, WaterSurface& surface);
void add_ripples(const Request& request, WaterSurface& surface);
void add_trochoids(const Request& request, WaterSurface& surface);
// The sea's waves at amplitude 1, once a body; and their sum at a time.
std::vector<float> spectrum_waves(const SurfaceSettings& settings);
void add_spectrum(const Request& request, const std::vector<float>& waves, WaterSurface& surface);
// What a spline's coefficients can do: greatest |height| and slope, no less than the spline's own.
void bound_spline(const SplineGrid& grid, const float* values, WaterSurface& surface);
// Once after all: trochoids bend one another, so their bounds and their push are those of all together.
void finish_trochoids(WaterSurface& surface);

// Seconds from a drop's fall until nothing is left of it.
double ripple_life_s(const SurfaceSettings& settings);

// Thirty-two well-mixed bits for the n-th of something that a seed chooses (Wang's hash, twice).
std::uint32_t hashed(std::uint32_t seed, std::uint32_t n);
// The same within 0..1.
double hashed_unit(std::uint32_t seed, std::uint32_t n);

// Bounds are widened by this for what rounding does to a sum.
inline constexpr float kBoundSlack = 1.001f;

}  // namespace shoal::surface_parts
