#include "tests/assets/asset_builder.h"

#include <cmath>

#include "core/math.h"

namespace shoal::test {

using nlohmann::json;

namespace {

void push(std::vector<float>& to, std::initializer_list<float> values) { to.insert(to.end(), values); }

Vec3f unit(Vec3f v) {
  const float length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
  return {v.x / length, v.y / length, v.z / length};
}
Vec3f across(Vec3f a, Vec3f b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }

// One face of a box or a panel: centre and half axes.
void add_face(Shape& shape, Vec3f centre, Vec3f right, Vec3f up, float uv_size) {
  const auto first = static_cast<std::uint16_t>(shape.vertex_count());
  const Vec3f normal = across(right, up);
  for (int corner = 0; corner < 4; ++corner) {
    const float x = corner % 2 == 0 ? -1.0f : 1.0f, y = corner < 2 ? 1.0f : -1.0f;
    push(shape.positions,
         {centre.x + x * right.x + y * up.x, centre.y + x * right.y + y * up.y, centre.z + x * right.z + y * up.z});
    push(shape.normals, {normal.x, normal.y, normal.z});
    push(shape.uvs, {(x + 1) / 2 * uv_size, (1 - y) / 2 * uv_size});
  }
  for (const int corner : {0, 2, 1, 1, 2, 3}) shape.indices.push_back(static_cast<std::uint16_t>(first + corner));
}

}  // namespace

Shape make_sphere(int slices, int stacks, bool with_tangents) {
  Shape shape;
  for (int j = 0; j <= stacks; ++j) {
    for (int i = 0; i <= slices; ++i) {
      const float u = static_cast<float>(i) / static_cast<float>(slices);
      const float v = static_cast<float>(j) / static_cast<float>(stacks);
      float sin_u, cos_u, sin_v, cos_v;
      det_sincos(2 * kPi * (i == slices ? 0.0f : u), sin_u, cos_u);
      det_sincos(kPi * v, sin_v, cos_v);
      if (j == 0 || j == stacks) sin_v = 0;
      push(shape.positions, {sin_v * sin_u, cos_v, sin_v * cos_u});
      push(shape.normals, {sin_v * sin_u, cos_v, sin_v * cos_u});
      push(shape.uvs, {u, v});
      if (with_tangents) push(shape.tangents, {cos_u, 0, -sin_u, 1});
    }
  }
  const int row = slices + 1;
  for (int j = 0; j < stacks; ++j) {
    for (int i = 0; i < slices; ++i) {
      const int a = j * row + i, b = a + row;
      if (j > 0) {
        for (const int k : {a, b, a + 1}) shape.indices.push_back(static_cast<std::uint16_t>(k));
      }
      if (j + 1 < stacks) {
        for (const int k : {a + 1, b, b + 1}) shape.indices.push_back(static_cast<std::uint16_t>(k));
      }
    }
  }
  return shape;
}

Shape make_panel(float uv_size) {
  Shape shape;
  add_face(shape, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, uv_size);
  return shape;
}

Shape make_box() {
  Shape shape;
  add_face(shape, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 1);
  add_face(shape, {0, 0, -1}, {-1, 0, 0}, {0, 1, 0}, 1);
  add_face(shape, {1, 0, 0}, {0, 0, -1}, {0, 1, 0}, 1);
  add_face(shape, {-1, 0, 0}, {0, 0, 1}, {0, 1, 0}, 1);
  add_face(shape, {0, 1, 0}, {1, 0, 0}, {0, 0, -1}, 1);
  add_face(shape, {0, -1, 0}, {1, 0, 0}, {0, 0, 1}, 1);
  return shape;
}

std::vector<std::uint8_t> make_picture(int size, bool with_alpha, const PixelColor& color) {
  std::vector<std::uint8_t> rows;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const std::vector<std::uint8_t> rgba = color(x, y);
      rows.insert(rows.end(), rgba.begin(), rgba.begin() + (with_alpha ? 4 : 3));
    }
  }
  const auto side = static_cast<std::uint32_t>(size);
  return png(side, side, with_alpha ? 6 : 2, 8, rows);
}

std::vector<std::uint8_t> make_bump_map(int size, int cells) {
  return make_picture(size, false, [&](int x, int y) {
    const int cell = size / cells;
    const float half = static_cast<float>(cell) / 2;
    const float dx = (static_cast<float>(x % cell) + 0.5f) / half - 1,
                dy = (static_cast<float>(y % cell) + 0.5f) / half - 1;
    const bool on_bump = dx * dx + dy * dy < 0.8f;
    const float nx = on_bump ? 0.8f * dx : 0, ny = on_bump ? -0.8f * dy : 0;
    const float nz = std::sqrt(1 - nx * nx - ny * ny);
    const auto code = [](float v) { return static_cast<std::uint8_t>(std::floor((v * 0.5f + 0.5f) * 255 + 0.5f)); };
    return std::vector<std::uint8_t>{code(nx), code(ny), code(nz), 255};
  });
}

AssetBuilder::AssetBuilder() : file_(empty_file()) {
  root()["asset"]["generator"] = "Shoal, tests/assets";
  root()["asset"]["copyright"] = "The Shoal authors; licence as Shoal's";
}

std::size_t AssetBuilder::add_texture(const std::vector<std::uint8_t>& png, json sampler) {
  root()["images"].push_back({{"bufferView", file_.add_view(png.data(), png.size())}, {"mimeType", "image/png"}});
  json texture = {{"source", root()["images"].size() - 1}};
  if (!sampler.is_null()) {
    root()["samplers"].push_back(std::move(sampler));
    texture["sampler"] = root()["samplers"].size() - 1;
  }
  root()["textures"].push_back(std::move(texture));
  return root()["textures"].size() - 1;
}

std::size_t AssetBuilder::add_material(json material) {
  root()["materials"].push_back(std::move(material));
  return root()["materials"].size() - 1;
}

std::size_t AssetBuilder::add_mesh(json primitive) {
  root()["meshes"].push_back({{"primitives", json::array({std::move(primitive)})}});
  return root()["meshes"].size() - 1;
}

std::size_t AssetBuilder::add_node(json node) {
  root()["nodes"].push_back(std::move(node));
  root()["scenes"].back()["nodes"].push_back(root()["nodes"].size() - 1);
  return root()["nodes"].size() - 1;
}

std::size_t AssetBuilder::add_positions(const std::vector<float>& positions) {
  const std::size_t number = file_.add_floats(positions, "VEC3", 3);
  for (std::size_t c = 0; c < 3; ++c) {
    float least = positions[c], most = positions[c];
    for (std::size_t i = c; i < positions.size(); i += 3) {
      least = positions[i] < least ? positions[i] : least;
      most = positions[i] > most ? positions[i] : most;
    }
    root()["accessors"][number]["min"].push_back(least);
    root()["accessors"][number]["max"].push_back(most);
  }
  return number;
}

std::size_t AssetBuilder::add_indices(const std::vector<std::uint16_t>& indices) {
  return file_.add_accessor(indices.data(), indices.size() * 2, 5123, "SCALAR", indices.size());
}

json AssetBuilder::add_shape(const Shape& shape) {
  json primitive = {{"attributes", {{"POSITION", add_positions(shape.positions)}}}};
  json& attributes = primitive["attributes"];
  if (!shape.normals.empty()) attributes["NORMAL"] = file_.add_floats(shape.normals, "VEC3", 3);
  if (!shape.uvs.empty()) attributes["TEXCOORD_0"] = file_.add_floats(shape.uvs, "VEC2", 2);
  if (!shape.tangents.empty()) attributes["TANGENT"] = file_.add_floats(shape.tangents, "VEC4", 4);
  if (!shape.indices.empty()) primitive["indices"] = add_indices(shape.indices);
  return primitive;
}

void AssetBuilder::use_extension(const std::string& name, bool required) {
  const auto list = [&](const char* key) {
    for (const json& one : root()[key]) {
      if (one == name) return;
    }
    root()[key].push_back(name);
  };
  list("extensionsUsed");
  if (required) list("extensionsRequired");
}

json look_at(Vec3f eye, Vec3f target) {
  const Vec3f back = unit({eye.x - target.x, eye.y - target.y, eye.z - target.z});
  const Vec3f up = back.x == 0 && back.z == 0 ? Vec3f{0, 0, -1} : Vec3f{0, 1, 0};
  const Vec3f right = unit(across(up, back)), top = across(back, right);
  return json::array(
      {right.x, right.y, right.z, 0, top.x, top.y, top.z, 0, back.x, back.y, back.z, 0, eye.x, eye.y, eye.z, 1});
}

void AssetBuilder::add_camera(const std::string& name, Vec3f eye, Vec3f target, double yfov) {
  root()["cameras"].push_back({{"type", "perspective"}, {"perspective", {{"yfov", yfov}, {"znear", 0.05}}}});
  add_node({{"name", name}, {"camera", root()["cameras"].size() - 1}, {"matrix", look_at(eye, target)}});
}

void AssetBuilder::add_orthographic_camera(const std::string& name, Vec3f eye, Vec3f target, double xmag, double ymag) {
  root()["cameras"].push_back(
      {{"type", "orthographic"}, {"orthographic", {{"xmag", xmag}, {"ymag", ymag}, {"znear", 0.05}, {"zfar", 50}}}});
  add_node({{"name", name}, {"camera", root()["cameras"].size() - 1}, {"matrix", look_at(eye, target)}});
}

void AssetBuilder::add_light(json light, Vec3f from, Vec3f to) {
  use_extension("KHR_lights_punctual");
  json& lights = root()["extensions"]["KHR_lights_punctual"]["lights"];
  lights.push_back(std::move(light));
  add_node({{"matrix", look_at(from, to)}, {"extensions", {{"KHR_lights_punctual", {{"light", lights.size() - 1}}}}}});
}

}  // namespace shoal::test
