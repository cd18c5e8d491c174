// The frames of a run: where the camera is in each, and how they are timed (docs/command.md, --time to --repeat).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "app/json_report.h"
#include "app/load.h"
#include "app/options.h"
#include "app/progress.h"

namespace shoal::app {

// A scene, seen by one of its cameras at the times of the options.
class FrameRun {
 public:
  // All three must outlive the run.
  FrameRun(const LoadedScene& loaded, const PlacedCamera& camera, const Options& options);

  // Looks at the first body of water at this angle from now on, see camera_of.
  void set_view_angle(double degrees) { view_angle_degrees_ = degrees; }

  double time_of(std::int64_t k) const { return options_.time_s + static_cast<double>(k) * options_.step_s; }
  // Where the camera is at frame k's time. With a view angle: moved on a circle about the point where its axis meets
  // the water's plane, until the axis makes that angle with the plane.
  Camera camera_of(std::int64_t k) const;

  // Adds the time that it took to that of the scene's, and sets times.build_ms to both.
  std::unique_ptr<Renderer> make_renderer(const FrameSettings& settings, RunTimes& times) const;

  // Warm-up frames, where the run is repeated, then the counted ones, each from a new camera and at a new time.
  //   each  is called for every counted frame, k from 0
  void time_frames(Renderer& renderer, RunTimes& times, Progress& progress,
                   const std::function<void(std::int64_t k, const Frame& frame)>& each) const;
  // How many that are.
  std::int64_t timed_frames() const { return warmup() + options_.repeat; }

 private:
  std::int64_t warmup() const { return options_.repeat > 1 ? options_.warmup : 0; }

  const LoadedScene& loaded_;
  const PlacedCamera& camera_;
  const Options& options_;
  std::optional<double> view_angle_degrees_;
};

// Adds a finished frame to the times.
void count_frame(const Frame& frame, RunTimes& times);

}  // namespace shoal::app
