#include "water/prepare_surface.h"

#include <algorithm>
#include <cmath>

#include "water/surface.h"
#include "water/surface_parts.h"

namespace shoal {
namespace {

constexpr int kSlopeSamples = 16384, kTrochoidSamples = 4096;
// Of ripples, which live and die: prime, so that drops at regular intervals are met at all ages.
constexpr int kRippleTimes = 37, kRippleSamples = 2048;

// Mean of the squared slope over the extent: points of Roberts' R2 sequence, in 32-bit fixed point.
double mean_square_slope(const WaterSurface& surface, const PlaneExtent& e, int samples) {
  const double size_x = static_cast<double>(e.max_x_m) - static_cast<double>(e.min_x_m);
  const double size_z = static_cast<double>(e.max_z_m) - static_cast<double>(e.min_z_m);
  std::uint32_t u = 0x80000000u, v = 0x80000000u;
  double sum = 0;
  for (int i = 0; i < samples; ++i) {
    u += 3242174889u;  // 2^32 / 1.3247179572...
    v += 2447445414u;  // 2^32 / 1.3247179572...^2
    const double x = static_cast<double>(e.min_x_m) + size_x * (static_cast<double>(u) * 0x1p-32);
    const double z = static_cast<double>(e.min_z_m) + size_z * (static_cast<double>(v) * 0x1p-32);
    const SurfacePoint<float> p = surface_at(surface, static_cast<float>(x), static_cast<float>(z));
    const double sx = static_cast<double>(p.slope_x), sz = static_cast<double>(p.slope_z);
    sum += sx * sx + sz * sz;
  }
  return sum / samples;
}

WaterSurface at_time(const std::vector<SurfaceModel::Part>& parts, const PlaneExtent& extent, double time_s);

double rms_slope(const std::vector<SurfaceModel::Part>& parts, const PlaneExtent& extent) {
  const SurfaceModel::Part* fading = nullptr;
  for (const auto& part : parts) {
    if (part.settings.kind == SurfaceKind::kRipples || part.settings.kind == SurfaceKind::kRippleFilter) fading = &part;
  }
  if (fading == nullptr) {
    const WaterSurface surface = at_time(parts, extent, 0.0);
    const int samples = surface.trochoids.size() != 0 ? kTrochoidSamples : kSlopeSamples;
    return std::sqrt(mean_square_slope(surface, extent, samples));
  }
  // From the first drop to the end of the last one's life.
  const SurfaceSettings& s = fading->settings;
  double first = 0, last = 0;
  for (std::size_t i = 0; i < s.drops.size(); ++i) {
    const double t = static_cast<double>(s.drops[i].time_s);
    first = i == 0 ? t : std::min(first, t);
    last = i == 0 ? t : std::max(last, t);
  }
  const double speed = static_cast<double>(s.speed) > 0 ? static_cast<double>(s.speed) : 1.0;
  const double life =
      s.kind == SurfaceKind::kRipples ? surface_parts::ripple_life_s(s) : static_cast<double>(s.lifetime_s);
  const double span = last - first + life;
  double sum = 0;
  for (int i = 0; i < kRippleTimes; ++i) {
    const double time_s = (first + span * (i + 0.5) / kRippleTimes) / speed;
    sum += mean_square_slope(at_time(parts, extent, time_s), extent, kRippleSamples);
  }
  return std::sqrt(sum / kRippleTimes);
}

// Trochoids steepen with their height, so the factor is found by a few rounds; all else needs one.
void scale_to_slope(std::vector<SurfaceModel::Part>& parts, const PlaneExtent& extent, float slope) {
  bool linear = true;
  for (const auto& part : parts) linear = linear && part.settings.kind != SurfaceKind::kGerstner;
  for (int round = 0; round < (linear ? 1 : 4); ++round) {
    const double measured = rms_slope(parts, extent);
    const double factor = measured > 0 ? static_cast<double>(slope) / measured : 0.0;
    for (auto& part : parts) part.amplitude_m = static_cast<float>(static_cast<double>(part.amplitude_m) * factor);
  }
}

// Where a body has no area, eight waves each way.
PlaneExtent measured_extent(const PlaneExtent& e, const SurfaceSettings& settings) {
  if (e.max_x_m > e.min_x_m && e.max_z_m > e.min_z_m) return e;
  const float half = 4.0f * settings.wavelength_m.value_or(1.0f);
  return {-half, -half, half, half};
}

std::vector<SurfaceModel::Part> flattened(const SurfaceSettings& settings, const PlaneExtent& extent) {
  std::vector<SurfaceModel::Part> parts;
  if (settings.kind == SurfaceKind::kFlat) return parts;
  if (settings.kind == SurfaceKind::kSum) {
    for (const SurfaceSettings& part : settings.parts) {
      for (auto& piece : flattened(part, extent)) parts.push_back(std::move(piece));
    }
    // The sum's own slope or amplitude scales the whole.
    if (settings.slope) scale_to_slope(parts, measured_extent(extent, settings), *settings.slope);
    return parts;
  }
  parts.push_back({settings, settings.amplitude_m.value_or(1.0f), {}, nullptr});
  if (settings.kind == SurfaceKind::kSpectrum) parts[0].waves = surface_parts::spectrum_waves(settings);
  if (settings.kind == SurfaceKind::kRippleFilter)
    parts[0].filter = std::make_shared<RippleFilter>(settings, measured_extent(extent, settings));
  if (settings.slope) {
    // Near the answer already: trochoids fold when they are too high.
    if (settings.kind == SurfaceKind::kGerstner) parts[0].amplitude_m = 0.1f * *settings.slope * *settings.wavelength_m;
    scale_to_slope(parts, measured_extent(extent, settings), *settings.slope);
  }
  return parts;
}

WaterSurface at_time(const std::vector<SurfaceModel::Part>& parts, const PlaneExtent& extent, double time_s) {
  WaterSurface surface;
  const double time = std::min(std::max(time_s, -1e6), 1e6);
  for (const auto& part : parts) {
    surface.filtered = surface.filtered && part.settings.filter == WaveFilter::kFootprint;
    const surface_parts::Request request = {part.settings, part.amplitude_m,
                                            time * static_cast<double>(part.settings.speed), extent};
    switch (part.settings.kind) {
      case SurfaceKind::kPerlin:
        surface_parts::add_perlin(request, surface);
        break;
      case SurfaceKind::kGradientWaves:
        surface_parts::add_gradient_waves(request, surface);
        break;
      case SurfaceKind::kRipples:
        surface_parts::add_ripples(request, surface);
        break;
      case SurfaceKind::kRippleFilter:
        part.filter->add_to(request.time_s, request.amplitude_m, surface);
        break;
      case SurfaceKind::kGerstner:
        surface_parts::add_trochoids(request, surface);
        break;
      case SurfaceKind::kSpectrum:
        surface_parts::add_spectrum(request, part.waves, surface);
        break;
      case SurfaceKind::kFlat:
      case SurfaceKind::kSum:
        break;
    }
  }
  surface_parts::finish_trochoids(surface);
  return surface;
}

}  // namespace

PlaneExtent plane_extent(const WaterBody& body) {
  PlaneExtent e = {0, 0, 0, 0};
  for (std::size_t i = 0; i < body.outline.size(); ++i) {
    const Vec3f offset = body.outline[i] - body.origin;
    const float x = dot(offset, body.axis_x), z = dot(offset, body.axis_z);
    if (i == 0) e = {x, z, x, z};
    e = {std::min(e.min_x_m, x), std::min(e.min_z_m, z), std::max(e.max_x_m, x), std::max(e.max_z_m, z)};
  }
  return e;
}

SurfaceModel make_surface_model(const SurfaceSettings& settings, const PlaneExtent& extent) {
  SurfaceModel model;
  model.settings = resolve_surface(settings);
  model.extent = extent;
  model.parts = flattened(model.settings, extent);
  return model;
}

WaterSurface prepare_surface(const SurfaceModel& model, double time_s) {
  return at_time(model.parts, model.extent, time_s);
}

WaterSurface prepare_surface(const SurfaceSettings& settings, double time_s, const PlaneExtent& extent) {
  return prepare_surface(make_surface_model(settings, extent), time_s);
}

}  // namespace shoal
