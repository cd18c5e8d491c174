#include "bench/scenes.h"

#include <map>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bench/harness.h"

namespace shoal::bench {

const RenderScene& built_in_scene(const std::string& name, std::uint64_t triangles) {
  static std::map<std::pair<std::string, std::uint64_t>, std::unique_ptr<RenderScene>> made;
  std::unique_ptr<RenderScene>& scene = made[{name, triangles}];
  if (!scene)
    for (const ProceduralScene& p : procedural_scenes())
      if (name == p.name) scene = std::make_unique<RenderScene>(build_render_scene(p.make(triangles)));
  if (!scene) throw std::runtime_error("there is no scene " + name);
  return *scene;
}
const RenderScene& pool_scene(std::uint64_t triangles) { return built_in_scene("pool", triangles); }

const Camera& first_camera(const RenderScene& scene) { return scene.cameras.front().camera; }

namespace {

// An eye at the origin that looks along -z at the plane z = -1, where a pixel is 1 / kHeight wide.
Camera eye() {
  Camera camera;
  camera.tan_half_yfov = 0.5f;
  return camera;
}
constexpr float kPixel = 1.0f / kHeight;

RenderScene finish(Geometry geometry, Material material) {
  RenderScene scene;
  scene.geometry = std::move(geometry);
  scene.materials.materials = {material};
  scene.cameras = {{"eye", 0, eye()}};
  scene.lighting.directional = {{{0, 0, -1}, {2, 2, 2}}};
  return scene;
}

}  // namespace

Texture make_noise(int size) {
  std::vector<std::uint8_t> texels(static_cast<std::size_t>(size) * static_cast<std::size_t>(size) * 4);
  Random random;
  for (std::uint8_t& t : texels) t = static_cast<std::uint8_t>(random.next() * 256.0f);
  return make_texture_rgba8(size, size, texels.data(), true);
}

RenderScene make_quad(int texture_size) {
  const float x = 0.5f * kWidth * kPixel + 0.01f, y = 0.5f + 0.01f;
  const float uv_per_m = 1.41421356f / (kPixel * static_cast<float>(texture_size));
  const std::vector<Vec3f> positions = {{-x, -y, -1}, {x, -y, -1}, {x, y, -1}, {-x, y, -1}};
  std::vector<Vec2f> uvs;
  for (const Vec3f& p : positions) uvs.push_back({p.x * uv_per_m, p.y * uv_per_m});
  const std::vector<Vec3f> normals(4, Vec3f{0, 0, 1});
  const std::vector<std::uint32_t> indices = {0, 1, 2, 0, 2, 3};
  MeshView mesh;
  mesh.positions_world = positions.data(), mesh.normals_world = normals.data(), mesh.uvs = uvs.data();
  mesh.indices = indices.data(), mesh.vertex_count = 4, mesh.index_count = 6;
  Geometry geometry;
  append_mesh(geometry, mesh);
  Material material;
  material.base_color_texture = 0;
  RenderScene scene = finish(std::move(geometry), material);
  scene.materials.textures.push_back(make_noise(texture_size));
  return scene;
}

void add_maps(RenderScene& scene) {
  constexpr int kSize = 512;
  Materials& m = scene.materials;
  const auto first = static_cast<std::int32_t>(m.textures.size());
  std::vector<std::uint8_t> bumps(std::size_t{kSize} * kSize * 4), shares(bumps.size());
  Random random;
  for (std::size_t i = 0; i < bumps.size(); i += 4) {
    const auto tilt = [&] { return static_cast<std::uint8_t>(random.between(112, 144)); };
    bumps[i] = tilt(), bumps[i + 1] = tilt(), bumps[i + 2] = 250, bumps[i + 3] = 255;
    for (std::size_t c = 0; c < 4; ++c) shares[i + c] = static_cast<std::uint8_t>(random.between(128, 256));
  }
  m.textures.push_back(make_texture_rgba8(kSize, kSize, bumps.data(), false));
  m.textures.push_back(make_texture_rgba8(kSize, kSize, shares.data(), false));
  m.textures.push_back(make_texture_rgba8(kSize, kSize, shares.data(), true));
  for (Material& material : m.materials) {
    if (material.base_color_texture == kNoTexture) continue;
    material.normal.texture = first;
    material.metallic_roughness.texture = material.occlusion.texture = first + 1;
    material.emission.texture = first + 2;
    material.emissive = {0.02f, 0.02f, 0.02f};
  }
  // Any vector will do for a cost: it is made unit in the pixel, and is not made orthogonal there.
  scene.geometry.tangents.assign(scene.geometry.vertices.size(), Vec4f{0.6f, 0.0f, 0.8f, 1.0f});
}

void add_point_lights(RenderScene& scene, int count) {
  for (int i = 0; i < count; ++i) {
    PunctualLight lamp;
    lamp.position_world = {static_cast<float>(i % 4) * 2.0f - 3.0f, 2.5f, static_cast<float>(i / 4) * 3.0f - 4.5f};
    lamp.intensity = {1.0f, 0.9f, 0.7f};
    scene.lighting.punctual.push_back(lamp);
  }
}

RenderScene make_grid(int cells, float cell_px, bool front) {
  const int side = cells + 1;
  const float step = cell_px * kPixel, start = -0.5f * step * static_cast<float>(cells);
  std::vector<Vec3f> positions;
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i)
      positions.push_back({start + step * static_cast<float>(i), start + step * static_cast<float>(j), -1});
  const std::vector<Vec3f> normals(positions.size(), Vec3f{0, 0, 1});
  std::vector<std::uint32_t> indices;
  const auto add_triangle = [&](int a, int b, int c) {
    if (!front) std::swap(b, c);
    for (const int v : {a, b, c}) indices.push_back(static_cast<std::uint32_t>(v));
  };
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const int at = j * side + i;
      add_triangle(at, at + 1, at + side + 1);
      add_triangle(at, at + side + 1, at + side);
    }
  MeshView mesh;
  mesh.positions_world = positions.data(), mesh.normals_world = normals.data(), mesh.indices = indices.data();
  mesh.vertex_count = static_cast<std::uint32_t>(positions.size());
  mesh.index_count = static_cast<std::uint32_t>(indices.size());
  Geometry geometry;
  append_mesh(geometry, mesh);
  return finish(std::move(geometry), Material{});
}

}  // namespace shoal::bench
