// Stage digests of the files of data/assets/: what only a file can hold. The views are those of
// tests/goldens/assets.list.
//
//   asset_digest_tool [--isa NAME,...] [--threads N,...] [--tile N,...] [--out FOLDER]
//   asset_digest_tool --list-isas
//
// Configurations as in digest_tool; a file is read once for all of them. A line: file camera time method stage digest.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "refraction/renderer.h"
#include "scene/gltf/gltf.h"
#include "scene/scene.h"
#include "tests/invariance/configurations.h"

namespace {

struct View {
  std::string asset, camera;
  double time_s = 0;
};

std::vector<View> read_views(const std::string& path) {
  std::ifstream file(path);
  std::vector<View> views;
  for (View view; file >> view.asset >> view.camera >> view.time_s;) views.push_back(view);
  if (views.empty()) throw shoal::Error(path + ": holds no view; expected lines of FILE CAMERA TIME");
  return views;
}

// The reference draws materials, motion and water once each.
std::vector<std::string> methods_of(const View& view) {
  const std::string name = view.asset + " " + view.camera;
  if (name == "materials front" || name == "motion rider" || name == "water above") return {"hybrid", "ray-traced"};
  return {"hybrid"};
}

const shoal::Camera& find_camera(const shoal::RenderScene& scene, const View& view) {
  const auto found = std::find_if(scene.cameras.begin(), scene.cameras.end(),
                                  [&](const shoal::PlacedCamera& camera) { return camera.name == view.camera; });
  if (found == scene.cameras.end()) throw shoal::Error(view.asset + ": no camera '" + view.camera + "'");
  return found->camera;
}

void run(const std::vector<View>& views, const std::map<std::string, shoal::RenderScene>& scenes,
         shoal::FrameSettings settings, std::FILE* out) {
  for (const View& view : views) {
    const shoal::RenderScene& scene = scenes.at(view.asset);
    for (const std::string& method : methods_of(view)) {
      settings.method = method;
      shoal::Frame frame;
      shoal::Renderer(scene, settings).render(find_camera(scene, view), view.time_s, frame);
      std::ostringstream prefix;
      prefix << view.asset << ' ' << view.camera << ' ' << view.time_s << ' ' << method;
      invariance::print_digests(out, prefix.str(), frame);
    }
  }
}

}  // namespace

int main(int count, char** texts) {
  try {
    invariance::Configurations configurations;
    for (int i = 1; i < count; ++i) {
      const std::string_view option = texts[i];
      if (option == "--list-isas") {
        invariance::print_isas();
        return 0;
      }
      if (i + 1 == count) throw shoal::UsageError(std::string(option) + ": expected a value");
      if (!invariance::parse_configurations(option, texts[++i], configurations)) {
        throw shoal::UsageError("unknown option " + std::string(option));
      }
    }
    shoal::FrameSettings settings;
    settings.width_px = 160;
    settings.height_px = 90;
    settings.shadow_map_px = 512;
    settings.digests = true;
    const std::string root = SHOAL_SOURCE_DIR;
    const std::vector<View> views = read_views(root + "/tests/goldens/assets.list");
    std::map<std::string, shoal::RenderScene> scenes;
    for (const View& view : views) {
      if (scenes.contains(view.asset)) continue;
      const shoal::Scene scene = shoal::load_gltf(root + "/data/assets/" + view.asset + ".glb");
      scenes.emplace(view.asset, shoal::build_render_scene(scene));
    }
    invariance::for_each_configuration(
        configurations, settings,
        [&](const shoal::FrameSettings& configured, std::FILE* out) { run(views, scenes, configured, out); });
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "asset_digest_tool: error: %s\n", error.what());
    return 1;
  }
}
