// The options of `shoal render` and `shoal probe`: as typed, and as read (docs/command.md).
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/values.h"
#include "core/vec.h"
#include "refraction/renderer.h"
#include "scene/scene.h"

namespace shoal::app {

// As typed, not yet looked at. Not given: empty optional.
struct RawOptions {
  std::string scene;
  std::optional<std::string> output, json;
  std::optional<std::string> method, methods, reference, size, spp, camera, time, step, frames, warmup, repeat, threads,
      tile, isa, anisotropy, shadows, shadow_map, reflections, exposure, tonemap, background, environment, cache, aov,
      triangles;
  std::vector<std::string> set;  // KEY=VALUE
  bool digest = false, quiet = false, no_cache = false;
};

// Water keys given with --set: they go over every body of the scene.
struct WaterOverrides {
  std::optional<Vec2f> size_m;
  std::optional<float> depth_m, ior;
  std::optional<Vec3f> absorption_per_m;
  std::optional<std::vector<SurfaceKind>> surface;  // one, or several: their sum
  std::vector<std::function<void(SurfaceSettings&)>> surface_changes;
  std::optional<WaterGeometry> geometry;

  bool any() const;
};

enum class BackgroundChoice : std::uint8_t { kScene, kColor, kEnvironment };

// What a scene is made from.
struct SceneOptions {
  std::string name;                        // a file or a built-in scene
  std::optional<std::uint64_t> triangles;  // of a built-in one
  WaterOverrides water;
  BackgroundChoice background = BackgroundChoice::kScene;
  Vec3f background_color{0, 0, 0};         // linear, kColor
  bool draws = false;                      // false: nothing is drawn, so the environment is not read
  std::optional<std::string> environment;  // a picture's file, instead of the scene's
  std::string cache;                       // folder for filtered environments; empty: none
  int threads = 0;                         // as FrameSettings::threads
};

struct Options {
  SceneOptions scene;
  FrameSettings frame;
  std::optional<std::string> camera;
  double time_s = 0, step_s = 1.0 / 60.0;
  std::optional<FrameRange> frames;
  int warmup = 3, repeat = 1;
  std::vector<Aov> aovs;  // in the order of aov_infos()
  std::optional<std::string> output, json;
  bool digest = false, quiet = false;
};

// Throws UsageError for everything that is unknown, out of range or of another command.
Options read_options(const RawOptions& raw);
// Of read_options, what makes the scene: for commands without a frame.
SceneOptions read_scene_options(const RawOptions& raw);

// Names as the options take them.
const char* geometry_name(WaterGeometry geometry);
const char* shadows_name(Shadows shadows);
const char* reflections_name(Reflections reflections);
// Those in force: as given, else by the method's category.
Reflections reflections_of(const FrameSettings& frame);
const char* tone_map_name(ToneMap tone_map);

}  // namespace shoal::app
