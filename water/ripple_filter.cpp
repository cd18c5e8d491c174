#include "water/ripple_filter.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "core/math.h"
#include "water/surface_parts.h"

namespace shoal {
namespace {

constexpr double kGravity = 9.81;  // m/s^2
constexpr double kTurn = 6.283185307179586;
constexpr double kCellsAWave = 8, kLeastCellsAWave = 4, kCellsAWaveMeasured = 16;
constexpr int kDefaultPoints = 512, kLeastPoints = 16, kStrokes = 2;

// How far a drop pushes at an age, in periods: nothing before and after its strokes, and nothing in their sum.
double stroke(double periods) {
  if (!(periods > 0 && periods < kStrokes)) return 0;
  float sine, cosine, swell, unused;
  det_sincos(static_cast<float>(kTurn * (periods - std::floor(periods))), sine, cosine);
  det_sincos(static_cast<float>(kTurn * 0.5 * periods / kStrokes), swell, unused);
  return static_cast<double>(sine * (swell * swell));
}

// One drop's share of a step. x and z from the basin's corner.
void push_drop(const FilterShape& shape, double x_m, double z_m, double age_s, FilterBuffers& buffers) {
  const float push = shape.push * static_cast<float>(stroke(age_s / shape.period_s));
  if (push == 0.0f) return;
  const double u = x_m / shape.cell_m - 0.5, v = z_m / shape.cell_m - 0.5, radius = shape.radius_m / shape.cell_m;
  const auto from = [&](double at, int count) {
    return static_cast<int>(std::clamp(std::ceil(at - radius), 0.0, 1.0 * count));
  };
  const auto to = [&](double at, int count) {
    return static_cast<int>(std::clamp(std::floor(at + radius), -1.0, 1.0 * (count - 1)));
  };
  const int last_i = to(u, buffers.count_x), last_j = to(v, buffers.count_z);
  for (int j = from(v, buffers.count_z); j <= last_j; ++j) {
    for (int i = from(u, buffers.count_x); i <= last_i; ++i) {
      const double left = 1.0 - ((i - u) * (i - u) + (j - v) * (j - v)) / (radius * radius);
      if (left > 0) buffers.now[buffers.index(i, j)] += push * static_cast<float>(left * left);
    }
  }
}

// The greatest height of one drop without damping, in open water: its quarter, in the corner between two mirrors, the
// others farther than a wave comes back from in time. At sixteen cells a wave no finer grid is 2 % from it.
float greatest_height(const FilterShape& shape, double wavelength_m) {
  FilterShape quarter = shape;
  const double cells = std::min(wavelength_m / shape.cell_m, kCellsAWaveMeasured);
  quarter.cell_m = wavelength_m / cells;
  quarter.step_s = shape.period_s / (cells * std::sqrt(2.0));
  quarter.push = static_cast<float>(1.0 / (2.0 * cells * cells));
  const int side = static_cast<int>(std::ceil((1.0 * kStrokes + 0.5) * cells));
  FilterBuffers buffers(side, side);
  float greatest = 0;
  for (int step = 1; step * quarter.step_s < kStrokes * shape.period_s; ++step) {
    step_filter(buffers, 1.0f);
    push_drop(quarter, 0, 0, step * quarter.step_s, buffers);
    greatest = std::max(greatest, std::fabs(buffers.now[buffers.index(0, 0)]));
  }
  return greatest;
}

FilterShape shape_of(const SurfaceSettings& s, const PlaneExtent& e) {
  FilterShape shape{};
  const double size_x = static_cast<double>(e.max_x_m) - static_cast<double>(e.min_x_m);
  const double size_z = static_cast<double>(e.max_z_m) - static_cast<double>(e.min_z_m);
  const double longer = std::max(size_x, size_z);
  double wavelength = std::min(static_cast<double>(*s.wavelength_m), longer);
  const double wanted = std::ceil(longer * kCellsAWave / wavelength);
  const int points = s.grid != 0 ? std::max(s.grid, kLeastPoints)
                                 : static_cast<int>(std::clamp(wanted, 1.0 * kLeastPoints, 1.0 * kDefaultPoints));
  shape.cell_m = longer / points;
  wavelength = std::max(wavelength, kLeastCellsAWave * shape.cell_m);
  const auto count = [&](double size) {
    return std::clamp(static_cast<int>(std::ceil(size / shape.cell_m - 1e-6)), 2, points);
  };
  shape.count_x = count(size_x), shape.count_z = count(size_z);
  const double speed = std::sqrt(kGravity * wavelength / kTurn);
  shape.step_s = shape.cell_m / (std::sqrt(2.0) * speed);
  shape.period_s = wavelength / speed;
  shape.radius_m = 0.5 * wavelength;
  const double lifetime = static_cast<double>(s.lifetime_s);
  shape.kept = det_exp(static_cast<float>(-2.0 * shape.step_s / lifetime));
  const double steps = std::ceil(RippleFilter::kRunLifetimes * lifetime / shape.step_s) + 1;
  const double falling = s.drops.empty() ? std::ceil(kStrokes * shape.period_s * s.sources / lifetime) + 1
                                         : static_cast<double>(s.drops.size());
  const double patch = 4.0 * shape.radius_m * shape.radius_m / (shape.cell_m * shape.cell_m);
  const double work = 2.0 * steps * (1.0 * shape.count_x * shape.count_z + falling * patch);
  if (!(work <= RippleFilter::kMaxWork)) {
    throw UsageError("surface ripple-filter: its lifetime takes " +
                     std::to_string(static_cast<std::int64_t>(std::min(2.0 * steps, 1e18))) + " steps of " +
                     std::to_string(shape.count_x) + " x " + std::to_string(shape.count_z) +
                     " points; expected a shorter lifetime, a coarser grid or fewer drops");
  }
  shape.run_steps = static_cast<std::int64_t>(steps);
  const double cells = wavelength / shape.cell_m;
  shape.push = static_cast<float>(1.0 / (2.0 * cells * cells)) / greatest_height(shape, wavelength);
  return shape;
}

}  // namespace

FilterBuffers::FilterBuffers(int points_x, int points_z)
    : count_x(points_x),
      count_z(points_z),
      before((static_cast<std::size_t>(points_x) + 2) * (static_cast<std::size_t>(points_z) + 2), 0.0f),
      now(before) {}

void step_filter(FilterBuffers& b, float kept) {
  const std::size_t row = b.row();
  const std::size_t columns = static_cast<std::size_t>(b.count_x);
  // Walls mirror: what is outside of one is what is inside.
  std::copy_n(&b.now[b.index(-1, 0)], row, &b.now[b.index(-1, -1)]);
  std::copy_n(&b.now[b.index(-1, b.count_z - 1)], row, &b.now[b.index(-1, b.count_z)]);
  for (int j = 0; j < b.count_z; ++j) {
    float* here = &b.now[b.index(-1, j)];
    here[0] = here[1];
    here[columns + 1] = here[columns];
  }
  for (int j = 0; j < b.count_z; ++j) {
    const float* here = &b.now[b.index(0, j)];
    float* out = &b.before[b.index(0, j)];
    for (std::size_t i = 0; i < columns; ++i) {
      const float mean2 = 0.5f * ((here[i - 1] + here[i + 1]) + (here[i - row] + here[i + row]));
      out[i] = kept * (mean2 - out[i]);
    }
  }
  std::swap(b.before, b.now);
}

RippleFilter::RippleFilter(const SurfaceSettings& settings, const PlaneExtent& extent)
    : settings_(settings),
      extent_(extent),
      shape_(shape_of(settings, extent)),
      buffers_(shape_.count_x, shape_.count_z) {}

void RippleFilter::push_drops(std::int64_t step) {
  const SurfaceSettings& s = settings_;
  const double time_s = static_cast<double>(step) * shape_.step_s;
  for (const RippleDrop& drop : s.drops) {
    push_drop(shape_, static_cast<double>(drop.x_m) - static_cast<double>(extent_.min_x_m),
              static_cast<double>(drop.z_m) - static_cast<double>(extent_.min_z_m),
              time_s - static_cast<double>(drop.time_s), buffers_);
  }
  if (!s.drops.empty()) return;
  // Drop n falls within the n-th part of time, at a moment and place by the seed.
  const double between = static_cast<double>(s.lifetime_s) / s.sources;
  const double first = std::floor((time_s - kStrokes * shape_.period_s) / between) - 1;
  const double size_x = static_cast<double>(extent_.max_x_m) - static_cast<double>(extent_.min_x_m);
  const double size_z = static_cast<double>(extent_.max_z_m) - static_cast<double>(extent_.min_z_m);
  for (double n = first; n * between <= time_s; n += 1) {
    const std::uint32_t drop = surface_parts::hashed(s.seed, static_cast<std::uint32_t>(static_cast<std::int64_t>(n)));
    push_drop(shape_, size_x * surface_parts::hashed_unit(drop, 0), size_z * surface_parts::hashed_unit(drop, 1),
              time_s - (n + surface_parts::hashed_unit(drop, 2)) * between, buffers_);
  }
}

void RippleFilter::go_to(std::int64_t step) {
  const std::int64_t run = shape_.run_steps, shifted = step + run / 2;
  const std::int64_t era = shifted >= 0 ? shifted / run : -((run - 1 - shifted) / run);
  if (!started_ || era != era_ || step < step_) {
    std::fill(buffers_.before.begin(), buffers_.before.end(), 0.0f);
    std::fill(buffers_.now.begin(), buffers_.now.end(), 0.0f);
    era_ = era;
    step_ = (era - 1) * run - run / 2;
    started_ = true;
  }
  for (; step_ < step; ++step_) {
    step_filter(buffers_, shape_.kept);
    push_drops(step_ + 1);
  }
}

// Of the spline at its inner knots, along one axis without the smoothing across it.
static float mean_squared_slope(const SplineGrid& grid, const float* values) {
  double sum = 0;
  for (int j = 1; j + 1 < grid.count_z; ++j)
    for (int i = 1; i + 1 < grid.count_x; ++i) {
      const float* at = values + grid.first + j * grid.count_x + i;
      const double along_x = 0.5 * (static_cast<double>(at[1]) - static_cast<double>(at[-1]));
      const double along_z = 0.5 * (static_cast<double>(at[grid.count_x]) - static_cast<double>(at[-grid.count_x]));
      sum += along_x * along_x + along_z * along_z;
    }
  const double knots = std::max(1.0, (grid.count_x - 2.0) * (grid.count_z - 2.0));
  return static_cast<float>(sum / knots * static_cast<double>(grid.cells_per_m) *
                            static_cast<double>(grid.cells_per_m));
}

void RippleFilter::add_to(double time_s, float amplitude_m, WaterSurface& surface) {
  const double steps = time_s / shape_.step_s, whole = std::floor(steps);
  const float part = static_cast<float>(steps - whole);
  SplineGrid grid{};
  grid.first = static_cast<std::int32_t>(surface.grid_values.size());
  grid.count_x = shape_.count_x, grid.count_z = shape_.count_z;
  grid.min_x_m = static_cast<float>(static_cast<double>(extent_.min_x_m) + 0.5 * shape_.cell_m);
  grid.min_z_m = static_cast<float>(static_cast<double>(extent_.min_z_m) + 0.5 * shape_.cell_m);
  grid.cells_per_m = static_cast<float>(1.0 / shape_.cell_m);
  grid.turns_per_m = static_cast<float>(0.5 / shape_.radius_m);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    go_to(static_cast<std::int64_t>(whole));
    for (int j = 0; j < shape_.count_z; ++j) {
      for (int i = 0; i < shape_.count_x; ++i) {
        const float a = buffers_.before[buffers_.index(i, j)], b = buffers_.now[buffers_.index(i, j)];
        surface.grid_values.push() = amplitude_m * (a + part * (b - a));
      }
    }
  }
  grid.slope_variance = mean_squared_slope(grid, surface.grid_values.data());
  surface.spline_grids.push() = grid;
  surface.reach_m = std::min(surface.reach_m, 0x1p+28f / grid.cells_per_m);
  surface_parts::bound_spline(grid, surface.grid_values.data(), surface);
}

}  // namespace shoal
