// A frame of an animated scene is the frame of a scene that stands still where the animation is then.
#include <catch2/catch.hpp>
#include <string>

#include "refraction/renderer.h"
#include "scene/build/animate.h"
#include "scene/build/transform.h"

namespace shoal::test {
namespace {

Scene find_box() {
  for (const ProceduralScene& built_in : procedural_scenes()) {
    if (std::string(built_in.name) == "box") return built_in.make(1000);
  }
  FAIL("no scene named box");
  return {};
}

// The box's water sinks, and everything that has a mesh sways; roots only.
Scene swaying_box() {
  Scene scene = find_box();
  Animation sway;
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
    const Node& node = scene.nodes[n];
    REQUIRE(node.parent == kNoIndex);
    LocalTransform local;
    local.translation = widen(node.world_from_local)[3];
    const bool moves = node.water != kNoIndex || (node.mesh != kNoIndex && n % 2 == 1);
    if (!moves) {
      local.is_matrix = true;
      local.matrix = widen(node.world_from_local);
    } else {
      Channel c;
      c.node = static_cast<std::int32_t>(n);
      c.times_s = {0, 2};
      const float x = node.world_from_local[3].x, y = node.world_from_local[3].y, z = node.world_from_local[3].z;
      c.values = {x, y, z, node.water != kNoIndex ? x : x + 0.25f, y - 0.125f, z};
      sway.channels.push_back(c);
    }
    scene.locals.push_back(local);
  }
  scene.animations.push_back(sway);
  return scene;
}

Scene frozen(const Scene& moving, double time_s) {
  Scene still = moving;
  const Pose pose = pose_scene(moving, time_s);
  for (std::size_t n = 0; n < still.nodes.size(); ++n)
    still.nodes[n].world_from_local = narrow(pose.world_from_local[n]);
  still.animations.clear();
  still.locals.clear();
  return still;
}

}  // namespace

TEST_CASE("animated: every stage of a moving scene's frame is that of the scene frozen then", "[animated]") {
  const Scene scene = swaying_box();
  REQUIRE_FALSE(scene.animations[0].channels.empty());
  REQUIRE_FALSE(scene.waters.empty());
  const RenderScene moving = build_render_scene(scene);
  FrameSettings settings;
  settings.width_px = 96, settings.height_px = 64;
  settings.digests = true;
  settings.threads = 3;
  settings.method = GENERATE("hybrid", "ray-traced");
  if (settings.method == "ray-traced") settings.shadows = Shadows::kRays;
  Renderer renderer(moving, settings);
  std::string first_picture;
  for (const double time_s : {1.5, 0.0, 0.75}) {
    const Scene still_scene = frozen(scene, time_s);
    RenderScene still = build_render_scene(still_scene);
    // A body's depth is the one it had at the start.
    for (std::size_t b = 0; b < still.waters.size(); ++b) still.waters[b].depth_m = moving.waters[b].depth_m;
    Renderer reference(still, settings);
    for (const PlacedCamera& camera : still.cameras) {
      CAPTURE(settings.method, time_s, camera.name);
      Frame frame, expected;
      renderer.render(camera.camera, time_s, frame);
      reference.render(camera.camera, 0, expected);
      CHECK(frame.digests == expected.digests);
      CHECK(frame.water_pixels > 0);
      if (first_picture.empty()) {
        first_picture = picture_digest(frame);
      } else if (camera.name == still.cameras[0].name) {
        CHECK(picture_digest(frame) != first_picture);
      }
    }
  }
}

}  // namespace shoal::test
