#include "app/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "core/error.h"
#include "scene/images/environment.h"
#include "water/surface_keys.h"

namespace shoal::app {
namespace {

using Names = std::vector<std::string>;

constexpr int kMaxSpp = 256;
constexpr int kMaxThreads = 1024;
constexpr int kMaxRuns = 1'000'000;  // warm-up and repeated frames
constexpr double kMaxTime_s = 1e6;
constexpr double kMaxExposureStops = 64;
constexpr double kMaxRadiance = 1e6;    // of a background
constexpr double kMaxLength_m = 1e6;    // of a body of water
constexpr double kMaxAbsorption = 1e4;  // 1/m
constexpr std::int64_t kMaxTriangles = 50'000'000;

const Names kWaterKeys = {"size", "depth", "ior", "absorption", "surface", "geometry"};

[[noreturn]] void unknown(std::string_view option, std::string_view value, const Names& available) {
  throw UsageError(fmt::format("{} '{}': unknown; expected one of: {}", option, value, join(available)));
}

// One of `available`, by its place there.
std::size_t read_choice(std::string_view option, std::string_view value, const Names& available) {
  const auto found = std::find(available.begin(), available.end(), value);
  if (found != available.end()) return static_cast<std::size_t>(found - available.begin());
  unknown(option, value, available);
}

const MethodInfo* find_method(std::string_view name) {
  for (const MethodInfo& info : method_infos()) {
    if (info.name == name) return &info;
  }
  return nullptr;
}

Names method_names() {
  Names names;
  for (const MethodInfo& info : method_infos()) names.emplace_back(info.name);
  return names;
}

bool has_option(const MethodInfo& method, std::string_view key) {
  return std::any_of(method.options.begin(), method.options.end(), [&](const auto& o) { return o.key == key; });
}

// --- --set ----------------------------------------------------------------------------------------------------------

bool set_water_key(WaterOverrides& water, const std::string& key, const std::string& value) {
  const std::string option = "--set " + key;
  if (key == "size") {
    const std::vector<float> v = read_floats(option, value, 2, 1e-6, kMaxLength_m);
    water.size_m = Vec2f{v[0], v[1]};
  } else if (key == "depth") {
    water.depth_m = read_float(option, value, 1e-6, kMaxLength_m);
  } else if (key == "ior") {
    const float ior = read_float(option, value, -1e6, 1e6);
    // Compared in float, so that one third as a float is in.
    if (!(ior >= 1.0f / 3.0f && ior <= 3.0f))
      throw UsageError(option + " '" + value + "': out of range; expected 1/3 to 3");
    water.ior = ior;
  } else if (key == "absorption") {
    water.absorption_per_m = read_triple(option, value, 0.0, kMaxAbsorption);
  } else if (key == "surface") {
    Names names;
    for (const SurfaceKindInfo& info : surface_kinds()) names.emplace_back(info.name);
    std::vector<SurfaceKind> kinds;
    for (const std::string& name : split(value, '+')) {
      kinds.push_back(surface_kinds()[read_choice(option, name, names)].kind);
    }
    if (kinds.size() > kMaxSurfaceParts) {
      throw UsageError(
          fmt::format("{}: is a sum of {} surfaces; expected at most {}", option, kinds.size(), kMaxSurfaceParts));
    }
    water.surface = kinds;
  } else if (key == "geometry") {
    const bool displaced = read_choice(option, value, {"normals", "displaced"}) == 1;
    water.geometry = displaced ? WaterGeometry::kDisplaced : WaterGeometry::kNormals;
  } else if (const SurfaceNumber* number = find_surface_number(key)) {
    const double v =
        number->whole
            ? static_cast<double>(read_integer(option, value, std::int64_t(number->low), std::int64_t(number->high)))
            : read_number(option, value, number->low, number->high);
    water.surface_changes.push_back([number, v](SurfaceSettings& s) { set_surface_number(s, *number, v); });
  } else if (const SurfaceChoice* choice = find_surface_choice(key)) {
    const std::size_t v = read_choice(option, value, Names(choice->values.begin(), choice->values.end()));
    water.surface_changes.push_back([choice, v](SurfaceSettings& s) { set_surface_choice(s, *choice, v); });
  } else {
    return false;
  }
  return true;
}

[[noreturn]] void unknown_key(const std::string& key, const MethodInfo* method) {
  Names keys_of_water = kWaterKeys;
  for (const SurfaceNumber& key_of_surface : surface_numbers()) keys_of_water.emplace_back(key_of_surface.name);
  for (const SurfaceChoice& key_of_surface : surface_choices()) keys_of_water.emplace_back(key_of_surface.name);
  std::string known = "a water key (" + join(keys_of_water) + ")";
  if (method) {
    Names keys;
    for (const auto& option : method->options) keys.push_back(option.key);
    known += fmt::format(" or an option of {} ({})", method->name, keys.empty() ? "it has none" : join(keys));
  }
  throw UsageError(fmt::format("--set '{}': unknown key; expected {}", key, known));
}

// METHOD.KEY: another method's option is checked and has no effect here.
void set_method_key(Options& options, const std::string& key, const std::string& value) {
  const std::size_t dot = key.find('.');
  const std::string method_name = key.substr(0, dot), method_key = key.substr(dot + 1);
  const MethodInfo* method = find_method(method_name);
  if (!method) read_choice("--set " + key + ", method", method_name, method_names());
  if (!has_option(*method, method_key)) unknown_key(key, method);
  if (method_name == options.frame.method) options.frame.method_options[method_key] = value;
}

struct KeyValue {
  std::string key, value;
};

KeyValue read_key_value(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw UsageError(fmt::format("--set '{}': not understood; expected KEY=VALUE", text));
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

void read_sets(const RawOptions& raw, Options& options) {
  const MethodInfo* method = find_method(options.frame.method);
  for (const std::string& text : raw.set) {
    const KeyValue kv = read_key_value(text);
    if (kv.key.find('.') != std::string::npos) {
      set_method_key(options, kv.key, kv.value);
    } else if (method && has_option(*method, kv.key)) {
      options.frame.method_options[kv.key] = kv.value;
    } else if (!set_water_key(options.scene.water, kv.key, kv.value)) {
      unknown_key(kv.key, method);
    }
  }
}

// --- Single options -------------------------------------------------------------------------------------------------

void read_background(const std::string& text, SceneOptions& scene) {
  if (text == "environment") {
    scene.background = BackgroundChoice::kEnvironment;
  } else if (has_ending(text, ".hdr") || has_ending(text, ".exr")) {
    throw UsageError(fmt::format("--background '{}': is a file; expected --environment {}", text, text));
  } else {
    scene.background = BackgroundChoice::kColor;
    scene.background_color = read_triple("--background", text, 0.0, kMaxRadiance);
  }
}

// The part of --aov's names that is there.
std::vector<Aov> read_aovs(const std::string& text) {
  Names names;
  for (const AovInfo& info : aov_infos()) names.emplace_back(info.name);
  std::uint32_t asked = 0;
  for (const std::string& name : split(text, ',')) {
    asked |= 1u << static_cast<int>(aov_infos()[read_choice("--aov", name, names)].aov);
  }
  std::vector<Aov> aovs;
  for (const AovInfo& info : aov_infos()) {
    if (asked & (1u << static_cast<int>(info.aov))) aovs.push_back(info.aov);
  }
  return aovs;
}

int read_tile(const std::string& text) {
  const std::int64_t tile = read_integer("--tile", text, 16, 256);
  if ((tile & (tile - 1)) != 0) {
    throw UsageError(fmt::format("--tile '{}': not a power of two; expected 16, 32, 64, 128 or 256", text));
  }
  return static_cast<int>(tile);
}

int read_shadow_map(const std::string& text) {
  const std::int64_t size = read_integer("--shadow-map", text, 256, 8192);
  if ((size & (size - 1)) != 0) {
    throw UsageError(
        fmt::format("--shadow-map '{}': not a power of two; expected 256, 512, 1024, 2048, 4096 or 8192", text));
  }
  return static_cast<int>(size);
}

Isa read_isa(const std::string& text) {
  Names runs;
  const std::optional<Isa> asked = parse_isa(text);
  for (const Isa isa : supported_isas()) {
    if (asked == isa) return isa;
    runs.emplace_back(isa_name(isa));
  }
  if (asked) {
    const char* why = is_built(*asked) ? "this machine cannot run it" : "this build does not have it";
    throw UsageError(fmt::format("--isa '{}': {}; expected one of: {}", text, why, join(runs)));
  }
  unknown("--isa", text, runs);
}

int read_count(const char* option, const std::string& text, int low, int high) {
  return static_cast<int>(read_integer(option, text, low, high));
}

void read_frame_settings(const RawOptions& raw, FrameSettings& frame) {
  if (raw.method) frame.method = *raw.method;
  read_choice("--method", frame.method, method_names());
  if (raw.size) {
    const SizePx size = read_size("--size", *raw.size);
    frame.width_px = size.width;
    frame.height_px = size.height;
  }
  if (raw.spp) frame.spp = read_count("--spp", *raw.spp, 1, kMaxSpp);
  if (raw.threads) frame.threads = read_count("--threads", *raw.threads, 1, kMaxThreads);
  if (raw.tile) frame.tile_px = read_tile(*raw.tile);
  frame.isa = raw.isa ? read_isa(*raw.isa) : best_isa();
  if (raw.anisotropy) frame.anisotropy = read_count("--anisotropy", *raw.anisotropy, 1, 16);
  if (raw.shadows) {
    frame.shadows = static_cast<Shadows>(read_choice("--shadows", *raw.shadows, {"off", "map", "rays"}));
  }
  if (raw.shadow_map) frame.shadow_map_px = read_shadow_map(*raw.shadow_map);
  if (raw.reflections && *raw.reflections == "scene")
    throw UsageError(
        "--reflections 'scene': is now planar (a rasterized layer) or traced (rays); expected one of them");
  if (raw.reflections)
    frame.reflections =
        static_cast<Reflections>(read_choice("--reflections", *raw.reflections, {"environment", "planar", "traced"}));
  if (raw.exposure)
    frame.exposure_stops = read_float("--exposure", *raw.exposure, -kMaxExposureStops, kMaxExposureStops);
  if (raw.tonemap) {
    frame.tone_map = read_choice("--tonemap", *raw.tonemap, {"none", "aces"}) == 0 ? ToneMap::kNone : ToneMap::kAces;
  }
}

void read_run(const RawOptions& raw, Options& options) {
  if (raw.time) options.time_s = read_number("--time", *raw.time, -kMaxTime_s, kMaxTime_s);
  if (raw.step) options.step_s = read_number("--step", *raw.step, -kMaxTime_s, kMaxTime_s);
  if (raw.frames) options.frames = read_frames("--frames", *raw.frames);
  if (raw.warmup) options.warmup = read_count("--warmup", *raw.warmup, 0, kMaxRuns);
  if (raw.repeat) options.repeat = read_count("--repeat", *raw.repeat, 1, kMaxRuns);
  if (options.frames && options.repeat > 1) {
    throw UsageError(
        "--frames and --repeat exclude each other: one writes a run of frames, the other times the first one;"
        " expected one of them");
  }
}

void read_outputs(const RawOptions& raw, Options& options) {
  options.output = raw.output;
  options.json = raw.json;
  options.digest = raw.digest;
  options.quiet = raw.quiet;
  if (raw.aov) options.aovs = read_aovs(*raw.aov);
  for (const Aov aov : options.aovs) options.frame.aovs |= 1u << static_cast<int>(aov);
  if (!options.output) return;
  const bool png = has_ending(*options.output, ".png");
  if (!png && !has_ending(*options.output, ".exr")) {
    throw UsageError(fmt::format("-o '{}': not a picture's name; expected FILE.png or FILE.exr", *options.output));
  }
  if (png && raw.aov) {
    throw UsageError(fmt::format("--aov '{}': a PNG has no layers; expected -o FILE.exr", *raw.aov));
  }
  if (options.frames) NamePattern("-o", *options.output);
  if (options.json && *options.json == *options.output) {
    throw UsageError(fmt::format("--json '{}': the picture has that name; expected another", *options.json));
  }
}

void read_scene(const RawOptions& raw, SceneOptions& scene) {
  scene.name = raw.scene;
  if (raw.triangles) {
    scene.triangles = static_cast<std::uint64_t>(read_integer("--triangles", *raw.triangles, 1, kMaxTriangles));
  }
  if (raw.background) read_background(*raw.background, scene);
  if (raw.environment && raw.environment->empty())
    throw UsageError("--environment '': not a file's name; expected a picture");
  scene.environment = raw.environment;
}

void read_cache(const RawOptions& raw, SceneOptions& scene) {
  if (raw.cache && raw.no_cache) throw UsageError("--cache, --no-cache: exclude each other; expected one of them");
  if (raw.cache && raw.cache->empty()) throw UsageError("--cache '': not a folder's name; expected one");
  if (!raw.no_cache) scene.cache = raw.cache ? *raw.cache : default_cache_folder();
}

}  // namespace

bool WaterOverrides::any() const {
  return size_m || depth_m || ior || absorption_per_m || surface || !surface_changes.empty() || geometry;
}

Options read_options(const RawOptions& raw) {
  if (raw.methods) throw UsageError("--methods: belongs to shoal compare; expected --method NAME");
  if (raw.reference) throw UsageError("--reference: belongs to shoal compare; expected --method NAME");
  Options options;
  read_frame_settings(raw, options.frame);
  read_run(raw, options);
  read_scene(raw, options.scene);
  read_cache(raw, options.scene);
  options.scene.draws = true;
  options.scene.threads = options.frame.threads;
  read_sets(raw, options);
  options.camera = raw.camera;
  read_outputs(raw, options);
  return options;
}

SceneOptions read_scene_options(const RawOptions& raw) {
  SceneOptions scene;
  read_scene(raw, scene);
  for (const std::string& text : raw.set) {
    const KeyValue kv = read_key_value(text);
    if (!set_water_key(scene.water, kv.key, kv.value)) unknown_key(kv.key, nullptr);
  }
  return scene;
}

const char* geometry_name(WaterGeometry geometry) {
  return geometry == WaterGeometry::kNormals ? "normals" : "displaced";
}

const char* shadows_name(Shadows shadows) {
  return shadows == Shadows::kOff ? "off" : shadows == Shadows::kMap ? "map" : "rays";
}
Reflections reflections_of(const FrameSettings& frame) {
  const MethodInfo* method = find_method(frame.method);
  return frame.reflections.value_or(method ? method->reflections : Reflections::kTraced);
}
const char* reflections_name(Reflections reflections) {
  return reflections == Reflections::kEnvironment ? "environment"
         : reflections == Reflections::kPlanar    ? "planar"
                                                  : "traced";
}
const char* tone_map_name(ToneMap tone_map) { return tone_map == ToneMap::kNone ? "none" : "aces"; }

}  // namespace shoal::app
