#include <cmath>

#include "scene/procedural/mesh_builder.h"
#include "scene/procedural/scenes.h"

namespace shoal {
namespace {

Mat4 look_along(Vec3f forward, Vec3f at) {
  const Vec3f z = normalize(-forward), x = normalize(cross(Vec3f{0, 1, 0}, z)), y = cross(z, x);
  return from_rows({x.x, y.x, z.x, at.x}, {x.y, y.y, z.y, at.y}, {x.z, y.z, z.z, at.z});
}

Node make_node(const char* name, const Mat4& world_from_local) {
  Node node;
  node.name = name;
  node.world_from_local = world_from_local;
  return node;
}

}  // namespace

void add_camera(Scene& scene, const char* name, Vec3f at, Vec3f target, float yfov) {
  CameraSpec camera;
  camera.yfov = yfov;
  scene.cameras.push_back(camera);
  Node node = make_node(name, look_along(target - at, at));
  node.camera = static_cast<std::int32_t>(scene.cameras.size()) - 1;
  scene.nodes.push_back(std::move(node));
}

void add_water(Scene& scene, const char* name, Vec3f at, const WaterSpec& spec) {
  scene.waters.push_back(spec);
  Node node = make_node(name, translation(at));
  node.water = static_cast<std::int32_t>(scene.waters.size()) - 1;
  scene.nodes.push_back(std::move(node));
}

void add_sun(Scene& scene, Vec3f to_sun, Vec3f color, float intensity) {
  scene.lights.push_back({color, intensity});
  Node node = make_node("sun", look_along(-to_sun, {0, 0, 0}));
  node.light = static_cast<std::int32_t>(scene.lights.size()) - 1;
  scene.nodes.push_back(std::move(node));
  scene.has_background = true;
  scene.background.kind = Background::Kind::kSky;
  scene.background.to_sun_world = normalize(to_sun);
  scene.background.sun = color * intensity;
}

const std::vector<ProceduralScene>& procedural_scenes() {
  static const std::vector<ProceduralScene> scenes = {
      {"pool", "a villa's swimming pool: tiles, steps, ladder, balls and rings, half and fully under water", make_pool,
       128000},
      {"box", "a small open basin with boxes and balls through the water, for tests", make_box, 1000},
      {"ball", "Li et al.'s green ball of 39936 triangles over Perlin water", make_ball, 39936},
      {"knot", "a studded torus knot over Perlin water, as large as Li et al.'s dragon", make_knot, 2400000},
      {"furnace", "all is white, so every pixel of every method must be: conservation of light", make_furnace, 1000},
      {"tank", "an aquarium seen through its side: an upright plane of water and a level one", make_tank, 64000},
      {"pond", "Steel's pond: 128 pots and arrows in a bowl with a shore, in a meadow", make_pond, 128000}};
  return scenes;
}

}  // namespace shoal
