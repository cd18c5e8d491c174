// shoal compare: methods side by side, measured against a reference.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <set>

#include "app/commands.h"
#include "app/compare_options.h"
#include "app/frame_run.h"
#include "app/json_report.h"
#include "app/load.h"
#include "app/output.h"
#include "app/pictures.h"
#include "app/progress.h"
#include "compare/map_color.h"
#include "compare/report.h"
#include "core/error.h"

namespace shoal::app {
namespace {

// One method's frame and what it took.
struct Drawn {
  Frame frame;  // frame 0, with hit buffers
  RunTimes times;
  int threads = 0;
};

ReportTimes report_times(const RunTimes& times) {
  return {median(times.frames_ms), *std::min_element(times.frames_ms.begin(), times.frames_ms.end()),
          times.frames_ms.size()};
}

Drawn draw(const FrameRun& run, const Options& options, bool keep_linear, Progress& progress) {
  Drawn drawn;
  FrameSettings settings = options.frame;
  settings.aovs = 0;
  run.time_frames(*run.make_renderer(settings, drawn.times), drawn.times, progress, [](std::int64_t, const Frame&) {});
  // In a frame of its own, as `render` does: no buffer beside the picture is in the times.
  settings.aovs = options.frame.aovs | kHitAovs;
  settings.keep_linear = keep_linear;
  // Pictures differ by refraction alone; times are those of each method's own reflections.
  settings.reflections = options.frame.reflections.value_or(Reflections::kTraced);
  const auto renderer = run.make_renderer(settings, drawn.times);
  renderer->render(run.camera_of(0), run.time_of(0), drawn.frame);
  drawn.threads = renderer->threads();
  progress.step_done();
  return drawn;
}

// Empty, and warned of, where the method is not made for the scene.
std::optional<Drawn> draw_if_applicable(const FrameRun& run, const Options& options, bool keep_linear,
                                        Progress& progress) {
  try {
    return draw(run, options, keep_linear, progress);
  } catch (const NotApplicable& error) {
    warn(options.scene.name, error.what());
    for (std::int64_t k = 0; k <= run.timed_frames(); ++k) progress.step_done();
    return std::nullopt;
  }
}

// A loaded scene at the options' time: what the metrics look things up in.
class SceneThen {
 public:
  SceneThen(const RenderScene& scene, double time_s) : scene_(&scene) {
    if (!scene.moves()) return;
    moved_ = std::make_unique<RenderScene>(scene);
    update_render_scene(*moved_, time_s);
    scene_ = moved_.get();
  }
  const RenderScene& operator*() const { return *scene_; }

 private:
  std::unique_ptr<RenderScene> moved_;
  const RenderScene* scene_;
};

MetricSettings metric_settings(const CompareOptions& options) {
  return {{options.pixels_per_degree, best_isa()}, options.yee};
}

// --- metrics.json ---------------------------------------------------------------------------------------------------

Json picture_metrics_json(const PictureMetrics& metrics) {
  Json json = Json::object();
  json["flip"] = json_double(metrics.flip);
  json["psnr_db"] = json_double(metrics.psnr_db);
  json["yee_failed"] = metrics.yee_failed ? Json(*metrics.yee_failed) : Json(nullptr);
  return json;
}

Json percentiles_json(const Percentiles& p) {
  Json json = Json::object();
  json["median"] = json_double(p.median);
  json["p95"] = json_double(p.p95);
  json["p99"] = json_double(p.p99);
  return json;
}

Json method_json(const ReportMethod& method) {
  Json json = Json::object();
  json["name"] = method.name;
  json["category"] = method.category;
  json["ms"] = {{"median", json_double(method.times.median_ms)},
                {"min", json_double(method.times.min_ms)},
                {"n", method.times.n}};
  json["water"] = picture_metrics_json(method.metrics.water);
  json["frame"] = picture_metrics_json(method.metrics.frame);
  json["hit_error_px"] = percentiles_json(method.metrics.hits.error_px);
  json["hit_error_m"] = percentiles_json(method.metrics.hits.error_m);
  json["wrong_object"] = json_double(method.metrics.hits.wrong_object);
  json["wrong_surface"] = json_double(method.metrics.hits.wrong_surface);
  json["secondary_share"] = json_double(method.metrics.hits.secondary_share);
  json["wrong_object_primary"] = json_double(method.metrics.hits.wrong_object_primary);
  json["wrong_surface_primary"] = json_double(method.metrics.hits.wrong_surface_primary);
  json["spots"] = Json::array();
  for (const Spot& spot : method.metrics.spots) {
    json["spots"].push_back(
        {{"x", spot.x}, {"y", spot.y}, {"size_px", spot.size_px}, {"flip_max", json_float(spot.greatest)}});
  }
  return json;
}

// Of all methods: what they share, then each one's own as METHOD.KEY.
Json shared_settings(const CompareOptions& options, const LoadedScene& loaded, const PlacedCamera& camera,
                     int threads) {
  Json settings = settings_json(options.reference, loaded, camera, threads);
  settings.erase("method");
  if (!options.reference.frame.reflections)
    settings["reflections"] = "traced in pictures; in times planar (raster, volume) or traced (hybrid, traced)";
  settings.erase("frames");
  settings["ppd"] = json_float(options.pixels_per_degree);
  settings["yee"] = options.yee;
  for (const Options& method : options.methods) {
    const std::string prefix = method.frame.method + ".";
    const Json own = settings_json(method, loaded, camera, threads);
    for (const auto& item : own.items()) {
      if (item.key().rfind(prefix, 0) == 0) settings[item.key()] = item.value();
    }
  }
  return settings;
}

std::string processor_name() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    const std::size_t colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

// --- The command ----------------------------------------------------------------------------------------------------

// Keys that a scene is not read again for.
bool keeps_scene(const std::string& key) {
  static const std::set<std::string> keys = {kViewAngle, "time",   "spp",     "anisotropy",
                                             "size",     "camera", "threads", "shadow-map"};
  return keys.count(key) > 0;
}

class Compare {
 public:
  explicit Compare(const CompareArguments& arguments)
      : arguments_(arguments), options_(read_compare_options(arguments)), quiet_(options_.reference.quiet) {}

  void run() {
    OutputFolder folder(options_.folder);
    loaded_ = read_loaded(options_);
    camera_ = &pick_camera(loaded_.render, options_.reference.camera);
    Progress progress("frame", frames_in_all(), quiet_);
    compare(folder, progress);
    if (options_.sweep) sweep(folder, progress);
    write_numbers(folder);
    folder.commit();
  }

 private:
  LoadedScene read_loaded(const CompareOptions& options) const {
    LoadedScene loaded = load_scene(options.reference.scene, quiet_);
    loaded.scene = Scene{};
    return loaded;
  }

  std::int64_t frames_in_all() const {
    const Options& o = options_.reference;
    const std::int64_t timed = (o.repeat > 1 ? o.warmup : 0) + o.repeat;
    const auto methods = static_cast<std::int64_t>(options_.methods.size()) + 1;
    const auto points = 1 + (options_.sweep ? static_cast<std::int64_t>(options_.sweep->values.size()) : 0);
    return (timed + 1) * methods * points;
  }

  ReportMethod describe(const std::string& name, const RunTimes& times) const {
    ReportMethod method;
    method.name = name;
    method.times = report_times(times);
    for (const MethodInfo& info : method_infos()) {
      if (name != info.name) continue;
      method.category = info.category;
      method.description = info.description;
      method.source = info.source;
    }
    return method;
  }

  // A picture to the folder, and its bytes for the report.
  static std::string add_png(OutputFolder& folder, const std::string& name, const Frame& size,
                             const std::vector<std::uint8_t>& rgb) {
    std::string bytes = png_bytes(size.width_px, size.height_px, rgb);
    folder.add(name, bytes);
    return bytes;
  }
  void add_exr(OutputFolder& folder, const std::string& name, const Frame& frame) const {
    if (!options_.exr) return;
    folder.add(name, [&](std::FILE* stream) { write_exr(stream, folder.file_path(name), frame); });
  }

  void compare(OutputFolder& folder, Progress& progress) {
    const FrameRun run(loaded_, *camera_, options_.reference);
    const SceneThen scene(loaded_.render, options_.reference.time_s);
    const Drawn truth = draw(run, options_.reference, options_.exr, progress);
    threads_ = truth.threads;
    ThreadPool pool(threads_);
    report_.reference = describe(options_.reference.frame.method, truth.times);
    report_.reference.picture_png = add_png(folder, "reference.png", truth.frame, truth.frame.srgb8);
    add_exr(folder, "reference.exr", truth.frame);
    for (const Options& options : options_.methods) {
      const std::optional<Drawn> shown = draw_if_applicable(run, options, options_.exr, progress);
      if (!shown) continue;
      const Drawn& drawn = *shown;
      ReportMethod method = describe(options.frame.method, drawn.times);
      method.metrics =
          measure_frame(*scene, run.camera_of(0), truth.frame, drawn.frame, metric_settings(options_), pool);
      report_.water_pixels = method.metrics.hits.water_pixels;
      method.picture_png = add_png(folder, method.name + ".png", drawn.frame, drawn.frame.srgb8);
      method.flip_png = add_png(folder, method.name + ".flip.png", drawn.frame, flip_map_rgb(method.metrics.flip, {}));
      method.hit_png = add_png(folder, method.name + ".hit.png", drawn.frame, hit_map_rgb(method.metrics.hits));
      add_exr(folder, method.name + ".exr", drawn.frame);
      report_.methods.push_back(std::move(method));
    }
  }

  void sweep(OutputFolder& folder, Progress& progress) {
    ReportSweep sweep{options_.sweep->key, options_.sweep->values, {}};
    for (const std::string& value : sweep.values) {
      const CompareOptions options = options_at(arguments_, sweep.key, value);
      LoadedScene own;
      if (!keeps_scene(sweep.key)) own = read_loaded(options);
      const LoadedScene& loaded = keeps_scene(sweep.key) ? loaded_ : own;
      const PlacedCamera& camera = pick_camera(loaded.render, options.reference.camera);
      FrameRun run(loaded, camera, options.reference);
      if (sweep.key == kViewAngle) run.set_view_angle(read_view_angle(value));
      sweep_point(run, SceneThen(loaded.render, options.reference.time_s), options, value, sweep, progress);
    }
    folder.add("sweep.csv", sweep_csv(sweep));
    report_.sweep = std::move(sweep);
  }

  static void sweep_point(const FrameRun& run, const SceneThen& scene, const CompareOptions& options,
                          const std::string& value, ReportSweep& sweep, Progress& progress) {
    const Drawn truth = draw(run, options.reference, false, progress);
    ThreadPool pool(truth.threads);
    for (const Options& method : options.methods) {
      const std::optional<Drawn> shown = draw_if_applicable(run, method, false, progress);
      if (!shown) continue;
      const Drawn& drawn = *shown;
      ReportSweepPoint point{value, method.frame.method, report_times(drawn.times), {}};
      point.metrics = measure_frame(*scene, run.camera_of(0), truth.frame, drawn.frame, metric_settings(options), pool);
      point.metrics.flip.clear();
      point.metrics.hits.error_map_px.clear();
      point.metrics.hits.wrong.clear();
      point.metrics.hits.water.clear();
      sweep.points.push_back(std::move(point));
    }
  }

  // metrics.json and, last, the report.
  void write_numbers(OutputFolder& folder) {
    const FrameSettings& frame = options_.reference.frame;
    const Json settings = shared_settings(options_, loaded_, *camera_, threads_);
    Json json = Json::object();
    json["scene"] = options_.reference.scene.name;
    json["size"] = {frame.width_px, frame.height_px};
    json["reference"] = frame.method;
    json["settings"] = settings;
    json["water_pixels"] = report_.water_pixels;
    json["methods"] = Json::array();
    for (const ReportMethod& method : report_.methods) json["methods"].push_back(method_json(method));
    folder.add("metrics.json", json_text(json));

    report_.scene = options_.reference.scene.name;
    report_.camera = camera_->name;
    report_.command = arguments_.command;
    report_.width_px = frame.width_px;
    report_.height_px = frame.height_px;
    report_.pixels_per_degree = options_.pixels_per_degree;
    report_.reference_is_truth = frame.method == std::string("ray-traced");
    report_.settings.emplace_back("version", SHOAL_VERSION);
    report_.settings.emplace_back("compiler", compiler_name());
    report_.settings.emplace_back("processor", processor_name());
    for (const auto& item : settings.items()) report_.settings.emplace_back(item.key(), item.value().dump());
    folder.add("report.html", report_html(report_));
  }

  const CompareArguments& arguments_;
  CompareOptions options_;
  bool quiet_;
  LoadedScene loaded_;
  const PlacedCamera* camera_ = nullptr;
  int threads_ = 0;
  Report report_;
};

}  // namespace

int run_compare(const CompareArguments& arguments) {
  Compare(arguments).run();
  return 0;
}

}  // namespace shoal::app
