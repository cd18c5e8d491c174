#include "app/frame_run.h"

#include <fmt/format.h>

#include <chrono>

#include "core/error.h"
#include "core/math.h"
#include "core/vec_lanes.h"

namespace shoal::app {
namespace {

using Clock = std::chrono::steady_clock;

Camera at_angle(const Camera& camera, const WaterBody& body, double degrees) {
  const Vec3f n = body.normal, eye = camera.position_world, forward = camera.forward_world;
  const float height = dot(eye - body.origin, n), along = dot(forward, n);
  const float distance = along != 0.0f ? -height / along : -1.0f;
  if (!(distance > 0.0f && distance < 1e6f)) {
    throw Error("view-angle: the camera's axis does not meet the water; expected a --camera that looks at it");
  }
  const Vec3f pivot = eye + forward * distance;
  Vec3f ahead = forward - n * along;
  // Straight down or up: ahead is where the frame's top is.
  if (dot(ahead, ahead) < 1e-10f) ahead = camera.up_world - n * dot(camera.up_world, n);
  ahead = ahead * (1.0f / std::sqrt(dot(ahead, ahead)));
  const float angle = static_cast<float>(degrees) * 0.0174532925f;
  const float towards = along < 0.0f ? -1.0f : 1.0f;
  Camera turned = camera;
  turned.forward_world = ahead * det_cos(angle) + n * (towards * det_sin(angle));
  // Level: the frame's right is along the water, on the side where it was.
  const Vec3f level = cross(ahead, n);
  turned.right_world = level * (dot(level, camera.right_world) < 0.0f ? -1.0f : 1.0f);
  turned.up_world = cross(turned.right_world, turned.forward_world);
  turned.position_world = pivot - turned.forward_world * distance;
  return turned;
}

}  // namespace

FrameRun::FrameRun(const LoadedScene& loaded, const PlacedCamera& camera, const Options& options)
    : loaded_(loaded), camera_(camera), options_(options) {}

Camera FrameRun::camera_of(std::int64_t k) const {
  const Camera camera = camera_at(loaded_.render, camera_, time_of(k));
  if (!view_angle_degrees_) return camera;
  if (loaded_.render.waters.empty()) throw Error("view-angle: the scene has no water; expected one with it");
  return at_angle(camera, loaded_.render.waters.front(), *view_angle_degrees_);
}

std::unique_ptr<Renderer> FrameRun::make_renderer(const FrameSettings& settings, RunTimes& times) const {
  const auto begin = Clock::now();
  auto renderer = std::make_unique<Renderer>(loaded_.render, settings);
  times.build_ms = loaded_.build_ms + std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
  return renderer;
}

void FrameRun::time_frames(Renderer& renderer, RunTimes& times, Progress& progress,
                           const std::function<void(std::int64_t k, const Frame& frame)>& each) const {
  Frame frame;
  for (std::int64_t k = -warmup(); k < options_.repeat; ++k) {
    renderer.render(turned_left(camera_of(k), k), time_of(k), frame);
    if (k >= 0) {
      count_frame(frame, times);
      each(k, frame);
    }
    progress.step_done();
  }
}

void count_frame(const Frame& frame, RunTimes& times) {
  times.frames_ms.push_back(frame.frame_ms);
  times.stages_ms.push_back(frame.stages_ms);
  times.frame_digests.push_back(picture_digest(frame));
}

}  // namespace shoal::app
