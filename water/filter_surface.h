// The moving surface as one pixel sees it: the slopes' mean over its footprint, and the variance that the mean hides.
#pragma once

#include "water/footprint.h"
#include "water/surface.h"

namespace shoal::inline SHOAL_ISA_NS {

template <class F>
struct FilteredPoint {
  SurfacePoint<F> mean;
  F slope_variance;  // of what is not in the mean, both axes together, >= 0
};

// Sum of a surface's parts, each faded by its own weight.
template <class F>
struct FilteredSum {
  FilteredPoint<F> out{{F(0.0f), F(0.0f), F(0.0f)}, F(0.0f)};

  SHOAL_INLINE void add(const SurfacePoint<F>& p, F weight) {
    SurfacePoint<F>& sum = out.mean;
    sum.height_m = sum.height_m + p.height_m * weight;
    sum.slope_x = sum.slope_x + p.slope_x * weight;
    sum.slope_z = sum.slope_z + p.slope_z * weight;
  }
  // What a part of such a variance loses where its amplitude is so much less.
  SHOAL_INLINE void hide(F variance, F weight) {
    out.slope_variance = out.slope_variance + variance * (F(1.0f) - weight * weight);
  }
};

// Noise's mean squared slope in its own cells, both axes; half of it along each (tests/water/test_filter_surface.cpp).
inline constexpr float kNoiseSlope2Quintic = 0.7795f, kNoiseSlope2Cubic = 0.6545f;

template <class F>
SHOAL_INLINE void add_noise_filtered(const NoiseLayer& n, F x, F z, Footprint<F> p, FilteredSum<F>& sum) {
  // The footprint in cells.
  const Footprint<F> cells = {F(n.xx) * p.ax + F(n.xz) * p.az, F(n.zx) * p.ax + F(n.zz) * p.az,
                              F(n.xx) * p.bx + F(n.xz) * p.bz, F(n.zx) * p.bx + F(n.zz) * p.bz};
  const F weight = isotropic_weight(isotropic_square(cells) * F(kNoiseCycles2));
  const float scale2 = n.xx * n.xx + n.xz * n.xz + n.zx * n.zx + n.zz * n.zz;
  const float slope2 = 0.5f * (n.cubic != 0 ? kNoiseSlope2Cubic : kNoiseSlope2Quintic);
  sum.hide(F(n.amplitude_m * n.amplitude_m * scale2 * slope2), weight);
  if (none(weight > F(0.0f))) return;
  sum.add(noise_layer_at(n, x, z), weight);
}

// A ring is a plane wave along the way from its source; near the source, where that way turns within the footprint, the
// mean over the footprint of its square along each side.
template <class F>
SHOAL_INLINE void add_ripple_filtered(const RippleSource& s, F x, F z, Footprint<F> p, FilteredSum<F>& sum) {
  const F dx = x - F(s.x_m), dz = z - F(s.z_m);
  const F aa = p.ax * p.ax + p.az * p.az, bb = p.bx * p.bx + p.bz * p.bz, ab = p.ax * p.bx + p.az * p.bz;
  const F da = dx * p.ax + dz * p.az, db = dx * p.bx + dz * p.bz;
  const F twelfth(1.0f / 12.0f);
  const F r2 = (dx * dx + dz * dz) + F(s.soften2_m2);
  const F per_r2 = F(s.turns_per_m * s.turns_per_m) / (r2 + (aa + bb) * twelfth);
  const F weight = side_weight(((da * da) + (aa * aa + ab * ab) * twelfth) * per_r2) *
                   side_weight(((db * db) + (bb * bb + ab * ab) * twelfth) * per_r2);
  const F r = sqrt(r2);
  const F fade = s.exponential != 0 ? det_exp2(r * F(-1.44269504f * s.inverse_reach_per_m))
                                    : max(F(1.0f) - r * F(s.inverse_reach_per_m), F(0.0f));
  const float k = 6.28318531f * s.turns_per_m;
  sum.hide(fade * fade * F(0.5f * s.amplitude_m * s.amplitude_m * k * k), weight);
  if (none(weight > F(0.0f))) return;
  sum.add(ripple_at(s, x, z), weight);
}

template <class F>
SHOAL_INLINE F trochoid_weight(const TrochoidWave& w, Footprint<F> p) {
  return wave_weight(F(w.turns_x_per_m), F(w.turns_z_per_m), p);
}
template <class F>
struct FadedWaves {
  Footprint<F> footprint;

  template <class G>
  SHOAL_INLINE bool leave_out(const TrochoidWave& w) const {
    return none(trochoid_weight(w, footprint) > F(0.0f));
  }
  template <class G>
  SHOAL_INLINE F of(const TrochoidWave& w, float constant) const {
    return F(constant) * trochoid_weight(w, footprint);
  }
};
template <class F>
SHOAL_INLINE void add_trochoids_filtered(const WaterSurface& surface, F x, F z, Footprint<F> p, FilteredSum<F>& sum) {
  bool any_left = false;
  for (std::size_t i = 0; i < surface.trochoids.size(); ++i) {
    const TrochoidWave& w = surface.trochoids[i];
    const F weight = trochoid_weight(w, p);
    sum.hide(F(w.slope_variance), weight);
    any_left = any_left || any(weight > F(0.0f));
  }
  if (!any_left) return;
  sum.add(trochoids_at(surface.trochoids.data(), surface.trochoids.size(), x, z, FadedWaves<F>{p}), F(1.0f));
}

// A grid and its coarser ones, each for a square of twice the side: mixed by the square's area, in which the weights of
// waves are linear at first.
template <class F>
SHOAL_INLINE void add_spline_filtered(const WaterSurface& surface, const SplineGrid& grid, F x, F z, F square_m2,
                                      FilteredSum<F>& sum) {
  const SplineGrid* coarser = surface.coarser_grids.data() + grid.first_coarser;
  F variance(0.0f), last_weight(0.0f), reached(1.0f), last_covariance(0.0f);
  for (std::int32_t level = 0; level <= grid.coarser_count; ++level) {
    const SplineGrid& here = level == 0 ? grid : coarser[level - 1];
    const float next_m2 = level == grid.coarser_count ? 4.0f * here.square_m2 : coarser[level].square_m2;
    const F past = clamp((square_m2 - F(here.square_m2)) * F(1.0f / (next_m2 - here.square_m2)), F(0.0f), F(1.0f));
    const F weight = reached - past;
    variance =
        variance + (weight * weight * F(here.slope_variance) + F(2.0f) * (last_weight * weight) * last_covariance);
    reached = past;
    last_weight = weight;
    last_covariance = F(here.next_covariance);
    if (any(weight > F(0.0f))) sum.add(spline_grid_at(here, surface.grid_values.data(), x, z), weight);
    if (none(past > F(0.0f))) break;
  }
  sum.out.slope_variance = sum.out.slope_variance + max(F(grid.slope_variance) - variance, F(0.0f));
}

// surface_at over a footprint.
//
//   x_m, z_m   as surface_at
//   p          finite
// Returns height and slopes with each part faded as far as it averages out over the footprint, and the variance of the
// slopes that is gone. A footprint of 0 gives the bits of surface_at and no variance. Parts that are gone for all lanes
// are not computed. The same bits for float and WideF.
// Source: box filter of sines (water/footprint.h); the variance as in Olano and Baker 2010, LEAN Mapping, section 3.
// Differs: no second moments are stored, parts know theirs; the variance is one number for both axes, the mean one of
//   noise, trochoids and grids, the local envelope's of ripples; noise and grids are faded as isotropic waves;
//   trochoids fade amplitude and push of each wave.
// Error: slopes are off their mean over the footprint by an RMS of 0.25 of the surface's own (a square), 0.37 (one of 4
//   to 1), ripple-filter's by 0.45, never by more than the unfiltered ones; hidden and kept variance add up to the
//   whole within 10 % (tests/water/test_filter_surface.cpp).
template <class F>
SHOAL_INLINE FilteredPoint<F> filtered_surface_at(const WaterSurface& surface, F x_m, F z_m, Footprint<F> p) {
  const F x = clamp(x_m, F(-surface.reach_m), F(surface.reach_m));
  const F z = clamp(z_m, F(-surface.reach_m), F(surface.reach_m));
  FilteredSum<F> sum;
  for (std::size_t i = 0; i < surface.noise.size(); ++i) add_noise_filtered(surface.noise[i], x, z, p, sum);
  for (std::size_t i = 0; i < surface.ripples.size(); ++i) add_ripple_filtered(surface.ripples[i], x, z, p, sum);
  if (surface.trochoids.size() != 0) add_trochoids_filtered(surface, x, z, p, sum);
  const F square_m2 = isotropic_square(p);
  const auto fade_grid = [&](const auto& grid, auto value) SHOAL_LAMBDA {
    const F weight = isotropic_weight(square_m2 * F(grid.turns_per_m * grid.turns_per_m));
    sum.hide(F(grid.slope_variance), weight);
    if (any(weight > F(0.0f))) sum.add(value(), weight);
  };
  for (std::size_t i = 0; i < surface.normal_grids.size(); ++i) {
    const NormalGrid& grid = surface.normal_grids[i];
    fade_grid(grid, [&]() SHOAL_LAMBDA { return normal_grid_at(grid, surface.grid_values.data(), x, z); });
  }
  for (std::size_t i = 0; i < surface.spline_grids.size(); ++i) {
    const SplineGrid& grid = surface.spline_grids[i];
    if (grid.coarser_count == 0)
      fade_grid(grid, [&]() SHOAL_LAMBDA { return spline_grid_at(grid, surface.grid_values.data(), x, z); });
    else
      add_spline_filtered(surface, grid, x, z, square_m2, sum);
  }
  return sum.out;
}

}  // namespace shoal::inline SHOAL_ISA_NS
