// Small glTF files of our own (data/assets/): shapes, pictures, and the file that they go into.
//
// The same bytes on every machine: sines are core/math.h's, and PNG data are stored, not compressed.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/vec.h"
#include "tests/scene/bad_files.h"

namespace shoal::test {

// A mesh's arrays, as in glTF; each is empty or has one element a vertex.
struct Shape {
  std::vector<float> positions, normals, uvs, tangents;  // 3, 3, 2 and 4 a vertex
  std::vector<std::uint16_t> indices;

  std::size_t vertex_count() const { return positions.size() / 3; }
};

// Radius 1 about the origin; u goes round to the right as seen from outside, v from the top (+y) down.
Shape make_sphere(int slices, int stacks, bool with_tangents);
// 2 x 2 in the plane z = 0, facing +z; u to the right and v down, both from 0 to uv_size.
Shape make_panel(float uv_size = 1);
// Edges of 2 about the origin, each face with the panel's texture coordinates.
Shape make_box();

// A picture of `size` x `size` pixels, `color` giving R, G, B, A of a pixel, as a PNG with alpha (or without).
using PixelColor = std::function<std::vector<std::uint8_t>(int x, int y)>;
std::vector<std::uint8_t> make_picture(int size, bool with_alpha, const PixelColor& color);
// Round bumps, `cells` in a row, as a normal map (green up).
std::vector<std::uint8_t> make_bump_map(int size, int cells);

class AssetBuilder {
 public:
  AssetBuilder();

  nlohmann::json& root() { return file_.root; }
  CraftedFile& file() { return file_; }

  // Each returns the number of what it adds.
  std::size_t add_texture(const std::vector<std::uint8_t>& png, nlohmann::json sampler = nullptr);
  std::size_t add_material(nlohmann::json material);
  std::size_t add_mesh(nlohmann::json primitive);
  std::size_t add_node(nlohmann::json node);  // at the root of the scene in the making

  // Accessors of a shape, as a primitive without material.
  nlohmann::json add_shape(const Shape& shape);
  // POSITION's accessor says where it begins and ends, as the specification asks.
  std::size_t add_positions(const std::vector<float>& positions);
  std::size_t add_indices(const std::vector<std::uint16_t>& indices);

  void use_extension(const std::string& name, bool required = false);
  void add_camera(const std::string& name, Vec3f eye, Vec3f target, double yfov);
  void add_orthographic_camera(const std::string& name, Vec3f eye, Vec3f target, double xmag, double ymag);
  // A KHR_lights_punctual light at `from`, shining towards `to`.
  void add_light(nlohmann::json light, Vec3f from, Vec3f to);

  void save(const std::string& path) const { file_.save_glb(path); }

 private:
  CraftedFile file_;
};

// Column-major, as glTF's `matrix`: at `eye`, -z towards `target`, x level.
nlohmann::json look_at(Vec3f eye, Vec3f target);

// One file each, by what it is about.
void make_materials_asset(const std::string& path);
void make_textures_asset(const std::string& path);
void make_motion_asset(const std::string& path);
void make_geometry_asset(const std::string& path);
void make_water_asset(const std::string& path);

}  // namespace shoal::test
