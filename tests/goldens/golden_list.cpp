#include "tests/goldens/golden_list.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <sstream>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "refraction/renderer.h"
#include "scene/gltf/gltf.h"
#include "water/surface_keys.h"

namespace goldens {
namespace {

using shoal::Error;

constexpr std::array<std::string_view, 2> kScenes{"box", "pool"};
constexpr std::string_view kAssets = "assets";

const shoal::ProceduralScene* find_built_in(const std::string& name) {
  for (const shoal::ProceduralScene& scene : shoal::procedural_scenes()) {
    if (name == scene.name) return &scene;
  }
  return nullptr;
}

std::vector<std::string> all_methods() {
  std::vector<std::string> names;
  for (const shoal::MethodInfo& method : shoal::method_infos()) names.emplace_back(method.name);
  return names;
}

double parse_number(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw Error("'" + text + "' is not a number; expected one");
  }
  return value;
}

// The words of each line that is not empty.
std::vector<std::vector<std::string>> read_words(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw Error(path + ": cannot be opened; expected a list of goldens");
  std::vector<std::vector<std::string>> lines;
  for (std::string line; std::getline(file, line);) {
    std::istringstream text(line);
    std::vector<std::string> words;
    for (std::string word; text >> word;) words.push_back(word);
    if (!words.empty()) lines.push_back(words);
  }
  return lines;
}

void finish(View& view) {
  view.arguments = view.scene;
  if (find_built_in(view.scene) != nullptr) view.arguments += " --triangles " + std::to_string(kTriangles);
  view.arguments += " --camera " + view.camera;
  std::array<char, 32> time{};
  const auto end = std::to_chars(time.data(), time.data() + time.size(), view.time_s).ptr;
  view.arguments += " --time " + std::string(time.data(), end);
  for (const std::string& water : view.water) view.arguments += " --set " + water;
  if (view.traced_shadows) view.arguments += " --shadows rays";
  view.arguments += " --size " + std::to_string(view.width_px) + "x" + std::to_string(view.height_px);
}

Group scene_group(const std::string& name) {
  Group group{name, {}};
  View view;
  view.scene = name;
  view.methods = all_methods();
  for (const shoal::PlacedCamera& camera : load_scene(view)->cameras) {
    view.camera = camera.name;
    view.name = name + "_" + camera.name;
    finish(view);
    group.views.push_back(view);
  }
  return group;
}

// NAME SCENE [--camera NAME] [--time S] [--set KEY=VALUE]... [--shadows rays]
View water_view(const std::vector<std::string>& words) {
  View view;
  if (words.size() < 2 || words.size() % 2 != 0)
    throw Error("water.list: '" + words[0] + "': expected NAME SCENE and pairs of option and value");
  view.name = words[0];
  view.scene = words[1];
  view.methods = all_methods();
  for (std::size_t i = 2; i < words.size(); i += 2) {
    const std::string &option = words[i], &value = words[i + 1];
    if (option == "--camera") {
      view.camera = value;
    } else if (option == "--time") {
      view.time_s = parse_number(value);
    } else if (option == "--set") {
      view.water.push_back(value);
    } else if (option == "--shadows" && value == "rays") {
      view.traced_shadows = true;
    } else {
      throw Error("water.list: '" + option + "' is not known; expected --camera, --time, --set or --shadows rays");
    }
  }
  finish(view);
  return view;
}

// FILE CAMERA TIME
View asset_view(const std::vector<std::string>& words) {
  View view;
  if (words.size() != 3) throw Error("assets.list: '" + words[0] + "': expected FILE CAMERA TIME");
  view.name = "asset-" + words[0] + "_" + words[1] + "_" + words[2];
  view.name_has_method = false;
  view.scene = "data/assets/" + words[0] + ".glb";
  view.camera = words[1];
  view.time_s = parse_number(words[2]);
  view.width_px = 320, view.height_px = 180;
  view.methods = {shoal::FrameSettings().method};
  finish(view);
  return view;
}

void set_water(const std::string& text, shoal::SurfaceSettings& surface) {
  const std::size_t equals = text.find('=');
  const std::string key = text.substr(0, equals);
  const std::string value = equals == std::string::npos ? "" : text.substr(equals + 1);
  const auto refuse = [&] { throw Error("'" + text + "': expected KEY=VALUE of the water's surface"); };
  if (key == "surface") {
    std::vector<shoal::SurfaceKind> kinds;
    std::istringstream names(value);
    for (std::string name; std::getline(names, name, '+');) {
      const auto& known = shoal::surface_kinds();
      const auto found = std::find_if(known.begin(), known.end(), [&](const auto& kind) { return name == kind.name; });
      if (found == known.end()) refuse();
      kinds.push_back(found->kind);
    }
    if (kinds.empty()) refuse();
    shoal::set_surface_kinds(surface, kinds);
  } else if (key == "geometry") {
    if (value != "normals" && value != "displaced") refuse();
    surface.geometry = value == "displaced" ? shoal::WaterGeometry::kDisplaced : shoal::WaterGeometry::kNormals;
  } else if (const shoal::SurfaceNumber* number = shoal::find_surface_number(key)) {
    shoal::set_surface_number(surface, *number, parse_number(value));
  } else if (const shoal::SurfaceChoice* choice = shoal::find_surface_choice(key)) {
    const auto found = std::find(choice->values.begin(), choice->values.end(), std::string_view(value));
    if (found == choice->values.end()) refuse();
    shoal::set_surface_choice(surface, *choice, static_cast<std::size_t>(found - choice->values.begin()));
  } else {
    refuse();
  }
}

}  // namespace

std::vector<std::string> group_names(const std::string& folder) {
  std::vector<std::string> names{kScenes.begin(), kScenes.end()};
  for (const std::vector<std::string>& words : read_words(folder + "/water.list")) names.push_back(words[0]);
  names.emplace_back(kAssets);
  return names;
}

Group make_group(const std::string& folder, const std::string& name) {
  if (std::find(kScenes.begin(), kScenes.end(), name) != kScenes.end()) return scene_group(name);
  Group group{name, {}};
  for (const std::vector<std::string>& words : read_words(folder + "/water.list")) {
    if (words[0] == name) group.views.push_back(water_view(words));
  }
  for (const std::vector<std::string>& words : read_words(folder + "/assets.list")) {
    if (name == kAssets) group.views.push_back(asset_view(words));
  }
  if (group.views.empty()) throw Error("'" + name + "' is no group of goldens; expected one of golden_tool --groups");
  return group;
}

std::shared_ptr<const shoal::RenderScene> load_scene(const View& view) {
  static std::pair<std::string, std::vector<std::string>> loaded;
  static std::shared_ptr<const shoal::RenderScene> kept;
  if (kept && loaded == std::pair(view.scene, view.water)) return kept;
  const shoal::ProceduralScene* built_in = find_built_in(view.scene);
  shoal::Scene scene = built_in != nullptr ? built_in->make(kTriangles) : shoal::load_gltf(view.scene);
  for (shoal::WaterSpec& water : scene.waters) {
    // The kinds come first: they decide which settings the other keys change.
    for (const bool kinds : {true, false}) {
      for (const std::string& text : view.water) {
        if (text.starts_with("surface=") == kinds) set_water(text, water.surface);
      }
    }
  }
  kept = std::make_shared<const shoal::RenderScene>(shoal::build_render_scene(scene));
  loaded = {view.scene, view.water};
  return kept;
}

}  // namespace goldens
