// The narrow phase against the ray tracer, which traces every ray from the eye on, and paths that cross water again.
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

struct Tally {
  std::size_t water = 0, wrong = 0;  // pixels
  std::size_t again = 0;             // of water whose rays cross a secondary interface: paths of depth 2 differ
};

RenderScene scene_of(const char* name, float slope, WaterGeometry geometry) {
  RenderScene scene;
  for (const ProceduralScene& s : procedural_scenes())
    if (std::string(s.name) == name) scene = build_render_scene(s.make(12000));
  for (WaterBody& body : scene.waters) {
    body.surface.kind = slope > 0.0f ? SurfaceKind::kGradientWaves : SurfaceKind::kFlat;
    body.surface.slope = slope;
    body.surface.geometry = geometry;
  }
  return scene;
}

Tally compare(const RenderScene& scene, std::size_t camera) {
  Frame frames[3];
  const char* methods[3] = {"hybrid", "ray-traced", "ray-traced"};
  for (int i = 0; i < 3; ++i) {
    FrameSettings settings;
    settings.method = methods[i];
    settings.width_px = 240, settings.height_px = 136;
    settings.threads = 2;
    settings.isa = supported_isas().front();
    settings.shadows = Shadows::kOff;
    settings.aovs = 1u << static_cast<int>(Aov::kHitKind) | 1u << static_cast<int>(Aov::kHitId);
    if (i == 2) settings.method_options = {{"depth", "2"}};
    Renderer(scene, settings).render(scene.cameras[camera].camera, 1.0, frames[i]);
  }
  Tally tally;
  for (std::size_t p = 0; p < std::size_t{240} * 136; ++p) {
    const auto kind = [&](int i) { return image_of(frames[i], Aov::kHitKind).uints[p]; };
    const auto id = [&](int i) { return image_of(frames[i], Aov::kHitId).uints[p]; };
    const auto differ = [&](int i, int k) {
      return kind(i) != kind(k) || object_of(scene.geometry, id(i)) != object_of(scene.geometry, id(k));
    };
    if (kind(1) == static_cast<std::uint32_t>(HitKind::kNoWater)) continue;
    ++tally.water;
    tally.wrong += differ(0, 1);
    tally.again += differ(2, 1);
  }
  return tally;
}

}  // namespace

TEST_CASE("narrow phase: what hybrid finds is what rays find", "[refraction]") {
  struct Case {
    const char* name;
    float slope;
    WaterGeometry geometry;
    bool again;  // enough rays cross a secondary water interface
  };
  for (const Case& c :
       {Case{"pool", 0, WaterGeometry::kNormals, false}, Case{"pond", 0, WaterGeometry::kNormals, false},
        Case{"tank", 0, WaterGeometry::kNormals, true}, Case{"pool", 0.1f, WaterGeometry::kNormals, false},
        Case{"pond", 0.1f, WaterGeometry::kNormals, false}, Case{"tank", 0.1f, WaterGeometry::kNormals, true},
        Case{"pool", 0.15f, WaterGeometry::kDisplaced, true}, Case{"pond", 0.15f, WaterGeometry::kDisplaced, true}}) {
    const RenderScene scene = scene_of(c.name, c.slope, c.geometry);
    Tally all;
    for (std::size_t camera = 0; camera < scene.cameras.size(); ++camera) {
      const Tally one = compare(scene, camera);
      INFO(c.name << ", slope " << c.slope << ", camera " << camera << ": " << one.wrong << " of " << one.water
                  << ", again " << one.again);
      CHECK(static_cast<double>(one.wrong) <= 0.0005 * static_cast<double>(one.water));
      all.water += one.water, all.again += one.again;
    }
    REQUIRE(all.water > 6000);
    if (c.again) REQUIRE(all.again > 100);
  }
}
