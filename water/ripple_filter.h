// Champandard's other choice of ripples: the blur-sharpen filter of two height buffers.
#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

#include "water/surface_data.h"
#include "water/surface_settings.h"

namespace shoal {

// Two buffers of heights, metres, in a basin: points are the centres of square cells, walls mirror. Rows along x, with
// a rim of one cell round them.
struct FilterBuffers {
  int count_x = 0, count_z = 0;  // without the rim
  std::vector<float> before, now;

  FilterBuffers(int points_x, int points_z);
  std::size_t row() const { return static_cast<std::size_t>(count_x) + 2; }
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(j + 1) * row() + static_cast<std::size_t>(i + 1);
  }
};

// One step of the filter: new = kept (twice the mean of the four neighbours - the height before).
//
//   kept   what is left of a height in two steps, 0 to 1
// It is the leapfrog scheme of the wave equation where a wave goes a cell's diagonal in two steps, the longest step
// that is stable. Every standing wave cos(p (i + 1/2)) cos(q (j + 1/2)) of the basin turns by acos(sqrt(kept) (cos p +
// cos q) / 2) a step and loses 1 - sqrt(kept) of itself: all die alike, the checkerboard too, so none of his "nasty
// looking instabilities" is left.
// For waves many cells long it is u_tt + 2 u_t / life + 2 u / (life step) = speed^2 (u_xx + u_zz), life = -2 step /
// log(kept): the third term, which hurries long waves, is the filter's own and not water's.
// Source: Champandard 1999, who names the filter and its faults.
// Error: 5e-6 of the greatest height against those waves in double after 200 steps
// (tests/water/test_ripple_filter.cpp).
void step_filter(FilterBuffers& buffers, float kept);

// What a body's ripples need: how fine, how long a step, how long a drop.
struct FilterShape {
  int count_x, count_z;
  double cell_m, step_s;      // speed = cell / (sqrt(2) step), deep water's at the wavelength
  double period_s, radius_m;  // of a drop's stroke
  float kept;                 // a step_filter's
  std::int64_t run_steps;     // an era
  float push;                 // so that a drop's greatest height is 1 in open water
};

// A body's ripples. The state at step n is a function of n alone: time is cut into eras of kRunLifetimes lifetimes, the
// middle of one at time 0, and an era's states are those of water that was still one era before it began. What is left
// of older drops then is e^-12 of them; so no step costs more than two eras, however far it is. The last state is kept,
// and steps after it in its era go on from there; that changes no bit.
class RippleFilter {
 public:
  static constexpr double kRunLifetimes = 12;
  // Points times steps of two eras, and drops' shares: what is refused above.
  static constexpr double kMaxWork = 0x1p+33;

  //   settings   resolved; extent of some area, metres
  // Throws UsageError where two eras would take more than kMaxWork.
  RippleFilter(const SurfaceSettings& settings, const PlaneExtent& extent);

  // Adds the heights at a time as a spline's coefficients, those between two steps blended linearly.
  //   time_s        seconds, times the settings' speed; |time_s| <= 1e9
  //   amplitude_m   the greatest height of a drop
  // Returns nothing; grid, values and bounds are added to the surface.
  // Differs (from Champandard): a drop is two strokes, sine under sine squared, over a round patch half a wave in
  // radius,
  //   not a point set high; walls mirror; the spline smooths the heights by (1, 6, 1) / 8 each way.
  // Error: at 24 cells a wave 1 % of a drop's greatest height against the equation at step_filter
  // (test_ripple_filter.cpp).
  void add_to(double time_s, float amplitude_m, WaterSurface& surface);

  const FilterShape& shape() const { return shape_; }

 private:
  void go_to(std::int64_t step);
  void push_drops(std::int64_t step);  // what they push at a step, which moves the heights one after it

  SurfaceSettings settings_;
  PlaneExtent extent_;
  FilterShape shape_;
  std::mutex mutex_;
  std::int64_t era_ = 0, step_ = 0;
  bool started_ = false;
  FilterBuffers buffers_;  // at step_ and, in `now`, one after it
};

}  // namespace shoal
