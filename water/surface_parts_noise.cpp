// Layers of gradient noise: Li's fractal noise and Steel's two drifting layers.
#include <algorithm>
#include <cmath>

#include "core/math.h"
#include "water/noise.h"
#include "water/surface_parts.h"

namespace shoal::surface_parts {
namespace {

constexpr double kGravity = 9.81;  // m/s^2

// Lattice coordinates of the plane: p = m (x - drift t).
struct Lattice {
  double xx, xz, zx, zz;    // cells a metre
  double drift_x, drift_z;  // m/s
};

// A number of cells as whole cells, wrapped to 32 bits, and the rest.
void split_cells(double cells, std::int32_t& whole, float& rest) {
  const double down = std::floor(cells);
  whole = static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::int64_t>(down)));
  rest = static_cast<float>(cells - down);
}

void add_layer(const Lattice& m, const Request& request, std::uint32_t seed, float height_m, WaterSurface& surface) {
  const bool cubic = request.settings.fade == NoiseFade::kCubic;
  const double moved_x = -m.drift_x * request.time_s, moved_z = -m.drift_z * request.time_s;
  NoiseLayer layer;
  layer.xx = static_cast<float>(m.xx);
  layer.xz = static_cast<float>(m.xz);
  layer.zx = static_cast<float>(m.zx);
  layer.zz = static_cast<float>(m.zz);
  split_cells(m.xx * moved_x + m.xz * moved_z + hashed_unit(seed, 0), layer.cell_x, layer.offset_x);
  split_cells(m.zx * moved_x + m.zz * moved_z + hashed_unit(seed, 1), layer.cell_z, layer.offset_z);
  layer.seed = static_cast<std::int32_t>(hashed(seed, 2));
  layer.amplitude_m = height_m / kNoiseBound;
  layer.cubic = cubic ? 1 : 0;
  surface.noise.push() = layer;
  // The gradient is M^T times the noise's, so it is longer by M's greatest singular value at most.
  const double square = m.xx * m.xx + m.xz * m.xz + m.zx * m.zx + m.zz * m.zz, det = m.xx * m.zz - m.xz * m.zx;
  const double norm = std::sqrt(0.5 * (square + std::sqrt(std::max(square * square - 4 * det * det, 0.0))));
  const float slope = cubic ? kNoiseSlopeBoundCubic : kNoiseSlopeBoundQuintic;
  surface.height_bound_m += height_m * kBoundSlack;
  surface.slope_bound += layer.amplitude_m * static_cast<float>(norm) * slope * kBoundSlack;
  surface.reach_m = std::min(surface.reach_m, static_cast<float>(0x1p+28 / norm));
}

}  // namespace

// Octave i has cells of wavelength / lacunarity^i and gain^i of the height. Each is turned and drifts by itself, at the
// speed of deep-water waves as long as its cells, so that the sum never repeats and finer waves are slower.
// Source: Li et al., section 2.3. Differs: drift and turning are ours; theirs says neither gain nor lacunarity.
void add_perlin(const Request& request, WaterSurface& surface) {
  const SurfaceSettings& s = request.settings;
  double cells_per_m = 1.0 / static_cast<double>(*s.wavelength_m);
  float height_m = request.amplitude_m;
  for (int i = 0; i < *s.octaves; ++i) {
    const std::uint32_t seed = hashed(s.seed, static_cast<std::uint32_t>(i));
    float sine, cosine, drift_sine, drift_cosine;
    det_sincos(2.4f * static_cast<float>(i), sine, cosine);
    det_sincos(static_cast<float>(2.0 * 3.141592653589793 * hashed_unit(seed, 3)), drift_sine, drift_cosine);
    const double speed = std::sqrt(kGravity / (cells_per_m * 6.283185307179586));
    const double c = cells_per_m * static_cast<double>(cosine), n = cells_per_m * static_cast<double>(sine);
    add_layer({c, n, -n, c, speed * static_cast<double>(drift_cosine), speed * static_cast<double>(drift_sine)},
              request, seed, height_m, surface);
    cells_per_m *= static_cast<double>(s.lacunarity);
    height_m *= s.gain;
  }
}

// Steel's two layers: 0.010 P(M1 (x + t (0.1, -0.55))) + 0.007 P(M2 (x + t (-0.05, 0.4))), M1 with the columns
// (0.8, -1.9), (3.8, 0.4), M2 = diag(3.5, 6.7); scaled to the wavelength, with the first layer's height as amplitude.
// Source: Steel 2024. Differs: his hash is another; quintic unless the settings say cubic.
void add_gradient_waves(const Request& request, WaterSurface& surface) {
  const double scale = 0.364 / static_cast<double>(*request.settings.wavelength_m);
  const auto scaled = [scale](Lattice m) {
    // Cells and drift scale with the wavelength.
    return Lattice{m.xx * scale, m.xz * scale, m.zx * scale, m.zz * scale, m.drift_x / scale, m.drift_z / scale};
  };
  add_layer(scaled({0.8, 3.8, -1.9, 0.4, -0.1, 0.55}), request, hashed(request.settings.seed, 0), request.amplitude_m,
            surface);
  add_layer(scaled({3.5, 0.0, 0.0, 6.7, 0.05, -0.4}), request, hashed(request.settings.seed, 1),
            0.7f * request.amplitude_m, surface);
}

std::uint32_t hashed(std::uint32_t seed, std::uint32_t n) {
  std::uint32_t h = seed * 0x9E3779B9u ^ n * 0x85EBCA6Bu;
  for (int round = 0; round < 2; ++round) {
    h = (h ^ 61u) ^ (h >> 16);
    h *= 9u;
    h ^= h >> 4;
    h *= 0x27D4EB2Du;
    h ^= h >> 15;
  }
  return h;
}

double hashed_unit(std::uint32_t seed, std::uint32_t n) { return static_cast<double>(hashed(seed, n)) * 0x1p-32; }

}  // namespace shoal::surface_parts
