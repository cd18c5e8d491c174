// A floor that is the scene's lowest side is seen through waves as any other: rays that waves bend end on it, not short
// of it. In the basin of `ball` every ray that enters the water from the camera `high` meets floor, wall or ball.
#include <catch2/catch.hpp>

#include <stdexcept>
#include <string>

#include "core/isa.h"
#include "refraction/renderer.h"
#include "scene/scene.h"

using namespace shoal;

namespace {

RenderScene make_ball_scene() {
  for (const ProceduralScene& s : procedural_scenes())
    if (std::string(s.name) == "ball") return build_render_scene(s.make(2000));
  throw std::runtime_error("no ball");
}

}  // namespace

TEST_CASE("waves: a basin's floor is met everywhere") {
  RenderScene scene = make_ball_scene();
  for (const SurfaceKind kind : {SurfaceKind::kPerlin, SurfaceKind::kGradientWaves}) {
    scene.waters[0].surface.kind = kind;
    scene.waters[0].surface.slope = 0.05f;
    for (const int height_px : {54, 180}) {
      FrameSettings settings;
      settings.width_px = height_px * 16 / 9, settings.height_px = height_px;
      settings.threads = 2;
      settings.isa = supported_isas().front();
      settings.aovs = 1u << static_cast<int>(Aov::kHitKind);
      Renderer renderer(scene, settings);
      Frame frame;
      renderer.render(scene.cameras[0].camera, 0.4, frame);
      std::uint64_t surface = 0, water = 0;
      for (const std::uint32_t kind_of_hit : frame.aovs.at(0).uints) {
        water += kind_of_hit != static_cast<std::uint32_t>(HitKind::kNoWater);
        surface += kind_of_hit == static_cast<std::uint32_t>(HitKind::kSurface);
      }
      INFO("surface " << static_cast<int>(kind) << ", " << height_px << " rows: " << surface << " of " << water);
      REQUIRE(water > 1500);
      // A few near the lower edge of the frame are bent out of the layer.
      CHECK(static_cast<double>(surface) >= 0.995 * static_cast<double>(water));
    }
  }
}
