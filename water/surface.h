// The moving surface over the plane of a body of water: height and slope at a point, for one lane or sixteen.
//
// Cost with AVX-512, time-stamp cycles for sixteen lanes on a Zen 4 class core at 2.6 GHz: gradient-waves 100, perlin
// 45 to 54 an octave, four ripples 260, gerstner 280 a wave (435 for one).
#pragma once

#include "core/vec_lanes.h"
#include "water/noise.h"
#include "water/surface_data.h"
#include "water/waves.h"

namespace shoal::inline SHOAL_ISA_NS {

// One layer of noise.
template <class F>
SHOAL_INLINE SurfacePoint<F> noise_layer_at(const NoiseLayer& layer, F x_m, F z_m) {
  const Noise<F> n = gradient_noise((x_m * F(layer.xx) + z_m * F(layer.xz)) + F(layer.offset_x),
                                    (x_m * F(layer.zx) + z_m * F(layer.zz)) + F(layer.offset_z), layer.cell_x,
                                    layer.cell_z, layer.seed, layer.cubic != 0);
  const float a = layer.amplitude_m;
  return {n.value * F(a), n.dx * F(a * layer.xx) + n.dz * F(a * layer.zx),
          n.dx * F(a * layer.xz) + n.dz * F(a * layer.zz)};
}

SHOAL_INLINE float surface_value(const float* values, std::int32_t index) { return values[index]; }
SHOAL_INLINE WideF surface_value(const float* values, WideI index) { return gather(values, index); }

// A water buffer between its points: heights and unit normals blended bilinearly, the slope from the blended normal.
// Outside of the grid as at its edge.
// Source: Champandard 1999. So the slope is not the derivative of the height between points; at points it is.
template <class F>
SHOAL_INLINE SurfacePoint<F> normal_grid_at(const NormalGrid& grid, const float* values, F x_m, F z_m) {
  using I = IntOf<F>;
  const float last = static_cast<float>(grid.count - 1);
  const F u = clamp((x_m - F(grid.min_x_m)) * F(grid.cells_per_m_x), F(0.0f), F(last));
  const F v = clamp((z_m - F(grid.min_z_m)) * F(grid.cells_per_m_z), F(0.0f), F(last));
  const F u0 = min(floor(u), F(last - 1.0f)), v0 = min(floor(v), F(last - 1.0f));
  const F tu = u - u0, tv = v - v0;
  const I at = (to_int_trunc(v0) * I(grid.count) + to_int_trunc(u0)) * I(4) + I(grid.first);
  F channel[4];
  for (int c = 0; c < 4; ++c) {
    const I here = at + I(c), below = here + I(4 * grid.count);
    const F a = surface_value(values, here), b = surface_value(values, here + I(4));
    const F d = surface_value(values, below), e = surface_value(values, below + I(4));
    const F row0 = a + tu * (b - a), row1 = d + tu * (e - d);
    channel[c] = row0 + tv * (row1 - row0);
  }
  return {channel[0], -channel[1] / channel[2], -channel[3] / channel[2]};
}

// A quadratic B-spline: smooth slopes from nine coefficients.
// Returns height and its exact gradient.
// Source: Unser 1999, "Splines: a perfect fit for signal and image processing".
template <class F>
SHOAL_INLINE SurfacePoint<F> spline_grid_at(const SplineGrid& grid, const float* values, F x_m, F z_m) {
  using I = IntOf<F>;
  const F u = (x_m - F(grid.min_x_m)) * F(grid.cells_per_m), v = (z_m - F(grid.min_z_m)) * F(grid.cells_per_m);
  const F u0 = floor(u + F(0.5f)), v0 = floor(v + F(0.5f));
  const F tu = u - u0, tv = v - v0;
  const I i0 = to_int_trunc(u0), j0 = to_int_trunc(v0);
  const auto wrapped = [&](I index, std::int32_t count) SHOAL_LAMBDA {
    return grid.wraps != 0 ? index & I(count - 1) : min(max(index, I(0)), I(count - 1));
  };
  I column[3];
  for (int k = 0; k < 3; ++k) column[k] = wrapped(i0 + I(k - 1), grid.count_x);
  // Weights of the three coefficients each way, and their derivatives as those of the two differences between them.
  const F half = F(0.5f);
  const F before_u = half - tu, after_u = half + tu, before_v = half - tv, after_v = half + tv;
  F row[3], row_slope[3];
  for (int k = 0; k < 3; ++k) {
    const I at = wrapped(j0 + I(k - 1), grid.count_z) * I(grid.count_x) + I(grid.first);
    const F a = surface_value(values, at + column[0]), b = surface_value(values, at + column[1]);
    const F c = surface_value(values, at + column[2]);
    row[k] = b + half * (before_u * before_u * (a - b) + after_u * after_u * (c - b));
    row_slope[k] = before_u * (b - a) + after_u * (c - b);
  }
  const F a = half * before_v * before_v, c = half * after_v * after_v;
  const F scale = F(grid.cells_per_m);
  return {row[1] + (a * (row[0] - row[1]) + c * (row[2] - row[1])),
          scale * (row_slope[1] + (a * (row_slope[0] - row_slope[1]) + c * (row_slope[2] - row_slope[1]))),
          scale * (before_v * (row[1] - row[0]) + after_v * (row[2] - row[1]))};
}

// Height and slope at a point of the plane.
//
//   x_m, z_m   metres along axis_x and axis_z from the body's origin; beyond +-reach_m, and NaN, as at the limit
// Returns the height along the normal and its derivatives along the axes; but for ripples on a grid the derivatives are
// those of the height returned. Kinds are told apart outside of the lanes. The same bits for float and WideF.
// Error: gradient within 1e-4 of the slope bound of central differences in double (tests/water/test_surface.cpp).
template <class F>
SHOAL_INLINE SurfacePoint<F> surface_at(const WaterSurface& surface, F x_m, F z_m) {
  const F x = clamp(x_m, F(-surface.reach_m), F(surface.reach_m));
  const F z = clamp(z_m, F(-surface.reach_m), F(surface.reach_m));
  SurfacePoint<F> sum = {F(0.0f), F(0.0f), F(0.0f)};
  const auto add = [&](const SurfacePoint<F>& p) SHOAL_LAMBDA {
    sum.height_m = sum.height_m + p.height_m;
    sum.slope_x = sum.slope_x + p.slope_x;
    sum.slope_z = sum.slope_z + p.slope_z;
  };
  for (std::size_t i = 0; i < surface.noise.size(); ++i) add(noise_layer_at(surface.noise[i], x, z));
  for (std::size_t i = 0; i < surface.ripples.size(); ++i) add(ripple_at(surface.ripples[i], x, z));
  if (surface.trochoids.size() != 0) add(trochoids_at(surface.trochoids.data(), surface.trochoids.size(), x, z));
  for (std::size_t i = 0; i < surface.normal_grids.size(); ++i) {
    add(normal_grid_at(surface.normal_grids[i], surface.grid_values.data(), x, z));
  }
  for (std::size_t i = 0; i < surface.spline_grids.size(); ++i) {
    add(spline_grid_at(surface.spline_grids[i], surface.grid_values.data(), x, z));
  }
  return sum;
}

// The unit normal of a slope, on the plane normal's side.
//   axis_x, normal, axis_z   the body's, world space, unit and orthogonal
// Source: Li et al., eq. 4, as the cross product of the tangents, (-df/dx, 1, -df/dz).
template <class F>
SHOAL_INLINE Vec3<F> surface_normal(Vec3<F> axis_x, Vec3<F> normal, Vec3<F> axis_z, F slope_x, F slope_z) {
  const F scale = F(1.0f) / sqrt((slope_x * slope_x + slope_z * slope_z) + F(1.0f));
  return (normal - (axis_x * slope_x + axis_z * slope_z)) * scale;
}

}  // namespace shoal::inline SHOAL_ISA_NS
