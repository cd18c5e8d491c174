// shoal render: one frame, a run of frames, or the same frame timed again and again.
#include <fmt/format.h>

#include <chrono>
#include <memory>

#include "app/commands.h"
#include "app/frame_run.h"
#include "app/json_report.h"
#include "app/load.h"
#include "app/output.h"
#include "app/pictures.h"
#include "app/progress.h"
#include "core/error.h"

namespace shoal::app {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
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
    run_ = std::make_unique<FrameRun>(loaded_, *camera_, options_);
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

  // With the extra buffers that the outputs need, or bare, as a frame is timed.
  std::unique_ptr<Renderer> make_renderer(bool with_outputs) {
    FrameSettings settings = options_.frame;
    settings.digests = with_outputs && options_.digest;
    settings.keep_linear = with_outputs && options_.output && is_exr(*options_.output);
    if (!settings.keep_linear) settings.aovs = 0;
    auto renderer = run_->make_renderer(settings, times_);
    threads_ = renderer->threads();
    return renderer;
  }

  // Keeps what the report and a PNG of the first frame need.
  void note_first(const Frame& frame) {
    first_.width_px = frame.width_px;
    first_.height_px = frame.height_px;
    first_.water_pixels = frame.water_pixels;
    first_.mean_fetches = frame.mean_fetches, first_.max_fetches = frame.max_fetches;
    first_.rays = frame.rays;
    first_.method_figures = frame.method_figures;
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
    {
      const std::unique_ptr<Renderer> renderer = make_renderer(false);
      Progress progress("frame", run_->timed_frames(), options_.quiet);
      run_->time_frames(*renderer, times_, progress, [&](std::int64_t k, const Frame& frame) {
        if (k == 0) note_first(frame);
      });
    }
    if (needs_outputs()) {
      const double build_ms = times_.build_ms;
      Frame frame;
      make_renderer(true)->render(run_->camera_of(0), run_->time_of(0), frame);
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
      renderer->render(run_->camera_of(k), run_->time_of(k), frame);
      count_frame(frame, times_);
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
  std::unique_ptr<FrameRun> run_;
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
