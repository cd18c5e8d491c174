// Stage digests of the built-in scenes, from the renderer alone: no file, no library, so that it runs wherever a kernel
// does, under an emulator too. tests/invariance/matrix.sh compares what it prints.
//
//   digest_tool [--scene NAME] [--triangles N] [--camera INDEX] [--method NAME] [--size WxH] [--spp N] [--time S]
//               [--isa NAME] [--threads N] [--tile N]
//   digest_tool --list-isas
//
// Without --scene, --camera or --method: `pool`, `box` and `pond` by all of them, but for methods other than the
// default `box` alone and the first camera of `pond`, whose water moves and has a shore; shadows by rays on `pool`; the
// reference on displaced water and on `tank`. A line: scene camera method stage digest.
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/digest.h"
#include "core/error.h"
#include "core/isa.h"
#include "refraction/renderer.h"
#include "scene/scene.h"

namespace {

struct Arguments {
  std::vector<std::string> scenes{"pool", "box", "pond"};
  std::uint64_t triangles = 2000;
  std::optional<std::size_t> camera;
  std::vector<std::string> methods;
  double time_s = 0.25;
  bool list_isas = false, sized = false;
  shoal::FrameSettings settings;
};

template <class Number>
Number parse_number(std::string_view option, std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) {
    throw shoal::UsageError(std::string(option) + ": '" + std::string(text) + "' is no number");
  }
  return value;
}

void parse_size(std::string_view text, shoal::FrameSettings& settings) {
  const std::size_t x = text.find('x');
  if (x == std::string_view::npos) throw shoal::UsageError("--size: expected WxH");
  settings.width_px = parse_number<int>("--size", text.substr(0, x));
  settings.height_px = parse_number<int>("--size", text.substr(x + 1));
}

void parse_option(std::string_view option, std::string_view value, Arguments& arguments) {
  shoal::FrameSettings& settings = arguments.settings;
  if (option == "--scene") {
    arguments.scenes = {std::string(value)};
  } else if (option == "--triangles") {
    arguments.triangles = parse_number<std::uint64_t>(option, value);
  } else if (option == "--camera") {
    arguments.camera = parse_number<std::size_t>(option, value);
  } else if (option == "--method") {
    arguments.methods = {std::string(value)};
  } else if (option == "--size") {
    parse_size(value, settings);
    arguments.sized = true;
  } else if (option == "--spp") {
    settings.spp = parse_number<int>(option, value);
  } else if (option == "--time") {
    arguments.time_s = parse_number<double>(option, value);
  } else if (option == "--threads") {
    settings.threads = parse_number<int>(option, value);
  } else if (option == "--tile") {
    settings.tile_px = parse_number<int>(option, value);
  } else if (option == "--isa") {
    const auto isa = shoal::parse_isa(value);
    if (!isa) throw shoal::UsageError("--isa: no instruction set '" + std::string(value) + "'");
    settings.isa = *isa;
  } else {
    throw shoal::UsageError("unknown option " + std::string(option));
  }
}

Arguments parse_arguments(int count, char** texts) {
  Arguments arguments;
  arguments.settings.shadow_map_px = 512;  // enough to show a difference, and quick where nothing is
  arguments.settings.width_px = 240;
  arguments.settings.height_px = 135;
  arguments.settings.isa = shoal::best_isa();
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

void print_frame(const std::string& prefix, const shoal::Frame& frame) {
  for (const auto& [stage, hex] : frame.digests) std::printf("%s %s %s\n", prefix.c_str(), stage.c_str(), hex.c_str());
  for (const shoal::AovImage& image : frame.aovs) {
    shoal::Digest digest;
    digest.add(image.floats.data(), image.floats.size() * sizeof(float));
    digest.add(image.uints.data(), image.uints.size() * sizeof(std::uint32_t));
    std::printf("%s aov.%s %s\n", prefix.c_str(), aov_name(image.aov), digest.hex().c_str());
  }
  std::printf("%s picture %s\n", prefix.c_str(), shoal::picture_digest(frame).c_str());
}

// One small frame by a scene's first camera.
void run_one(const Arguments& arguments, const std::string& name, const shoal::RenderScene& scene,
             const std::string& method, shoal::Shadows shadows) {
  shoal::FrameSettings settings = arguments.settings;
  settings.method = method;
  settings.shadows = shadows;
  if (!arguments.sized) settings.width_px = 144, settings.height_px = 80;
  shoal::Frame frame;
  shoal::Renderer(scene, settings).render(scene.cameras.front().camera, arguments.time_s, frame);
  print_frame(name + " " + method, frame);
}

// What the loop over scenes and methods leaves out: rays for shadows, and the reference on displaced water and `tank`.
void run_rays(const Arguments& arguments) {
  const auto built = [&](const char* name) {
    return shoal::build_render_scene(find_scene(name).make(arguments.triangles));
  };
  const shoal::RenderScene pool = built("pool");
  for (const char* method : {"two-phase", "ray-traced"})
    run_one(arguments, "pool shadow-rays", pool, method, shoal::Shadows::kRays);
  shoal::RenderScene pond = built("pond");
  for (shoal::WaterBody& body : pond.waters) body.surface.geometry = shoal::WaterGeometry::kDisplaced;
  run_one(arguments, "pond displaced", pond, "ray-traced", shoal::Shadows::kMap);
  run_one(arguments, "tank first", built("tank"), "ray-traced", shoal::Shadows::kMap);
}

void run(const Arguments& arguments) {
  for (const std::string& scene_name : arguments.scenes) {
    const shoal::RenderScene scene = shoal::build_render_scene(find_scene(scene_name).make(arguments.triangles));
    for (const std::string& method : arguments.methods) {
      // All methods on the small scene, and a look at water that moves; the others show the default one what they hold.
      const bool all_cameras =
          arguments.methods.size() == 1 || scene_name == "box" || method == arguments.methods.front();
      if (!all_cameras && scene_name != "pond") continue;
      shoal::FrameSettings settings = arguments.settings;
      settings.method = method;
      if (scene_name == "pond" && !arguments.sized) settings.width_px = 144, settings.height_px = 80;
      // As much as a picture this small shows, and quick to build where nothing is optimized.
      if (method == "distance-field") settings.method_options["resolution"] = "32";
      std::unique_ptr<shoal::Renderer> made;
      try {
        made = std::make_unique<shoal::Renderer>(scene, settings);
      } catch (const shoal::NotApplicable&) {
        std::printf("%s %s: not applicable\n", scene_name.c_str(), method.c_str());
        continue;
      }
      shoal::Renderer& renderer = *made;
      for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
        if (arguments.camera ? *arguments.camera != i : i > 0 && !all_cameras) continue;
        shoal::Frame frame;
        renderer.render(scene.cameras[i].camera, arguments.time_s, frame);
        print_frame(scene_name + " " + scene.cameras[i].name + " " + method, frame);
      }
    }
  }
}

}  // namespace

int main(int count, char** texts) {
  try {
    const Arguments arguments = parse_arguments(count, texts);
    if (arguments.list_isas) {
      for (const shoal::Isa isa : shoal::supported_isas()) std::printf("%s\n", shoal::isa_name(isa));
      return 0;
    }
    run(arguments);
    if (arguments.scenes.size() > 1 && arguments.methods.size() > 1) run_rays(arguments);
    return 0;
  } catch (const shoal::UsageError& error) {
    std::fprintf(stderr, "digest_tool: error: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "digest_tool: error: %s\n", error.what());
    return 1;
  }
}
