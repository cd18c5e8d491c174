// Under waves, the raster methods' narrow phase against the ray tracer: Embree's own search over the same triangles.
#include <algorithm>
#include <catch2/catch.hpp>
#include <stdexcept>
#include <string>

#include "core/isa.h"
#include "refraction/renderer.h"
#include "scene/scene.h"

using namespace shoal;

namespace {

const AovImage& image_of(const Frame& frame, Aov aov) {
  return *std::find_if(frame.aovs.begin(), frame.aovs.end(), [&](const AovImage& i) { return i.aov == aov; });
}

std::size_t object_of(const Geometry& g, std::uint32_t triangle) {
  if (triangle == kNoTriangle) return g.drawables.size();
  const auto after = std::upper_bound(g.drawables.begin(), g.drawables.end(), triangle,
                                      [](std::uint32_t id, const Drawable& d) { return id < d.first_triangle; });
  return static_cast<std::size_t>(after - g.drawables.begin()) - 1;
}

}  // namespace

TEST_CASE("waves: what two-phase finds is what rays find", "[refraction]") {
  for (const char* name : {"pool", "pond"}) {
    RenderScene scene;
    for (const ProceduralScene& s : procedural_scenes())
      if (std::string(s.name) == name) scene = build_render_scene(s.make(12000));
    for (WaterBody& body : scene.waters) {
      body.surface.kind = SurfaceKind::kGradientWaves;
      body.surface.slope = 0.1f;
    }
    for (const std::size_t camera : {0u, 1u, 2u}) {
      Frame frames[2];
      const char* methods[2] = {"two-phase", "ray-traced"};
      for (int i = 0; i < 2; ++i) {
        FrameSettings settings;
        settings.method = methods[i];
        settings.width_px = 240, settings.height_px = 136;
        settings.threads = 2;
        settings.isa = supported_isas().front();
        settings.shadows = Shadows::kOff;
        settings.aovs = 1u << static_cast<int>(Aov::kHitKind) | 1u << static_cast<int>(Aov::kHitId);
        Renderer(scene, settings).render(scene.cameras[camera].camera, 1.0, frames[i]);
      }
      std::size_t water = 0, wrong = 0;
      for (std::size_t p = 0; p < std::size_t{240} * 136; ++p) {
        const auto kind = [&](int i) { return image_of(frames[i], Aov::kHitKind).uints[p]; };
        const auto id = [&](int i) { return image_of(frames[i], Aov::kHitId).uints[p]; };
        if (kind(1) == static_cast<std::uint32_t>(HitKind::kNoWater)) continue;
        ++water;
        wrong += kind(0) != kind(1) || object_of(scene.geometry, id(0)) != object_of(scene.geometry, id(1));
      }
      INFO(name << ", camera " << camera << ": " << wrong << " of " << water);
      REQUIRE(water > 3000);
      CHECK(static_cast<double>(wrong) <= 0.002 * static_cast<double>(water));
    }
  }
}
