// The height of a prepared surface in double, by formulas of its own, and its slope by central differences. It reads the
// surface's numbers and shares no function with the code.
#pragma once

#include <cmath>
#include <cstdint>

#include "water/surface_data.h"

namespace surface_oracle {

using namespace shoal;

inline constexpr double kTurn = 6.283185307179586;

// A lattice point's gradient: one of sixteen unit vectors, 22.5 degrees apart, by a hash of the point's coordinates and
// the seed. The hash is a part of the surface's definition, as a table of permutations would be.
inline void lattice_gradient(std::int64_t x, std::int64_t z, std::int32_t seed, double& gx, double& gz) {
  const auto wrap = [](std::int64_t v) { return static_cast<std::uint32_t>(static_cast<std::uint64_t>(v)); };
  std::uint32_t h = ((wrap(x) * 0x27D4EB2Du) ^ static_cast<std::uint32_t>(seed)) ^ (wrap(z) * 0x165667B1u);
  h *= 0x9E3779B9u;
  h = ((h >> 15) ^ h) * 0x27D4EB2Du;
  const double angle = kTurn * static_cast<double>(h >> 28) / 16.0;
  gx = std::cos(angle), gz = std::sin(angle);
}

// The gradients of the last cell.
struct LatticeCache {
  std::int64_t x = INT64_MIN, z = INT64_MIN;
  std::int32_t seed = 0;
  double gx[4] = {}, gz[4] = {};
};

inline double fade(double t, bool cubic) {
  return cubic ? 3 * std::pow(t, 2) - 2 * std::pow(t, 3)
               : 6 * std::pow(t, 5) - 15 * std::pow(t, 4) + 10 * std::pow(t, 3);
}

// Sum over the corners of weight times ramp.
inline double noise(double x, double z, std::int32_t cell_x, std::int32_t cell_z, std::int32_t seed, bool cubic,
                    LatticeCache& cache) {
  const double fx = std::floor(x), fz = std::floor(z);
  const std::int64_t ix = static_cast<std::int64_t>(fx) + cell_x, iz = static_cast<std::int64_t>(fz) + cell_z;
  if (cache.x != ix || cache.z != iz || cache.seed != seed) {
    for (int c = 0; c < 4; ++c) lattice_gradient(ix + (c & 1), iz + (c >> 1), seed, cache.gx[c], cache.gz[c]);
    cache.x = ix, cache.z = iz, cache.seed = seed;
  }
  double sum = 0;
  for (int c = 0; c < 4; ++c) {
    const double dx = x - fx - (c & 1), dz = z - fz - (c >> 1);
    sum += fade(1 - std::fabs(dx), cubic) * fade(1 - std::fabs(dz), cubic) * (cache.gx[c] * dx + cache.gz[c] * dz);
  }
  return sum;
}

inline double ripple(const RippleSource& s, double x, double z) {
  const double r = std::sqrt(std::pow(x - static_cast<double>(s.x_m), 2) + std::pow(z - static_cast<double>(s.z_m), 2) +
                             static_cast<double>(s.soften2_m2));
  const double share = r * static_cast<double>(s.inverse_reach_per_m);
  const double faded = s.exponential != 0 ? std::exp(-share) : std::fmax(0.0, 1 - share);
  return static_cast<double>(s.amplitude_m) * faded *
         std::sin(kTurn * (static_cast<double>(s.turns_per_m) * r + static_cast<double>(s.phase_turns)));
}

// The point at rest by plain iteration until it stands still.
inline double trochoids(const WaterSurface& surface, double x, double z) {
  double px = x, pz = z, height = 0;
  for (int round = 0; round < 200; ++round) {
    double qx = x, qz = z;
    height = 0;
    for (std::size_t i = 0; i < surface.trochoids.size(); ++i) {
      const TrochoidWave& w = surface.trochoids[i];
      const double angle = kTurn * (px * static_cast<double>(w.turns_x_per_m) +
                                    pz * static_cast<double>(w.turns_z_per_m) + static_cast<double>(w.phase_turns));
      qx += static_cast<double>(w.push_x_m) * std::sin(angle);
      qz += static_cast<double>(w.push_z_m) * std::sin(angle);
      height += static_cast<double>(w.amplitude_m) * std::cos(angle);
    }
    const double moved = std::fabs(px - qx) + std::fabs(pz - qz);
    px = qx, pz = qz;
    if (moved < 1e-14) break;
  }
  return height;
}

// By the box spline's definition: weights from its three pieces, as a function of the distance.
inline double spline_weight(double d) {
  d = std::fabs(d);
  return d < 0.5 ? 0.75 - d * d : d < 1.5 ? 0.5 * (1.5 - d) * (1.5 - d) : 0.0;
}
inline double spline(const SplineGrid& g, const float* values, double x, double z) {
  const double u = (x - static_cast<double>(g.min_x_m)) * static_cast<double>(g.cells_per_m);
  const double v = (z - static_cast<double>(g.min_z_m)) * static_cast<double>(g.cells_per_m);
  const auto inside = [&](int k, int count) {
    return g.wraps != 0 ? ((k % count) + count) % count : k < 0 ? 0 : k < count ? k : count - 1;
  };
  double sum = 0;
  for (int j = static_cast<int>(std::floor(v)) - 2; j <= std::floor(v) + 3; ++j)
    for (int i = static_cast<int>(std::floor(u)) - 2; i <= std::floor(u) + 3; ++i)
      sum += spline_weight(u - i) * spline_weight(v - j) *
             static_cast<double>(values[g.first + inside(j, g.count_z) * g.count_x + inside(i, g.count_x)]);
  return sum;
}

// Sum of all parts but Champandard's buffer.
inline double height(const WaterSurface& surface, double x, double z) {
  double sum = 0;
  for (std::size_t i = 0; i < surface.noise.size(); ++i) {
    const NoiseLayer& n = surface.noise[i];
    LatticeCache cache;
    const double px = x * static_cast<double>(n.xx) + z * static_cast<double>(n.xz) + static_cast<double>(n.offset_x);
    const double pz = x * static_cast<double>(n.zx) + z * static_cast<double>(n.zz) + static_cast<double>(n.offset_z);
    sum += static_cast<double>(n.amplitude_m) * noise(px, pz, n.cell_x, n.cell_z, n.seed, n.cubic != 0, cache);
  }
  for (std::size_t i = 0; i < surface.ripples.size(); ++i) sum += ripple(surface.ripples[i], x, z);
  if (surface.trochoids.size() != 0) sum += trochoids(surface, x, z);
  for (std::size_t i = 0; i < surface.spline_grids.size(); ++i) {
    sum += spline(surface.spline_grids[i], surface.grid_values.data(), x, z);
  }
  return sum;
}

}  // namespace surface_oracle
