// A surface prepared for one time: plain data that kernels read (water/surface.h). water/prepare_surface.h fills it.
#pragma once

#include <cstdint>

#include "core/pod_vector.h"

namespace shoal {

// Gradient noise over an affine image of the plane:
//   p = (xx, xz; zx, zz) (x, z) + offset, lattice point (cell_x, cell_z) + floor(p).
struct NoiseLayer {
  float xx, xz, zx, zz;      // cells a metre
  float offset_x, offset_z;  // cells, 0 to 1
  std::int32_t cell_x, cell_z, seed;
  float amplitude_m;
  std::int32_t cubic;  // fade curve: 1 cubic, 0 quintic
};

// A sine of the distance r from a point, softened at the point:
//   amplitude fade(r) sin(2 pi (turns_per_m r + phase)), r = sqrt(distance^2 + soften2)
struct RippleSource {
  float x_m, z_m, soften2_m2;
  float amplitude_m;  // with the fading in time
  float turns_per_m, phase_turns;
  float inverse_reach_per_m;
  std::int32_t exponential;
};

// A trochoidal wave: what lies at rest at p moves to p - push sin(phase(p)), height amplitude cos(phase(p)).
struct TrochoidWave {
  float turns_x_per_m, turns_z_per_m, phase_turns;
  float amplitude_m;
  float push_x_m, push_z_m;
  float slope_variance;  // its share of the surface's mean squared slope
};

// Heights on a grid, with the unit normals at its points: Champandard's water buffer.
struct NormalGrid {
  std::int32_t first;  // in WaterSurface::grid_values: count^2 rows along x of height, normal x, normal y, normal z
  std::int32_t count;  // points a side
  float min_x_m, min_z_m, cells_per_m_x, cells_per_m_z;
  float turns_per_m, slope_variance;  // of its waves; mean squared slope over the grid
};

// Coefficients of a quadratic B-spline on a square grid, one every cell: coefficient (i, j) belongs to
// (min_x_m + i / cells_per_m, min_z_m + j / cells_per_m).
struct SplineGrid {
  std::int32_t first;  // in WaterSurface::grid_values: rows along x
  std::int32_t count_x, count_z;
  std::int32_t wraps;  // 1: repeats, the counts are powers of two; 0: beyond the edge as at it
  float min_x_m, min_z_m, cells_per_m;
  // What is left for footprints: the same waves over a square of side sqrt(square_m2) (0: all of them), with their mean
  // squared slope, and the mean product with the slopes of the next coarser grid (0: there is none).
  float square_m2, slope_variance, next_covariance;
  std::int32_t first_coarser, coarser_count;  // in WaterSurface::coarser_grids
  float turns_per_m;                          // of its waves, where it has none: they fade together
};

struct WaterSurface {
  // The height is the sum of all of these.
  PodVector<NoiseLayer> noise;
  PodVector<RippleSource> ripples;
  PodVector<TrochoidWave> trochoids;
  PodVector<NormalGrid> normal_grids;
  PodVector<SplineGrid> spline_grids;
  PodVector<SplineGrid> coarser_grids;  // no terms of the sum: they stand in for those above (water/filter_surface.h)
  PodVector<float> grid_values;
  bool filtered = true;  // over a pixel's footprint
  float reach_m = 1e6f;  // beyond it in x or z the surface is as at it
  // Over the body: |height| and the length of the slope are never above, and come within half of them.
  float height_bound_m = 0;
  float slope_bound = 0;
};

// A rectangle of the body's plane, in metres along axis_x and axis_z from its origin.
struct PlaneExtent {
  float min_x_m, min_z_m, max_x_m, max_z_m;
};

}  // namespace shoal
