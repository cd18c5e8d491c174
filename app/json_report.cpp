#include "app/json_report.h"
#include "water/surface_keys.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace shoal::app {
namespace {

// Kibibytes on Linux.
double peak_rss_mb() {
  struct rusage usage {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

const char* category_of(const std::string& method) {
  for (const MethodInfo& info : method_infos())
    if (method == info.name) return info.category;
  return "";
}

// A method's option as a number or a truth value where it is one.
Json option_value(const std::string& text) {
  if (text == "true" || text == "false") return text == "true";
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) return text;
  if (value == std::floor(value) && std::fabs(value) < 1e15) return static_cast<std::int64_t>(value);
  return value;
}

void add_method_options(const FrameSettings& frame, Json& settings) {
  for (const MethodInfo& method : method_infos()) {
    if (frame.method != method.name) continue;
    for (const MethodOptionInfo& option : method.options) {
      const auto given = frame.method_options.find(option.key);
      settings[frame.method + "." + option.key] =
          option_value(given == frame.method_options.end() ? option.default_value : given->second);
    }
  }
}

// A key's value where all bodies agree on it, else a list with each body's.
void add_water_keys(const RenderScene& scene, Json& settings) {
  if (scene.waters.empty()) return;
  std::vector<Json> bodies;
  for (const WaterBody& body : scene.waters) bodies.push_back(water_json(body));
  Json keys = Json::object();
  for (const Json& body : bodies) keys.update(body);
  for (const auto& item : keys.items()) {
    const std::string& key = item.key();
    const std::string name = key == "size" ? "water_size" : key;  // `size` is the frame's
    Json values = Json::array();
    for (const Json& body : bodies) values.push_back(body.value(key, Json()));
    const bool same = std::all_of(values.begin(), values.end(), [&](const Json& v) { return v == values.front(); });
    settings[name] = same ? values.front() : values;
  }
}

Json background_json(const Background& background) {
  if (background.kind != Background::Kind::kColor) return "environment";
  return json_vector(background.color);
}

// Of the frames in the middle, so that the stages of an even number of frames sum to what their median is.
Json median_stages(const RunTimes& times) {
  std::vector<std::size_t> order(times.frames_ms.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return times.frames_ms[a] < times.frames_ms[b]; });
  const auto& low = times.stages_ms[order[(order.size() - 1) / 2]];
  const auto& high = times.stages_ms[order[order.size() / 2]];
  Json stages = Json::object();
  for (std::size_t i = 0; i < low.size() && i < high.size(); ++i) {
    stages[low[i].first] = json_double((low[i].second + high[i].second) / 2);
  }
  return stages;
}

// Microseconds are what a clock gives; more digits would be noise.
Json json_ms(double ms) { return json_double(std::round(ms * 1e4) / 1e4); }

}  // namespace

std::string compiler_name() {
#if defined(__clang__)
  return __VERSION__;
#else
  return std::string("GCC ") + __VERSION__;
#endif
}

Json json_float(float value) {
  if (!std::isfinite(value)) return nullptr;
  char text[64];
  const auto [end, error] = std::to_chars(text, text + sizeof text, value);
  double shortest = static_cast<double>(value);
  if (error == std::errc()) std::from_chars(text, end, shortest);
  return shortest;
}

Json json_double(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json json_vector(Vec2f v) { return Json::array({json_float(v.x), json_float(v.y)}); }
Json json_vector(Vec3f v) { return Json::array({json_float(v.x), json_float(v.y), json_float(v.z)}); }

std::string hex_float(float value) { return fmt::format("{:a}", static_cast<double>(value)); }

Json json_hex(const std::vector<float>& values) {
  Json hex = Json::array();
  for (const float value : values) hex.push_back(hex_float(value));
  return hex;
}

std::string json_text(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2;
}

// The keys in force, with the kind's own values where none were given.
void add_surface_keys(const SurfaceSettings& settings, Json& json) {
  const SurfaceSettings s = resolve_surface(settings);
  std::string name = surface_kind_name(s.kind);
  for (std::size_t i = 0; i < s.parts.size(); ++i) {
    name = (i == 0 ? "" : name + "+") + surface_kind_name(s.parts[i].kind);
  }
  json["surface"] = name;
  if (s.kind == SurfaceKind::kFlat) return;
  if (s.kind == SurfaceKind::kSum && s.slope) json["slope"] = json_float(*s.slope);
  for (const SurfaceNumber& key : surface_numbers()) {
    const std::optional<double> value = s.kind == SurfaceKind::kSum ? std::nullopt : key.get(s);
    if (value)
      json[key.name] = key.whole ? Json(static_cast<std::int64_t>(*value)) : json_float(static_cast<float>(*value));
  }
  if (s.kind != SurfaceKind::kSum) {
    for (const SurfaceChoice& key : surface_choices()) json[key.name] = key.values[key.get(s)];
    return;
  }
  // Each part's own.
  json["surface_parts"] = Json::array();
  for (const SurfaceSettings& part : s.parts) {
    Json part_json = Json::object();
    add_surface_keys(part, part_json);
    json["surface_parts"].push_back(part_json);
  }
}

Json water_json(const WaterBody& body) {
  // The outline's extent along the body's own axes: `size`, when the body was given by one.
  float low_x = 0, high_x = 0, low_z = 0, high_z = 0;
  for (std::size_t i = 0; i < body.outline.size(); ++i) {
    const Vec3f p = body.outline[i] - body.origin;
    const float x = dot(p, body.axis_x), z = dot(p, body.axis_z);
    low_x = i ? std::min(low_x, x) : x;
    high_x = i ? std::max(high_x, x) : x;
    low_z = i ? std::min(low_z, z) : z;
    high_z = i ? std::max(high_z, z) : z;
  }
  Json json = Json::object();
  json["size"] = json_vector(Vec2f{high_x - low_x, high_z - low_z});
  json["depth"] = json_float(body.depth_m);
  json["ior"] = json_float(body.ior);
  json["absorption"] = json_vector(body.absorption_per_m);
  add_surface_keys(body.surface, json);
  json["geometry"] = geometry_name(body.surface.geometry);
  return json;
}

Json settings_json(const Options& options, const LoadedScene& loaded, const PlacedCamera& camera, int threads) {
  const FrameSettings& frame = options.frame;
  const RenderScene& scene = loaded.render;
  Json s = Json::object();
  s["method"] = frame.method;
  add_method_options(frame, s);
  s["size"] = {frame.width_px, frame.height_px};
  s["spp"] = frame.spp;
  s["camera"] = camera.name;
  s["time"] = options.time_s;
  s["step"] = options.step_s;
  s["frames"] =
      options.frames ? Json(fmt::format("{}:{}", options.frames->first, options.frames->last)) : Json(nullptr);
  s["warmup"] = options.warmup;
  s["repeat"] = options.repeat;
  s["threads"] = threads;
  s["tile"] = frame.tile_px;
  s["isa"] = isa_name(frame.isa);
  s["anisotropy"] = frame.anisotropy;
  s["shadows"] = shadows_name(frame.shadows);
  s["shadow-map"] = frame.shadow_map_px;
  s["reflections"] = reflections_name(reflections_of(frame));
  s["exposure"] = json_float(frame.exposure_stops);
  s["tonemap"] = tone_map_name(frame.tone_map);
  s["background"] = background_json(scene.lighting.background);
  s["environment"] = loaded.environment_file.empty() ? Json(nullptr) : Json(loaded.environment_file);
  s["cache"] = options.scene.cache.empty() ? Json(nullptr) : Json(options.scene.cache);
  s["aov"] = Json::array();
  for (const Aov aov : options.aovs) {
    for (const AovInfo& info : aov_infos()) {
      if (info.aov == aov) s["aov"].push_back(info.name);
    }
  }
  s["triangles"] = scene.geometry.triangles.size();
  add_water_keys(scene, s);
  return s;
}

Json render_report(const Options& options, const LoadedScene& loaded, const PlacedCamera& camera, int threads,
                   const Frame& first_frame, const RunTimes& times) {
  const FrameSettings& frame = options.frame;
  Json r = Json::object();
  r["scene"] = options.scene.name;
  r["method"] = frame.method;
  r["category"] = category_of(frame.method);
  r["size"] = {frame.width_px, frame.height_px};
  r["triangles"] = loaded.render.geometry.triangles.size();
  r["water_pixels"] = first_frame.water_pixels;
  r["threads"] = threads;
  r["tile"] = frame.tile_px;
  r["isa"] = isa_name(frame.isa);
  r["spp"] = frame.spp;
  r["settings"] = settings_json(options, loaded, camera, threads);
  r["version"] = SHOAL_VERSION;
  r["compiler"] = compiler_name();
  r["load_ms"] = json_ms(times.load_ms);
  r["build_ms"] = json_ms(times.build_ms);
  r["write_ms"] = json_ms(times.write_ms);
  r["stages_ms"] = median_stages(times);
  Json summary = Json::object();
  summary["median"] = json_ms(median(times.frames_ms));
  summary["min"] = json_ms(*std::min_element(times.frames_ms.begin(), times.frames_ms.end()));
  summary["n"] = times.frames_ms.size();
  r["frame_ms"] = summary;
  r["frames_ms"] = Json::array();
  for (const double ms : times.frames_ms) r["frames_ms"].push_back(json_ms(ms));
  r["frame_digests"] = times.frame_digests;
  if (!first_frame.method_figures.empty()) {
    r["method_figures"] = Json::object();
    for (const auto& [name, value] : first_frame.method_figures) r["method_figures"][name] = json_ms(value);
  }
  if (!first_frame.rays.empty()) {
    r["rays"] = Json::object();
    for (const auto& [kind, count] : first_frame.rays) r["rays"][kind] = count;
  }
  r["counters"] = {
      {"fetches_per_water_pixel",
       {{"mean", json_double(std::round(first_frame.mean_fetches * 1e3) / 1e3)}, {"max", first_frame.max_fetches}}}};
  r["peak_rss_mb"] = json_double(std::round(peak_rss_mb() * 10) / 10);
  return r;
}

}  // namespace shoal::app
