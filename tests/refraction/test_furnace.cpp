// The furnace: in a white room with a white sky and clear water every pixel is white, whatever the method, the camera
// and the waves: reflected and transmitted light add up to one, and a ray that is cut short sees the sky.
#include <catch2/catch.hpp>

#include <algorithm>
#include <string>

#include "core/isa.h"
#include "refraction/renderer.h"
#include "scene/scene.h"

using namespace shoal;

namespace {

RenderScene make_furnace_scene() {
  for (const ProceduralScene& s : procedural_scenes())
    if (std::string(s.name) == "furnace") return build_render_scene(s.make(1000));
  throw std::runtime_error("no furnace");
}

struct Darkest {
  int value = 255;
  std::uint64_t water_pixels = 0;
};
Darkest render_darkest(const RenderScene& scene, const PlacedCamera& camera, const std::string& method,
                       Reflections reflections) {
  FrameSettings settings;
  settings.method = method;
  settings.width_px = 112, settings.height_px = 72;
  settings.threads = 2;
  settings.isa = supported_isas().front();
  settings.reflections = reflections;
  Renderer renderer(scene, settings);
  Frame frame;
  renderer.render(camera.camera, 0.7, frame);
  return {*std::min_element(frame.srgb8.begin(), frame.srgb8.end()), frame.water_pixels};
}

}  // namespace

TEST_CASE("furnace: all is white", "[furnace]") {
  RenderScene scene = make_furnace_scene();
  for (const SurfaceKind kind : {SurfaceKind::kFlat, SurfaceKind::kGradientWaves, SurfaceKind::kPerlin}) {
    scene.waters[0].surface.kind = kind;
    if (kind != SurfaceKind::kFlat) scene.waters[0].surface.slope = 0.15f;
    for (const MethodInfo& method : method_infos()) {
      for (const PlacedCamera& camera : scene.cameras) {
        for (const Reflections reflections : {Reflections::kEnvironment, Reflections::kTraced}) {
          INFO(method.name << ", camera " << camera.name << ", surface " << static_cast<int>(kind) << ", reflections "
                           << static_cast<int>(reflections));
          const Darkest darkest = render_darkest(scene, camera, method.name, reflections);
          CHECK(darkest.value == 255);
          CHECK(darkest.water_pixels > 1500);
        }
      }
    }
  }
}

TEST_CASE("furnace: water that absorbs is seen", "[furnace]") {
  RenderScene scene = make_furnace_scene();
  scene.waters[0].absorption_per_m = {0.05f, 0.05f, 0.05f};
  for (const MethodInfo& method : method_infos())
    for (const PlacedCamera& camera : scene.cameras) {
      INFO(method.name << ", camera " << camera.name);
      CHECK(render_darkest(scene, camera, method.name, Reflections::kTraced).value < 250);
    }
}
