// Point and spot lights from a file to the rendered scene.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/error.h"
#include "scene/gltf/gltf.h"
#include "tests/scene/bad_files.h"

namespace shoal::test {
namespace {

using nlohmann::json;

// good_file() with its directional light replaced; its node is turned so that -z is -y, and stands at (1, 2, 3).
CraftedFile lamp_file(json light) {
  CraftedFile file = good_file();
  file.root["extensions"]["KHR_lights_punctual"]["lights"] = json::array({std::move(light)});
  file.root["nodes"][2]["translation"] = {1, 2, 3};
  file.root["nodes"][2]["rotation"] = {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
  return file;
}

Scene load(const CraftedFile& file) {
  const TemporaryFolder folder;
  return load_gltf(file.save_glb(folder / "lamp.glb"));
}

}  // namespace

TEST_CASE("lamps: a point light at its node, and no other light", "[gltf][light]") {
  const Scene scene = load(lamp_file({{"type", "point"}, {"color", {1, 0.5, 0}}, {"intensity", 8}, {"range", 4}}));
  const Lighting light = build_render_scene(scene).lighting;
  REQUIRE(light.punctual.size() == 1);
  CHECK(light.directional.empty());
  CHECK(light.background.sun.x == 0.0f);
  const PunctualLight& lamp = light.punctual[0];
  CHECK((lamp.position_world.x == 1 && lamp.position_world.y == 2 && lamp.position_world.z == 3));
  CHECK((lamp.intensity.x == 8 && lamp.intensity.y == 4 && lamp.intensity.z == 0));
  CHECK(lamp.inverse_range2 == 1.0f / 16);
  CHECK((lamp.cone_scale == 0 && lamp.cone_offset == 1));
}

TEST_CASE("lamps: a spot's axis and cone", "[gltf][light]") {
  const Scene scene =
      load(lamp_file({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.75}}}}));
  const Lighting light = build_render_scene(scene).lighting;
  REQUIRE(light.punctual.size() == 1);
  const PunctualLight& lamp = light.punctual[0];
  CHECK(lamp.direction_world.y == Approx(-1).epsilon(1e-6));
  CHECK(lamp.inverse_range2 == 0.0f);
  // Full at the inner angle, none at the outer one, and linear in the cosine between them before it is squared.
  const auto across = [&](double angle) {
    return std::cos(angle) * double(lamp.cone_scale) + double(lamp.cone_offset);
  };
  CHECK(across(0.25) == Approx(1).epsilon(1e-5));
  CHECK(across(0.75) == Approx(0).margin(1e-5));
  CHECK(across(std::acos((std::cos(0.25) + std::cos(0.75)) / 2)) == Approx(0.5).epsilon(1e-5));
}

TEST_CASE("lamps: cones that exporters write, and wrong ones", "[gltf][light]") {
  const auto spot = [](json inner, json outer) {
    return lamp_file({{"type", "spot"}, {"spot", {{"innerConeAngle", inner}, {"outerConeAngle", outer}}}});
  };
  CHECK(load(spot(0.5, 0.5)).warnings.empty());
  CHECK(load(spot(0.0, 1.5707963267948966)).warnings.empty());
  const Scene wide = load(spot(0.9, 0.5));
  CHECK(wide.lights[0].inner_cone == wide.lights[0].outer_cone);
  CHECK(wide.warnings.size() == 1);
  CHECK_THROWS_AS(load(spot(0.1, 1.6)), Error);
  CHECK_THROWS_AS(load(spot(-0.1, 0.5)), Error);
  CHECK_THROWS_AS(load(spot("narrow", 0.5)), Error);
  CHECK_THROWS_AS(load(lamp_file({{"type", "spot"}})), Error);
  CHECK_THROWS_AS(load(lamp_file({{"type", "area"}})), Error);
  CHECK_THROWS_AS(load(lamp_file({{"type", "point"}, {"range", -1}})), Error);
}

}  // namespace shoal::test
