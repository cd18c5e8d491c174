#include "app/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "app/messages.h"
#include "core/error.h"
#include "core/thread_pool.h"
#include "scene/gltf/gltf.h"
#include "scene/images/environment.h"
#include "water/surface_keys.h"

namespace shoal::app {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

const ProceduralScene* find_built_in(const std::string& name) {
  for (const ProceduralScene& scene : procedural_scenes()) {
    if (name == scene.name) return &scene;
  }
  return nullptr;
}

std::vector<std::string> built_in_names() {
  std::vector<std::string> names;
  for (const ProceduralScene& scene : procedural_scenes()) names.emplace_back(scene.name);
  return names;
}

// Built-in scenes have a least and a greatest number of triangles, which only they know.
void check_triangles(const Scene& scene, const std::string& name, std::uint64_t asked) {
  const std::uint64_t made = count_triangles(scene);
  const std::uint64_t off = made > asked ? made - asked : asked - made;
  if (off * 10 > asked) {
    throw UsageError(fmt::format("--triangles '{}': {} cannot have so {}; expected {} or {}", asked, name,
                                 made > asked ? "few" : "many", made, made > asked ? "more" : "fewer"));
  }
}

void override_water(const WaterOverrides& overrides, WaterSpec& water) {
  if (overrides.size_m) {
    water.has_size = true;
    water.size_x = overrides.size_m->x;
    water.size_z = overrides.size_m->y;
  }
  if (overrides.depth_m) {
    water.has_depth = true;
    water.depth = *overrides.depth_m;
  }
  if (overrides.ior) water.ior = *overrides.ior;
  if (overrides.absorption_per_m) water.absorption = *overrides.absorption_per_m;
  if (overrides.surface) set_surface_kinds(water.surface, *overrides.surface);
  for (const auto& change : overrides.surface_changes) change(water.surface);
  if (overrides.geometry) water.surface.geometry = *overrides.geometry;
}

void override_background(const SceneOptions& options, Scene& scene) {
  if (options.background == BackgroundChoice::kColor) {
    scene.has_background = true;
    scene.background = Background{};
    scene.background.kind = Background::Kind::kColor;
    scene.background.color = options.background_color;
  } else if (options.background == BackgroundChoice::kEnvironment &&
             scene.background.kind == Background::Kind::kColor) {
    scene.has_background = false;  // a plain colour is no environment: the default sky
  }
}

// The picture that surrounds the scene becomes its background, unless a colour is asked for: then nothing sees it.
void surround(const SceneOptions& options, bool quiet, LoadedScene& loaded) {
  const std::string& file = options.environment ? *options.environment : loaded.scene.environment_file;
  if (!options.draws || options.background == BackgroundChoice::kColor || file.empty()) return;
  constexpr int kMostThreads = 256;
  ThreadPool pool(std::min(options.threads > 0 ? options.threads : available_threads(), kMostThreads));
  std::string warning;
  Scene& scene = loaded.scene;
  scene.has_background = true;
  scene.background = Background{};
  try {
    scene.background.environment = load_environment(file, options.cache, pool, warning);
  } catch (const Error& e) {
    if (options.environment) throw;
    throw Error(fmt::format("{}: its environment {}", options.name, e.what()));
  }
  scene.background.kind = Background::Kind::kEnvironment;
  loaded.environment_file = file;
  if (!quiet && !warning.empty()) warn(file, warning);
}

}  // namespace

void warn(const std::string& file, const std::string& what) {
  std::fputs(one_line(fmt::format("shoal: warning: {}: {}", file, what)).c_str(), stderr);
}

std::uint64_t count_triangles(const Scene& scene) {
  std::uint64_t count = 0;
  for (const Node& node : scene.nodes) {
    if (node.mesh == kNoIndex) continue;
    for (const MeshPrimitive& p : scene.meshes[static_cast<std::size_t>(node.mesh)].primitives)
      count += p.indices.size() / 3;
  }
  return count;
}

Scene read_scene(const std::string& name, std::optional<std::uint64_t> triangles) {
  if (const ProceduralScene* built_in = find_built_in(name)) {
    Scene scene = built_in->make(triangles.value_or(built_in->default_triangles));
    if (triangles) check_triangles(scene, name, *triangles);
    return scene;
  }
  if (!has_ending(name, ".gltf") && !has_ending(name, ".glb")) {
    throw UsageError(
        fmt::format("scene '{}': unknown; expected a .gltf or .glb file, or one of: {}", name, join(built_in_names())));
  }
  if (triangles) throw UsageError(fmt::format("--triangles: {} is a file; expected a built-in scene", name));
  return load_gltf(name);
}

LoadedScene load_scene(const SceneOptions& options, bool quiet) {
  LoadedScene loaded;
  const auto load_begin = Clock::now();
  loaded.scene = read_scene(options.name, options.triangles);
  surround(options, quiet, loaded);
  loaded.load_ms = milliseconds_since(load_begin);

  Scene& scene = loaded.scene;
  if (!quiet) {
    for (const std::string& warning : scene.warnings) warn(options.name, warning);
    if (options.water.any() && scene.waters.empty()) warn(options.name, "--set: the scene has no water to set it for");
  }
  for (WaterSpec& water : scene.waters) override_water(options.water, water);
  override_background(options, scene);

  const auto build_begin = Clock::now();
  loaded.render = build_render_scene(scene);
  loaded.build_ms = milliseconds_since(build_begin);
  Background& background = loaded.render.lighting.background;
  if (options.background == BackgroundChoice::kEnvironment && background.kind == Background::Kind::kColor) {
    background = Background{};  // an unlit scene has a black background of its own: the sky, without a sun
    background.kind = Background::Kind::kSky;
  }
  return loaded;
}

const PlacedCamera& pick_camera(const RenderScene& scene, const std::optional<std::string>& camera) {
  if (!camera) return scene.cameras.front();
  std::vector<std::string> names;
  for (const PlacedCamera& placed : scene.cameras) {
    if (placed.name == *camera) return placed;
    names.push_back(placed.name);
  }
  const auto last = static_cast<std::int64_t>(scene.cameras.size()) - 1;
  constexpr std::string_view kDigits = "0123456789";
  if (!camera->empty() && camera->find_first_not_of(kDigits) == std::string::npos) {
    return scene.cameras[static_cast<std::size_t>(read_integer("--camera", *camera, 0, last))];
  }
  throw UsageError(
      fmt::format("--camera '{}': unknown; expected an index from 0 to {}, or one of: {}", *camera, last, join(names)));
}

}  // namespace shoal::app
