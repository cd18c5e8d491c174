// Champandard's ripples and Gerstner's waves.
#include <algorithm>
#include <cmath>

#include "core/math.h"
#include "water/surface.h"
#include "water/surface_parts.h"

namespace shoal::surface_parts {
namespace {

constexpr double kGravity = 9.81;  // m/s^2
constexpr double kTurn = 6.283185307179586;

// After this many lifetimes an exponential ripple, at e^-6, is let end.
constexpr double kExponentialLives = 6.0;
// The share of the lifetime in which a ripple rises, so that none appears at once.
constexpr double kRise = 0.1;

// Fading with age, 0 to 1, continuous; 0 before the drop falls and after its life.
double time_fade(const SurfaceSettings& s, double age_s) {
  const double lifetime = static_cast<double>(s.lifetime_s), life = ripple_life_s(s);
  if (!(age_s > 0) || age_s >= life) return 0;
  const double rise = std::min(age_s / (kRise * lifetime), 1.0);
  if (s.falloff == RippleFalloff::kLinear) return rise * (1.0 - age_s / lifetime);
  const double end = static_cast<double>(det_exp(static_cast<float>(-kExponentialLives)));
  return rise * (static_cast<double>(det_exp(static_cast<float>(-age_s / lifetime))) - end) / (1.0 - end);
}

void add_source(const Request& request, double x_m, double z_m, double age_s, WaterSurface& surface) {
  const SurfaceSettings& s = request.settings;
  const double fade = time_fade(s, age_s);
  if (!(fade > 0)) return;
  const double wavelength = static_cast<double>(*s.wavelength_m);
  const double turns = -age_s * std::sqrt(kGravity / (kTurn * wavelength));  // deep water
  RippleSource source;
  source.x_m = static_cast<float>(x_m);
  source.z_m = static_cast<float>(z_m);
  source.soften2_m2 = static_cast<float>(wavelength * wavelength / 256.0);
  source.amplitude_m = static_cast<float>(static_cast<double>(request.amplitude_m) * fade);
  source.turns_per_m = 1.0f / *s.wavelength_m;
  source.phase_turns = static_cast<float>(turns - std::floor(turns));
  source.inverse_reach_per_m = 1.0f / *s.reach_m;
  source.exponential = s.falloff == RippleFalloff::kExponential ? 1 : 0;
  surface.ripples.push() = source;
}

void place_sources(const Request& request, WaterSurface& surface) {
  const SurfaceSettings& s = request.settings;
  const PlaneExtent& e = request.extent;
  for (const RippleDrop& drop : s.drops) {
    add_source(request, static_cast<double>(drop.x_m), static_cast<double>(drop.z_m),
               request.time_s - static_cast<double>(drop.time_s), surface);
  }
  if (!s.drops.empty()) return;
  // One after the other, spread over a life; each falls anew where the seed and its count of falls say.
  const double life = ripple_life_s(s);
  const double size_x = static_cast<double>(e.max_x_m) - static_cast<double>(e.min_x_m);
  const double size_z = static_cast<double>(e.max_z_m) - static_cast<double>(e.min_z_m);
  for (int i = 0; i < s.sources; ++i) {
    const double lives = request.time_s / life + (i + 0.5) / s.sources;
    const double fallen = std::floor(lives);
    const std::uint32_t fall = hashed(hashed(s.seed, static_cast<std::uint32_t>(i)),
                                      static_cast<std::uint32_t>(static_cast<std::int64_t>(fallen)));
    add_source(request, static_cast<double>(e.min_x_m) + size_x * hashed_unit(fall, 0),
               static_cast<double>(e.min_z_m) + size_z * hashed_unit(fall, 1), (lives - fallen) * life, surface);
  }
}

// Greatest sums of the ripples' envelopes over the cells of a grid on the extent.
void bound_ripples(const Request& request, std::size_t first, WaterSurface& surface) {
  constexpr int kCells = 32;
  const PlaneExtent& e = request.extent;
  const float cell_x = (e.max_x_m - e.min_x_m) / kCells, cell_z = (e.max_z_m - e.min_z_m) / kCells;
  float height = 0, slope = 0;
  for (int j = 0; j < kCells; ++j) {
    for (int i = 0; i < kCells; ++i) {
      const float x0 = e.min_x_m + cell_x * static_cast<float>(i), z0 = e.min_z_m + cell_z * static_cast<float>(j);
      float cell_height = 0, cell_slope = 0;
      for (std::size_t k = first; k < surface.ripples.size(); ++k) {
        const RippleSource& s = surface.ripples[k];
        const float dx = std::max({x0 - s.x_m, s.x_m - (x0 + cell_x), 0.0f});
        const float dz = std::max({z0 - s.z_m, s.z_m - (z0 + cell_z), 0.0f});
        const float r = std::sqrt(dx * dx + dz * dz + s.soften2_m2) * s.inverse_reach_per_m;
        const float fade = s.exponential != 0 ? det_exp(-r) : std::max(1.0f - r, 0.0f);
        const float fall = s.inverse_reach_per_m * (s.exponential != 0 ? fade : fade > 0.0f ? 1.0f : 0.0f);
        const float wave = fade * static_cast<float>(kTurn) * s.turns_per_m;
        cell_height += s.amplitude_m * fade;
        cell_slope += s.amplitude_m * std::sqrt(wave * wave + fall * fall);
      }
      height = std::max(height, cell_height);
      slope = std::max(slope, cell_slope);
    }
  }
  surface.height_bound_m += height * kBoundSlack;
  surface.slope_bound += slope * kBoundSlack;
}

// The ripples' heights and normals at the points of a grid over the extent.
void sample_ripples(const Request& request, const WaterSurface& ripples, WaterSurface& surface) {
  const int n = request.settings.grid;
  const PlaneExtent& e = request.extent;
  const float step_x = (e.max_x_m - e.min_x_m) / static_cast<float>(n - 1);
  const float step_z = (e.max_z_m - e.min_z_m) / static_cast<float>(n - 1);
  surface.normal_grids.push() = {static_cast<std::int32_t>(surface.grid_values.size()),
                                 n,
                                 e.min_x_m,
                                 e.min_z_m,
                                 step_x > 0 ? 1.0f / step_x : 0.0f,
                                 step_z > 0 ? 1.0f / step_z : 0.0f,
                                 1.0f / *request.settings.wavelength_m,
                                 0.0f};
  double square = 0;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const SurfacePoint<float> p =
          surface_at(ripples, e.min_x_m + step_x * static_cast<float>(i), e.min_z_m + step_z * static_cast<float>(j));
      const Vec3f normal = surface_normal<float>({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, p.slope_x, p.slope_z);
      for (const float value : {p.height_m, normal.x, normal.y, normal.z}) surface.grid_values.push() = value;
      square += static_cast<double>(p.slope_x * p.slope_x + p.slope_z * p.slope_z);
    }
  }
  surface.normal_grids[surface.normal_grids.size() - 1].slope_variance =
      static_cast<float>(square / static_cast<double>(n * n));
}

}  // namespace

double ripple_life_s(const SurfaceSettings& s) {
  return static_cast<double>(s.lifetime_s) * (s.falloff == RippleFalloff::kExponential ? kExponentialLives : 1.0);
}

void add_ripples(const Request& request, WaterSurface& surface) {
  if (request.settings.grid == 0) {
    const std::size_t first = surface.ripples.size();
    place_sources(request, surface);
    bound_ripples(request, first, surface);
    return;
  }
  WaterSurface ripples;
  place_sources(request, ripples);
  bound_ripples(request, 0, ripples);
  sample_ripples(request, ripples, surface);
  surface.height_bound_m += ripples.height_bound_m;
  surface.slope_bound += ripples.slope_bound;
}

// Wave i is lacunarity^i times shorter, gain^i as high, and up to 45 degrees off the direction; its speed is deep
// water's.
void add_trochoids(const Request& request, WaterSurface& surface) {
  const SurfaceSettings& s = request.settings;
  double wavelength = static_cast<double>(*s.wavelength_m);
  double amplitude = static_cast<double>(request.amplitude_m);
  for (int i = 0; i < *s.octaves; ++i) {
    const std::uint32_t seed = hashed(s.seed, static_cast<std::uint32_t>(i));
    const double off_deg = i == 0 ? 0.0 : 90.0 * hashed_unit(seed, 0) - 45.0;
    float sine, cosine;
    det_sincos(static_cast<float>((static_cast<double>(s.direction_deg) + off_deg) * (kTurn / 360.0)), sine, cosine);
    const double turns = hashed_unit(seed, 1) - request.time_s * std::sqrt(kGravity / (kTurn * wavelength));
    const double push = amplitude * static_cast<double>(s.choppiness);
    TrochoidWave wave;
    wave.turns_x_per_m = static_cast<float>(static_cast<double>(cosine) / wavelength);
    wave.turns_z_per_m = static_cast<float>(static_cast<double>(sine) / wavelength);
    wave.phase_turns = static_cast<float>(turns - std::floor(turns));
    wave.amplitude_m = static_cast<float>(amplitude);
    wave.push_x_m = static_cast<float>(push * static_cast<double>(cosine));
    wave.push_z_m = static_cast<float>(push * static_cast<double>(sine));
    wave.slope_variance = 0;  // finish_trochoids
    surface.trochoids.push() = wave;
    wavelength /= static_cast<double>(s.lacunarity);
    amplitude *= static_cast<double>(s.gain);
  }
}

// Mean squared slope of each wave. Sideways motion gathers water's slopes under the crests: to second order in the
// waves' folds Q = 2 pi turns |push|, a wave's share (a k)^2 / 2 grows by 1 + Q^2 / 4 + sum over the others of
// Q_j^2 cos^2 / 2, with the angle between the two. (Of one wave it is 2 (1 - sqrt(1 - Q^2)) / Q^2, at kMaxFold 2 %
// more.)
static void find_slope_variances(WaterSurface& surface) {
  for (std::size_t i = 0; i < surface.trochoids.size(); ++i) {
    TrochoidWave& w = surface.trochoids[i];
    const double kx = kTurn * static_cast<double>(w.turns_x_per_m), kz = kTurn * static_cast<double>(w.turns_z_per_m);
    const double k2 = kx * kx + kz * kz;
    double gain = 1;
    for (std::size_t j = 0; j < surface.trochoids.size(); ++j) {
      const TrochoidWave& o = surface.trochoids[j];
      const double ox = kTurn * static_cast<double>(o.turns_x_per_m), oz = kTurn * static_cast<double>(o.turns_z_per_m);
      const double fold_x = static_cast<double>(o.push_x_m), fold_z = static_cast<double>(o.push_z_m);
      const double fold2 = (fold_x * fold_x + fold_z * fold_z) * (ox * ox + oz * oz);
      const double along = (kx * ox + kz * oz) * (kx * ox + kz * oz) / std::max(k2 * (ox * ox + oz * oz), 1e-300);
      gain += j == i ? 0.25 * fold2 : 0.5 * fold2 * along;
    }
    const double amplitude = static_cast<double>(w.amplitude_m);
    w.slope_variance = static_cast<float>(0.5 * amplitude * amplitude * k2 * gain);
  }
}

// Bound of the slope: with v the slope at the point at rest and J = I - D the Jacobian there, the slope y has
// y - D y = v, so |y| (1 - y.Dy / |y|^2) = y.v / |y|. Every wave's share of (y.v / |y|, y.Dy / |y|^2) lies in an
// ellipse of half axes (ak, Q ak), their sum in one of (A, Q A), and over that |y| is at most A / sqrt(1 - (Q A)^2).
void finish_trochoids(WaterSurface& surface) {
  if (surface.trochoids.size() == 0) return;
  double steepness = 0, choppiness = 0;
  float height = 0;
  for (std::size_t i = 0; i < surface.trochoids.size(); ++i) {
    const TrochoidWave& w = surface.trochoids[i];
    const double kx = kTurn * static_cast<double>(w.turns_x_per_m), kz = kTurn * static_cast<double>(w.turns_z_per_m);
    const double push_x = static_cast<double>(w.push_x_m), push_z = static_cast<double>(w.push_z_m);
    const double amplitude = static_cast<double>(w.amplitude_m);
    steepness += amplitude * std::sqrt(kx * kx + kz * kz);
    if (amplitude > 0) choppiness = std::max(choppiness, std::sqrt(push_x * push_x + push_z * push_z) / amplitude);
    height += w.amplitude_m;
  }
  // Less sideways where the crests would fold over.
  const double fold = steepness * choppiness,
               kept = fold > static_cast<double>(kMaxFold) ? static_cast<double>(kMaxFold) / fold : 1.0;
  for (std::size_t i = 0; i < surface.trochoids.size(); ++i) {
    surface.trochoids[i].push_x_m = static_cast<float>(static_cast<double>(surface.trochoids[i].push_x_m) * kept);
    surface.trochoids[i].push_z_m = static_cast<float>(static_cast<double>(surface.trochoids[i].push_z_m) * kept);
  }
  find_slope_variances(surface);
  const double limited = fold * kept;
  surface.height_bound_m += height * kBoundSlack;
  surface.slope_bound += static_cast<float>(steepness / std::sqrt(1.0 - limited * limited)) * kBoundSlack;
}

}  // namespace shoal::surface_parts
