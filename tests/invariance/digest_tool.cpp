// Stage digests of the built-in scenes, from the renderer alone: no file, no library, so that it runs wherever a kernel
// does, under an emulator too. tests/invariance/matrix.sh compares what it prints.
//
//   digest_tool [--scene NAME] [--triangles N] [--camera INDEX] [--method NAME] [--size WxH] [--spp N] [--time S]
//               [--isa NAME,...] [--threads N,...] [--tile N,...] [--out FOLDER]
//   digest_tool --list-isas
//
// Every combination of --isa, --threads and --tile is a configuration; several need --out (configurations.h). A scene
// is made once for all of them.
//
// Without --scene, --camera or --method: `pool`, `box` and `pond` by all of them, but for methods other than the
// default `box` alone and the first camera of `pond`, whose water moves and has a shore; shadows by rays on `pool`; the
// reference on displaced water and on `tank`. A line: scene camera method stage digest.
#include <cstdint>
#include <cstdio>
#include <exception>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/digest.h"
#include "core/error.h"
#include "refraction/renderer.h"
#include "scene/scene.h"
#include "tests/invariance/configurations.h"

namespace {

struct Arguments {
  std::vector<std::string> scenes{"pool", "box", "pond"};
  std::uint64_t triangles = 2000;
  std::optional<std::size_t> camera;
  std::vector<std::string> methods;
  double time_s = 0.25;
  bool list_isas = false, sized = false;
  shoal::FrameSettings settings;
  invariance::Configurations configurations;
};

void parse_size(std::string_view text, shoal::FrameSettings& settings) {
  const std::size_t x = text.find('x');
  if (x == std::string_view::npos) throw shoal::UsageError("--size: expected WxH");
  settings.width_px = invariance::parse_number<int>("--size", text.substr(0, x));
  settings.height_px = invariance::parse_number<int>("--size", text.substr(x + 1));
}

void parse_option(std::string_view option, std::string_view value, Arguments& arguments) {
  shoal::FrameSettings& settings = arguments.settings;
  if (option == "--scene") {
    arguments.scenes = {std::string(value)};
  } else if (option == "--triangles") {
    arguments.triangles = invariance::parse_number<std::uint64_t>(option, value);
  } else if (option == "--camera") {
    arguments.camera = invariance::parse_number<std::size_t>(option, value);
  } else if (option == "--method") {
    arguments.methods = {std::string(value)};
  } else if (option == "--size") {
    parse_size(value, settings);
    arguments.sized = true;
  } else if (option == "--spp") {
    settings.spp = invariance::parse_number<int>(option, value);
  } else if (option == "--time") {
    arguments.time_s = invariance::parse_number<double>(option, value);
  } else if (!invariance::parse_configurations(option, value, arguments.configurations)) {
    throw shoal::UsageError("unknown option " + std::string(option));
  }
}

Arguments parse_arguments(int count, char** texts) {
  Arguments arguments;
  arguments.settings.shadow_map_px = 512;  // enough to show a difference, and quick where nothing is
  arguments.settings.width_px = 240;
  arguments.settings.height_px = 135;
  arguments.settings.digests = true;
  arguments.settings.aovs = (1u << static_cast<unsigned>(shoal::Aov::kCount)) - 1u;
  for (const shoal::MethodInfo& method : shoal::method_infos()) arguments.methods.emplace_back(method.name);
  for (int i = 1; i < count; ++i) {
    const std::string_view option = texts[i];
    if (option == "--list-isas") {
      arguments.list_isas = true;
    } else if (i + 1 == count) {
      throw shoal::UsageError(std::string(option) + ": expected a value");
    } else {
      parse_option(option, texts[++i], arguments);
    }
  }
  return arguments;
}

const shoal::ProceduralScene& find_scene(std::string_view name) {
  for (const shoal::ProceduralScene& scene : shoal::procedural_scenes()) {
    if (scene.name == name) return scene;
  }
  throw shoal::UsageError("no built-in scene '" + std::string(name) + "'");
}

const char* aov_name(shoal::Aov aov) {
  for (const shoal::AovInfo& info : shoal::aov_infos()) {
    if (info.aov == aov) return info.name;
  }
  return "?";
}

void print_frame(std::FILE* out, const std::string& prefix, const shoal::Frame& frame) {
  for (const shoal::AovImage& image : frame.aovs) {
    shoal::Digest digest;
    digest.add(image.floats.data(), image.floats.size() * sizeof(float));
    digest.add(image.uints.data(), image.uints.size() * sizeof(std::uint32_t));
    std::fprintf(out, "%s aov.%s %s\n", prefix.c_str(), aov_name(image.aov), digest.hex().c_str());
  }
  invariance::print_digests(out, prefix, frame);
}

// Built-in scenes, each made when it is first asked for.
class Scenes {
 public:
  explicit Scenes(std::uint64_t triangles) : triangles_(triangles) {}

  const shoal::RenderScene& get(const std::string& name) {
    const auto known = made_.find(name);
    if (known != made_.end()) return known->second;
    return made_.emplace(name, shoal::build_render_scene(find_scene(name).make(triangles_))).first->second;
  }

 private:
  std::uint64_t triangles_;
  std::map<std::string, shoal::RenderScene> made_;
};

struct Job {
  const Arguments& arguments;
  const shoal::FrameSettings& settings;
  std::FILE* out;
};

// One small frame by a scene's first camera.
void run_one(const Job& job, const std::string& name, const shoal::RenderScene& scene, const std::string& method,
             shoal::Shadows shadows) {
  shoal::FrameSettings settings = job.settings;
  settings.method = method;
  settings.shadows = shadows;
  if (!job.arguments.sized) settings.width_px = 144, settings.height_px = 80;
  shoal::Frame frame;
  shoal::Renderer(scene, settings).render(scene.cameras.front().camera, job.arguments.time_s, frame);
  print_frame(job.out, name + " " + method, frame);
}

// What the loop over scenes and methods leaves out: rays for shadows, and the reference on displaced water and `tank`.
void run_rays(const Job& job, Scenes& scenes) {
  for (const char* method : {"hybrid", "ray-traced"})
    run_one(job, "pool shadow-rays", scenes.get("pool"), method, shoal::Shadows::kRays);
  shoal::RenderScene pond = scenes.get("pond");
  for (shoal::WaterBody& body : pond.waters) body.surface.geometry = shoal::WaterGeometry::kDisplaced;
  run_one(job, "pond displaced", pond, "ray-traced", shoal::Shadows::kMap);
  run_one(job, "tank first", scenes.get("tank"), "ray-traced", shoal::Shadows::kMap);
}

void run(const Job& job, Scenes& scenes) {
  const Arguments& arguments = job.arguments;
  for (const std::string& scene_name : arguments.scenes) {
    const shoal::RenderScene& scene = scenes.get(scene_name);
    for (const std::string& method : arguments.methods) {
      // All methods on the small scene, and a look at water that moves; the others show the default one what they hold.
      const bool all_cameras =
          arguments.methods.size() == 1 || scene_name == "box" || method == arguments.methods.front();
      if (!all_cameras && scene_name != "pond") continue;
      shoal::FrameSettings settings = job.settings;
      settings.method = method;
      if (scene_name == "pond" && !arguments.sized) settings.width_px = 144, settings.height_px = 80;
      // As much as a picture this small shows, and quick to build where nothing is optimized.
      if (method == "distance-field") settings.method_options["resolution"] = "32";
      std::unique_ptr<shoal::Renderer> made;
      try {
        made = std::make_unique<shoal::Renderer>(scene, settings);
      } catch (const shoal::NotApplicable&) {
        std::fprintf(job.out, "%s %s: not applicable\n", scene_name.c_str(), method.c_str());
        continue;
      }
      shoal::Renderer& renderer = *made;
      for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
        if (arguments.camera ? *arguments.camera != i : i > 0 && !all_cameras) continue;
        shoal::Frame frame;
        renderer.render(scene.cameras[i].camera, arguments.time_s, frame);
        print_frame(job.out, scene_name + " " + scene.cameras[i].name + " " + method, frame);
      }
    }
  }
  if (arguments.scenes.size() > 1 && arguments.methods.size() > 1) run_rays(job, scenes);
}

}  // namespace

int main(int count, char** texts) {
  try {
    const Arguments arguments = parse_arguments(count, texts);
    if (arguments.list_isas) {
      invariance::print_isas();
      return 0;
    }
    Scenes scenes(arguments.triangles);
    const auto draw = [&](const shoal::FrameSettings& settings, std::FILE* out) {
      run({arguments, settings, out}, scenes);
    };
    invariance::for_each_configuration(arguments.configurations, arguments.settings, draw);
    return 0;
  } catch (const shoal::UsageError& error) {
    std::fprintf(stderr, "digest_tool: error: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "digest_tool: error: %s\n", error.what());
    return 1;
  }
}
