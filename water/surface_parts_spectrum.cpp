// Tessendorf's sea: every wave of a tile, summed by a Fourier transform.
#include <algorithm>
#include <cmath>

#include "core/math.h"
#include "water/fft.h"
#include "water/footprint.h"
#include "water/surface_parts.h"

namespace shoal::surface_parts {
namespace {

constexpr double kGravity = 9.81;  // m/s^2
constexpr double kTurn = 6.283185307179586;

// Wave numbers of index 0..side-1: 0, 1, ... side/2, ... -1.
int wave_number(int index, int side) { return index <= side / 2 ? index : index - side; }

// Two independent normal deviates by Box and Muller.
Complex normal_pair(std::uint32_t seed, std::uint32_t n) {
  const std::uint32_t h = hashed(seed, n);
  const float u = (static_cast<float>(hashed(h, 1) >> 8) + 0.5f) * 0x1p-24f;
  const float angle = static_cast<float>(hashed(h, 2) >> 8) * 0x1p-24f * 6.28318531f;
  const float radius = std::sqrt(-2.0f * det_log(u));
  float sine, cosine;
  det_sincos(angle, sine, cosine);
  return {radius * cosine, radius * sine};
}

}  // namespace

// Phillips' spectrum, with its peak at the settings' wavelength: exp(-1 / (k l)^2) / k^4 cos^2 of the angle to the
// wind, waves against it at a quarter, waves shorter than two cells damped. The sum of variances is 1/2, a single
// sine's of amplitude 1. Source: Tessendorf 2001, eqs. 40 to 42.
std::vector<float> spectrum_waves(const SurfaceSettings& s) {
  const int side = s.grid;
  const double unit = kTurn / static_cast<double>(*s.tile_m);
  const double peak = kTurn / static_cast<double>(*s.wavelength_m);
  const double cell = static_cast<double>(*s.tile_m) / side;
  float wind_z, wind_x;
  det_sincos(s.direction_deg * static_cast<float>(kTurn / 360.0), wind_z, wind_x);
  std::vector<float> waves(2 * static_cast<std::size_t>(side) * static_cast<std::size_t>(side), 0.0f);
  double total = 0;
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      // The highest wave each way would not be real.
      if (i == side / 2 || j == side / 2 || (i == 0 && j == 0)) continue;
      const double kx = unit * wave_number(i, side), kz = unit * wave_number(j, side), k2 = kx * kx + kz * kz;
      const double along = kx * static_cast<double>(wind_x) + kz * static_cast<double>(wind_z);
      // exp(-1 / (k l)^2) / k^4 is greatest at k = 1 / (sqrt(2) l).
      const float cut = static_cast<float>(-2.0 * peak * peak / k2 - 0.1 * k2 * cell * cell);
      const double power =
          static_cast<double>(det_exp(cut)) * (along * along) / (k2 * k2 * k2) * (along < 0 ? 0.25 : 1.0);
      const Complex deviates = normal_pair(s.seed, static_cast<std::uint32_t>(j * side + i));
      const double root = std::sqrt(0.5 * power);
      const std::size_t at =
          2 * (static_cast<std::size_t>(j) * static_cast<std::size_t>(side) + static_cast<std::size_t>(i));
      waves[at] = static_cast<float>(root * peak * peak * static_cast<double>(deviates.re));
      waves[at + 1] = static_cast<float>(root * peak * peak * static_cast<double>(deviates.im));
      total += static_cast<double>(waves[at]) * static_cast<double>(waves[at]) +
               static_cast<double>(waves[at + 1]) * static_cast<double>(waves[at + 1]);
    }
  }
  const float scale = total > 0 ? static_cast<float>(std::sqrt(0.25 / total)) : 0.0f;
  for (float& wave : waves) wave *= scale;
  return waves;
}

namespace {

// A tile's waves at a time: height(x) = amplitude times the sum of terms exp(i k x).
struct Sea {
  int side;
  float tile_m, amplitude_m;
  double unit;  // of wave numbers, 1/m
  std::vector<Complex> terms;

  const Complex& term(int number_x, int number_z) const {
    const int i = number_x & (side - 1), j = number_z & (side - 1);
    return terms[static_cast<std::size_t>(j) * static_cast<std::size_t>(side) + static_cast<std::size_t>(i)];
  }
};

// h(x, t) = sum over k of (h0(k) exp(-i w t) + conj(h0(-k)) exp(i w t)) exp(i k x), w^2 = g k.
// Source: Tessendorf 2001, eqs. 36 and 43. Differs: waves travel along k; no chop.
Sea sea_at(const Request& request, const std::vector<float>& waves) {
  const SurfaceSettings& s = request.settings;
  const std::size_t n = static_cast<std::size_t>(s.grid);
  Sea sea{s.grid, *s.tile_m, request.amplitude_m, kTurn / static_cast<double>(*s.tile_m), std::vector<Complex>(n * n)};
  for (int j = 0; j < sea.side; ++j) {
    for (int i = 0; i < sea.side; ++i) {
      const double kx = sea.unit * wave_number(i, sea.side), kz = sea.unit * wave_number(j, sea.side);
      const double turns = std::sqrt(kGravity * std::sqrt(kx * kx + kz * kz)) / kTurn * request.time_s;
      float sine, cosine;
      det_sincos(static_cast<float>(turns - std::floor(turns)) * 6.28318531f, sine, cosine);
      const std::size_t at = static_cast<std::size_t>(j) * n + static_cast<std::size_t>(i);
      const std::size_t opposite = static_cast<std::size_t>((sea.side - j) & (sea.side - 1)) * n +
                                   static_cast<std::size_t>((sea.side - i) & (sea.side - 1));
      const Complex a = {waves[2 * at], waves[2 * at + 1]}, b = {waves[2 * opposite], waves[2 * opposite + 1]};
      // a (cos - i sin) + conj(b) (cos + i sin)
      sea.terms[at] = {(a.re + b.re) * cosine + (a.im + b.im) * sine, (a.im - b.im) * cosine + (b.re - a.re) * sine};
    }
  }
  return sea;
}

// What a square of side sqrt(square_m2) leaves of a wave (water/footprint.h).
float share_of_wave(double k2, double square_m2) {
  return isotropic_weight(static_cast<float>(k2 * square_m2 / (kTurn * kTurn)));
}

// The sea over a square, at the points of a grid of fewer points a side (what that cannot hold is left out), as the
// coefficients of the spline that goes through those heights: the transform's terms over the spline's own.
//   finer_m2  the square of the grid before
// Returns the grid, its mean squared slope, and in `covariance` its slopes' mean product with those of the grid before.
SplineGrid spline_of_sea(const Sea& sea, int side, double square_m2, double finer_m2, WaterSurface& surface,
                         float& covariance) {
  const std::size_t n = static_cast<std::size_t>(side);
  // The spline's coefficient, mean square and mean squared derivative for a wave's height, each way.
  std::vector<float> response(n);
  std::vector<double> square(n), slope(n);
  for (int i = 0; i < side; ++i) {
    const float cosine = det_cos(6.28318531f * static_cast<float>(i) / static_cast<float>(side));
    const std::size_t at = static_cast<std::size_t>(i);
    response[at] = 1.0f / (0.75f + 0.25f * cosine);
    const double c = static_cast<double>(cosine), r = static_cast<double>(response[at]),
                 cells = side / (kTurn / sea.unit);
    square[at] = r * r * (64.0 + 52.0 * c + 4.0 * c * c) / 120.0;
    slope[at] = r * r * cells * cells * (2.0 - 2.0 * c) * (2.0 + c) / 3.0;
  }
  std::vector<Complex> terms(n * n);
  double own = 0, shared = 0;
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      const int number_x = wave_number(i, side), number_z = wave_number(j, side);
      const std::size_t at = static_cast<std::size_t>(j) * n + static_cast<std::size_t>(i);
      terms[at] = {0.0f, 0.0f};
      if (side != sea.side && (i == side / 2 || j == side / 2)) continue;
      const Complex wave = sea.term(number_x, number_z);
      const double kx = sea.unit * number_x, kz = sea.unit * number_z, k2 = kx * kx + kz * kz;
      const float share = square_m2 == 0 ? 1.0f : share_of_wave(k2, square_m2);
      const float scale =
          sea.amplitude_m * response[static_cast<std::size_t>(i)] * response[static_cast<std::size_t>(j)] * share;
      terms[at] = {scale * wave.re, scale * wave.im};
      const double power = static_cast<double>(wave.re * wave.re + wave.im * wave.im) * static_cast<double>(share);
      const std::size_t x = static_cast<std::size_t>(i), z = static_cast<std::size_t>(j);
      const double spline_k2 = slope[x] * square[z] + square[x] * slope[z];
      own += power * static_cast<double>(share) * spline_k2;
      // The finer grid, twice as fine, has about the wave's own slope.
      const float finer_share = finer_m2 == 0 ? 1.0f : share_of_wave(k2, finer_m2);
      shared += power * static_cast<double>(finer_share) * std::sqrt(k2 * spline_k2);
    }
  }
  inverse_fft_2d(terms, n);
  const double square_amplitude = static_cast<double>(sea.amplitude_m) * static_cast<double>(sea.amplitude_m);
  const SplineGrid grid = {static_cast<std::int32_t>(surface.grid_values.size()),
                           side,
                           side,
                           1,
                           0.0f,
                           0.0f,
                           static_cast<float>(side) / sea.tile_m,
                           static_cast<float>(square_m2),
                           static_cast<float>(own * square_amplitude),
                           0.0f,
                           static_cast<std::int32_t>(surface.coarser_grids.size()),
                           0,
                           1.0f / sea.tile_m};
  for (const Complex& value : terms) surface.grid_values.push() = value.re;
  covariance = static_cast<float>(shared * square_amplitude);
  return grid;
}

}  // namespace

// The whole sea, and grids of half the side each, down to 4: each for such a square that its shortest wave is as near
// to gone as it will be, 0.78 cycles across.
void add_spectrum(const Request& request, const std::vector<float>& waves, WaterSurface& surface) {
  const Sea sea = sea_at(request, waves);
  const double tile_m = kTurn / sea.unit;
  float covariance = 0;
  SplineGrid grid = spline_of_sea(sea, sea.side, 0, 0, surface, covariance);
  double before_m2 = 0;
  SplineGrid* before = &grid;
  for (int side = sea.side / 2; side >= 4 && surface.filtered; side /= 2) {
    const double square_m = 2 * 0.78 * tile_m / side;
    const SplineGrid coarser = spline_of_sea(sea, side, square_m * square_m, before_m2, surface, covariance);
    before->next_covariance = covariance;
    surface.coarser_grids.push() = coarser;
    before = &surface.coarser_grids[surface.coarser_grids.size() - 1];
    before_m2 = square_m * square_m;
    ++grid.coarser_count;
  }
  surface.spline_grids.push() = grid;
  surface.reach_m = std::min(surface.reach_m, 0x1p+28f / grid.cells_per_m);
  bound_spline(grid, surface.grid_values.data(), surface);
}

// Height and slope are means, by weights that are not negative, of coefficients and of their differences: over a cell,
// of nine coefficients and six differences each way.
void bound_spline(const SplineGrid& grid, const float* values, WaterSurface& surface) {
  const auto at = [&](int i, int j) {
    const auto inside = [&](int k, int count) {
      return grid.wraps != 0 ? k & (count - 1) : std::clamp(k, 0, count - 1);
    };
    return values[grid.first + inside(j, grid.count_z) * grid.count_x + inside(i, grid.count_x)];
  };
  float height = 0, slope2 = 0;
  for (int j = 0; j < grid.count_z; ++j) {
    for (int i = 0; i < grid.count_x; ++i) {
      float along_x = 0, along_z = 0;
      for (int k = -1; k <= 1; ++k) {
        along_x =
            std::max({along_x, std::fabs(at(i, j + k) - at(i - 1, j + k)), std::fabs(at(i + 1, j + k) - at(i, j + k))});
        along_z =
            std::max({along_z, std::fabs(at(i + k, j) - at(i + k, j - 1)), std::fabs(at(i + k, j + 1) - at(i + k, j))});
      }
      height = std::max(height, std::fabs(at(i, j)));
      slope2 = std::max(slope2, along_x * along_x + along_z * along_z);
    }
  }
  surface.height_bound_m += height * kBoundSlack;
  surface.slope_bound += std::sqrt(slope2) * grid.cells_per_m * kBoundSlack;
}

}  // namespace shoal::surface_parts
