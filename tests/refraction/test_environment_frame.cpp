// The furnace through the whole renderer, and an environment where rays leave the scene: past surfaces, by reflection
// in water and through it.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/thread_pool.h"
#include "refraction/renderer.h"
#include "shading/environment/build.h"

using namespace shoal;

namespace {

// A ball of radius 1 round the origin, rings of quads, with exact normals.
MeshPrimitive ball() {
  constexpr int kRings = 24, kSpokes = 48;
  constexpr double kPi64 = 3.14159265358979323846;
  MeshPrimitive mesh;
  for (int i = 0; i <= kRings; ++i) {
    for (int j = 0; j <= kSpokes; ++j) {
      const double theta = kPi64 * i / kRings, phi = 2 * kPi64 * j / kSpokes;
      const Vec3f p{static_cast<float>(std::sin(theta) * std::cos(phi)), static_cast<float>(std::cos(theta)),
                    static_cast<float>(std::sin(theta) * std::sin(phi))};
      mesh.positions.push_back(p);
      mesh.normals.push_back(p);
    }
  }
  for (std::uint32_t i = 0; i < kRings; ++i) {
    for (std::uint32_t j = 0; j < kSpokes; ++j) {
      const std::uint32_t a = i * (kSpokes + 1) + j, b = a + kSpokes + 1;
      mesh.indices.insert(mesh.indices.end(), {a, a + 1, b, a + 1, b + 1, b});
    }
  }
  return mesh;
}

Mat4 moved(float x, float y, float z) { return translation({x, y, z}); }

Background surroundings(const EquirectImage& image) {
  ThreadPool pool(2);
  Background background;
  background.kind = Background::Kind::kEnvironment;
  background.environment = std::make_shared<const Environment>(make_environment(image, pool));
  return background;
}

Scene scene_with(const Background& background) {
  Scene scene;
  scene.name = "surrounded";
  scene.has_background = true;
  scene.background = background;
  scene.cameras.resize(1);
  Node camera;
  camera.camera = 0;
  camera.world_from_local = moved(0, 0, 6);
  scene.nodes.push_back(camera);
  return scene;
}

Frame render(const RenderScene& scene, int width, int height) {
  FrameSettings s;
  s.width_px = width;
  s.height_px = height;
  s.isa = supported_isas().front();
  s.threads = 2;
  s.keep_linear = true;
  Frame frame;
  Renderer(scene, s).render(scene.cameras[0].camera, 0, frame);
  return frame;
}

}  // namespace

TEST_CASE("environment: white balls in a uniform picture cannot be seen") {
  Scene scene = scene_with(surroundings(EquirectImage{8, 4, std::vector<float>(8 * 4 * 3, 1.0f)}));
  for (int i = 0; i < 6; ++i) {
    Material m;
    m.roughness = static_cast<float>(i % 3) * 0.5f;
    m.metallic = i < 3 ? 0.0f : 1.0f;
    scene.materials.materials.push_back(m);
    Mesh mesh;
    mesh.primitives.push_back(ball());
    mesh.primitives[0].material = i;
    scene.meshes.push_back(mesh);
    Node node;
    node.mesh = i;
    node.world_from_local = moved(static_cast<float>(i % 3) * 2.2f - 2.2f, i < 3 ? 1.1f : -1.1f, 0);
    scene.nodes.push_back(node);
  }
  const RenderScene built = build_render_scene(scene);
  CHECK(built.lighting.directional.empty());  // surrounded by light, a scene gets no sun of its own
  const Frame frame = render(built, 160, 120);
  double worst = 0;
  int covered = 0;
  for (std::size_t i = 0; i < frame.linear.size(); i += 4) {
    for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, std::abs(double(frame.linear[i + c]) - 1.0));
    covered += frame.linear[i + 3] > 0 ? 1 : 0;
  }
  CHECK(covered > 4000);
  CHECK(worst < 1e-4);
  CHECK(std::all_of(frame.srgb8.begin(), frame.srgb8.end(), [](std::uint8_t v) { return v == 255; }));
}

TEST_CASE("environment: rays that leave see it, above the water, mirrored in it and through it") {
  // Red above the horizon, green below.
  EquirectImage image{64, 32, {}};
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x) {
      for (const float v : {y < 16 ? 2.0f : 0.0f, y < 16 ? 0.0f : 3.0f, 0.0f}) image.rgb.push_back(v);
    }
  }
  Scene scene = scene_with(surroundings(image));
  // A pond to the horizon, the eye a metre above it and looking level: the lower half of the view.
  scene.nodes[0].world_from_local = from_rows({1, 0, 0, 0}, {0, 1, 0, 1}, {0, 0, 1, 6});
  WaterSpec spec;
  spec.has_size = spec.has_depth = true;
  spec.size_x = spec.size_z = 400;
  spec.depth = 1;
  spec.absorption = {0, 0, 0};
  scene.waters.push_back(spec);
  Node water;
  water.water = 0;
  scene.nodes.push_back(water);
  const Frame frame = render(build_render_scene(scene), 64, 64);
  const auto at = [&](std::size_t x, std::size_t y) { return &frame.linear[(y * 64 + x) * 4]; };
  CHECK(at(32, 8)[0] == 2.0f);
  CHECK(at(32, 8)[1] == 0.0f);
  // Into the pond: what is refracted is green, what is mirrored red, and nothing of either is lost.
  const float* pond = at(32, 60);
  CHECK(pond[0] > 0.02f);
  CHECK(pond[1] > 1.0f);
  CHECK(pond[0] / 2 + pond[1] / 3 == Approx(1).margin(1e-3));
}
