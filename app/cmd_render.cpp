// shoal render: one frame, a run of frames, or the same frame timed again and again.
#include <fmt/format.h>

#include <chrono>
#include <memory>

#include "app/commands.h"
#include "app/json_report.h"
#include "app/load.h"
#include "app/output.h"
#include "app/pictures.h"
#include "app/progress.h"
#include "core/error.h"
#include "core/math.h"

namespace shoal::app {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

// The camera turned left about world up (+y) by k tenths of a degree, from where it stands.
Camera turned_left(const Camera& camera, std::int64_t k) {
  if (k == 0) return camera;
  constexpr float kTenthDegree = 0.00174532925f;
  const float angle = static_cast<float>(k % 3600) * kTenthDegree;
  const float s = det_sin(angle), c = det_cos(angle);
  const auto turn = [&](Vec3f v) { return Vec3f{c * v.x + s * v.z, v.y, c * v.z - s * v.x}; };
  Camera turned = camera;
  turned.right_world = turn(camera.right_world);
  turned.up_world = turn(camera.up_world);
  turned.forward_world = turn(camera.forward_world);
  return turned;
}

bool is_exr(const std::string& path) { return has_ending(path, ".exr"); }

// Everything of one `shoal render` between its parts.
class Render {
 public:
  explicit Render(const RawOptions& raw) : options_(read_options(raw)) {}

  void run() {
    check_outputs();
    loaded_ = load_scene(options_.scene, options_.quiet);
    loaded_.scene = Scene{};  // what is drawn has its own copy
    camera_ = &pick_camera(loaded_.render, options_.camera);
    times_.load_ms = loaded_.load_ms;
    if (options_.repeat > 1) {
      time_frames();
    } else {
      write_frames();
    }
  }

 private:
  void check_outputs() const {
    if (!options_.output && !options_.json && !options_.digest) {
      throw UsageError("render: nothing to write; expected -o FILE.png, -o FILE.exr, --json or --digest");
    }
    if (options_.output) check_writable(options_.frames ? output_name(options_.frames->first) : *options_.output);
    if (options_.json && *options_.json != "-") check_writable(*options_.json);
  }

  std::string output_name(std::int64_t frame_number) const {
    return options_.frames ? NamePattern("-o", *options_.output).name(frame_number) : *options_.output;
  }

  double time_of(std::int64_t k) const { return options_.time_s + static_cast<double>(k) * options_.step_s; }
  Camera camera_now(std::int64_t k) const { return camera_at(loaded_.render, *camera_, time_of(k)); }

  // With the extra buffers that the outputs need, or bare, as a frame is timed.
  std::unique_ptr<Renderer> make_renderer(bool with_outputs) {
    FrameSettings settings = options_.frame;
    settings.digests = with_outputs && options_.digest;
    settings.keep_linear = with_outputs && options_.output && is_exr(*options_.output);
    if (!settings.keep_linear) settings.aovs = 0;
    const auto begin = Clock::now();
    auto renderer = std::make_unique<Renderer>(loaded_.render, settings);
    times_.build_ms = loaded_.build_ms + milliseconds_since(begin);
    threads_ = renderer->threads();
    return renderer;
  }

  void count(const Frame& frame) {
    times_.frames_ms.push_back(frame.frame_ms);
    times_.stages_ms.push_back(frame.stages_ms);
    times_.frame_digests.push_back(picture_digest(frame));
  }

  // Keeps what the report and a PNG of the first frame need.
  void note_first(const Frame& frame) {
    first_.width_px = frame.width_px;
    first_.height_px = frame.height_px;
    first_.water_pixels = frame.water_pixels;
    if (options_.repeat > 1) first_.srgb8 = frame.srgb8;
    if (frame.subdivision_capped > 0 && !options_.quiet) {
      warn(options_.scene.name, fmt::format("{} triangles reached the subdivision's level cap: they may be off by more "
                                            "than a quarter of a pixel",
                                            frame.subdivision_capped));
    }
  }

  // Warm-up frames, then the counted ones, each from a new camera and at a new time; frame 0 is then drawn again for
  // the outputs, so that no digest or layer is in the times. The bytes are the same by contract.
  void time_frames() {
    Frame frame;
    {
      const std::unique_ptr<Renderer> renderer = make_renderer(false);
      Progress progress("frame", options_.warmup + options_.repeat, options_.quiet);
      for (std::int64_t k = -options_.warmup; k < options_.repeat; ++k) {
        renderer->render(turned_left(camera_now(k), k), time_of(k), frame);
        if (k >= 0) count(frame);
        if (k == 0) note_first(frame);
        progress.step_done();
      }
    }
    if (needs_outputs()) {
      const double build_ms = times_.build_ms;
      make_renderer(true)->render(camera_now(0), time_of(0), frame);
      times_.build_ms = build_ms;
      print_digests(frame);
      write_picture(frame, options_.output);
    } else {
      write_picture(first_, options_.output);
    }
    finish();
  }

  bool needs_outputs() const { return options_.digest || (options_.output && is_exr(*options_.output)); }

  void write_frames() {
    const FrameRange range = options_.frames.value_or(FrameRange{0, 0});
    const std::unique_ptr<Renderer> renderer = make_renderer(true);
    Progress progress("frame", range.last - range.first + 1, options_.quiet);
    Frame frame;
    for (std::int64_t k = range.first; k <= range.last; ++k) {
      commit_picture();
      renderer->render(camera_now(k), time_of(k), frame);
      count(frame);
      if (k == range.first) note_first(frame);
      print_digests(frame);
      if (options_.output) write_picture(frame, output_name(k));
      progress.step_done();
    }
    finish();
  }

  void print_digests(const Frame& frame) const {
    if (!options_.digest) return;
    std::string lines;
    for (const auto& [stage, hex] : frame.digests) lines += fmt::format("digest {} {}\n", stage, hex);
    write_stdout(lines);
  }

  void write_picture(const Frame& frame, const std::optional<std::string>& path) {
    if (!path) return;
    const auto begin = Clock::now();
    picture_ = std::make_unique<OutputFile>(*path);
    if (is_exr(*path)) {
      write_exr(picture_->stream(), *path, frame);
    } else {
      write_png(picture_->stream(), *path, frame);
    }
    picture_->finish();
    times_.write_ms += milliseconds_since(begin);
  }

  void commit_picture() {
    if (picture_) picture_->commit();
    picture_.reset();
  }

  // The report and the last picture take their places together, once both are on the disk.
  void finish() {
    if (options_.json) {
      const std::string text = json_text(render_report(options_, loaded_, *camera_, threads_, first_, times_));
      if (*options_.json == "-") {
        write_stdout(text);
      } else {
        OutputFile report(*options_.json);
        std::fwrite(text.data(), 1, text.size(), report.stream());
        report.finish();
        commit_picture();
        report.commit();
      }
    }
    commit_picture();
  }

  Options options_;
  LoadedScene loaded_;
  const PlacedCamera* camera_ = nullptr;
  int threads_ = 0;
  Frame first_;  // see note_first
  RunTimes times_;
  std::unique_ptr<OutputFile> picture_;  // on the disk, not yet in its place
};

}  // namespace

int run_render(const RawOptions& raw) {
  Render(raw).run();
  return 0;
}

}  // namespace shoal::app
