// From settings to what kernels read: once a body (make_surface_model), then once a frame (prepare_surface).
#pragma once

#include <memory>
#include <vector>

#include "water/body.h"
#include "water/ripple_filter.h"
#include "water/surface_data.h"

namespace shoal {

// A body's surface with its amplitudes found, for any time. Plain data, but for what a filter keeps to be fast.
struct SurfaceModel {
  struct Part {
    SurfaceSettings settings;  // resolved, no sum
    float amplitude_m = 0;
    std::vector<float> waves;              // spectrum: real and imaginary part of every wave at amplitude 1
    std::shared_ptr<RippleFilter> filter;  // ripple-filter: shared by copies, from any thread
  };
  SurfaceSettings settings;  // resolved
  PlaneExtent extent{0, 0, 0, 0};
  std::vector<Part> parts;  // of a sum, flattened; one of any other kind; none of a flat surface
};

// The smallest rectangle of the plane that holds the body's outline.
PlaneExtent plane_extent(const WaterBody& body);

// Finds the amplitudes. Where a slope is asked for, its RMS over the extent is measured on a fixed set of points
// (Roberts' R2 sequence) at time 0, of ripples over a life of theirs (of ripple-filter a lifetime; from the first of
// `drops` to that after the last), and met within 5 % (test_surface.cpp).
// At other times a body only a few waves across has another RMS, as it must; it is constant on the average.
//   extent   metres; of no area: a square of eight waves' side is measured instead
SurfaceModel make_surface_model(const SurfaceSettings& settings, const PlaneExtent& extent);

// The surface at a time.
//   time_s   seconds, |time_s| <= 1e6 (beyond, as there)
// Returns the data of surface_at with its bounds over the extent. The same bits on every machine.
WaterSurface prepare_surface(const SurfaceModel& model, double time_s);

// Both in one.
WaterSurface prepare_surface(const SurfaceSettings& settings, double time_s, const PlaneExtent& extent);

}  // namespace shoal
