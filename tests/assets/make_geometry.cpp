// Ways to write a mesh and to place it. Whatever the way, each row has the same balls and plates.
#include <cmath>

#include "tests/assets/asset_builder.h"

namespace shoal::test {

using nlohmann::json;

namespace {

class Row {
 public:
  Row(AssetBuilder& asset, double y, json color) : asset_(asset), y_(y) {
    material_ =
        asset.add_material({{"pbrMetallicRoughness", {{"baseColorFactor", std::move(color)}, {"metallicFactor", 0}}}});
  }
  // Returns the node.
  std::size_t add(json primitive, json node = json::object()) {
    primitive["material"] = material_;
    node["mesh"] = asset_.add_mesh(std::move(primitive));
    node["translation"] = {x_, y_, 0};
    if (!node.contains("scale")) node["scale"] = {0.42, 0.42, 0.42};
    x_ += 1;
    return asset_.add_node(std::move(node));
  }
  std::size_t material() const { return material_; }

 private:
  AssetBuilder& asset_;
  double x_ = -2.5, y_;
  std::size_t material_;
};

std::int16_t short_of(float v) { return static_cast<std::int16_t>(std::floor(v * 32767 + 0.5f)); }
std::int8_t byte_of(float v) { return static_cast<std::int8_t>(std::floor(v * 127 + 0.5f)); }

// KHR_mesh_quantization: positions as normalized shorts, normals as normalized bytes, both padded to four.
json quantized(AssetBuilder& asset, const Shape& shape) {
  std::vector<std::int16_t> positions;
  std::vector<std::int8_t> normals;
  for (std::size_t i = 0; i < shape.positions.size(); ++i) {
    positions.push_back(short_of(shape.positions[i]));
    normals.push_back(byte_of(shape.normals[i]));
    if (i % 3 == 2) positions.push_back(0), normals.push_back(0);
  }
  asset.use_extension("KHR_mesh_quantization", true);
  json& accessors = asset.root()["accessors"];
  const std::size_t count = shape.vertex_count(), first = accessors.size();
  accessors.push_back({{"bufferView", asset.file().add_view(positions.data(), positions.size() * 2, 8)},
                       {"componentType", 5122},
                       {"normalized", true},
                       {"type", "VEC3"},
                       {"count", count},
                       {"min", {-32767, -32767, -32767}},
                       {"max", {32767, 32767, 32767}}});
  accessors.push_back({{"bufferView", asset.file().add_view(normals.data(), normals.size(), 4)},
                       {"componentType", 5120},
                       {"normalized", true},
                       {"type", "VEC3"},
                       {"count", count}});
  return {{"attributes", {{"POSITION", first}, {"NORMAL", first + 1}}}, {"indices", asset.add_indices(shape.indices)}};
}

json interleaved(AssetBuilder& asset, const Shape& shape) {
  std::vector<float> both;
  for (std::size_t i = 0; i < shape.positions.size(); i += 3) {
    both.insert(both.end(), &shape.positions[i], &shape.positions[i] + 3);
    both.insert(both.end(), &shape.normals[i], &shape.normals[i] + 3);
  }
  const std::size_t view = asset.file().add_view(both.data(), both.size() * 4, 24);
  json& accessors = asset.root()["accessors"];
  const std::size_t first = accessors.size();
  for (const int offset : {0, 12}) {
    accessors.push_back({{"bufferView", view},
                         {"byteOffset", offset},
                         {"componentType", 5126},
                         {"type", "VEC3"},
                         {"count", shape.vertex_count()}});
  }
  accessors[first]["min"] = {-1, -1, -1};
  accessors[first]["max"] = {1, 1, 1};
  return {{"attributes", {{"POSITION", first}, {"NORMAL", first + 1}}}, {"indices", asset.add_indices(shape.indices)}};
}

// A plate of 5 x 5 vertices whose inner ones are lifted by a sparse accessor.
json sparse(AssetBuilder& asset) {
  Shape plate;
  std::vector<std::uint8_t> where;
  std::vector<float> lifted;
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 5; ++x) {
      const float px = static_cast<float>(x - 2) / 2, py = static_cast<float>(2 - y) / 2;
      for (const float v : {px, py, 0.0f}) plate.positions.push_back(v);
      if (x % 4 != 0 && y % 4 != 0) {
        where.push_back(static_cast<std::uint8_t>(y * 5 + x));
        for (const float v : {px, py, x == 2 && y == 2 ? 1.0f : 0.6f}) lifted.push_back(v);
      }
      if (x == 4 || y == 4) continue;
      const int a = y * 5 + x;
      for (const int k : {a, a + 5, a + 1, a + 1, a + 5, a + 6}) plate.indices.push_back(static_cast<std::uint16_t>(k));
    }
  }
  json primitive = asset.add_shape(plate);
  json& accessor = asset.root()["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
  const std::size_t indices = asset.file().add_view(where.data(), where.size());
  const std::size_t values = asset.file().add_view(lifted.data(), lifted.size() * 4);
  accessor["sparse"] = {{"count", where.size()},
                        {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                        {"values", {{"bufferView", values}}}};
  accessor["max"][2] = 1;
  return primitive;
}

// A disc as a fan and a ribbon as a strip.
json fan(AssetBuilder& asset) {
  json primitive = {
      {"attributes",
       {{"POSITION", asset.add_positions({0,  0, 0, 1,     0,      0, 0.5f, 0.87f,  0, -0.5f, 0.87f, 0,
                                          -1, 0, 0, -0.5f, -0.87f, 0, 0.5f, -0.87f, 0, 1,     0,     0})}}},
      {"mode", 6}};
  return primitive;
}
json strip(AssetBuilder& asset) {
  json primitive = {{"attributes",
                     {{"POSITION", asset.add_positions({-1, 0.8f, 0, -1, -0.8f, 0, 0, 0.8f, 0.7f, 0, -0.8f, 0.7f, 1,
                                                        0.8f, 0, 1, -0.8f, 0})}}},
                    {"mode", 5}};
  const std::uint8_t order[] = {0, 1, 2, 3, 4, 5};
  primitive["indices"] = asset.file().add_accessor(order, sizeof order, 5121, "SCALAR", 6);
  return primitive;
}

void add_instances(AssetBuilder& asset, std::size_t material) {
  std::vector<float> translations, scales;
  std::vector<std::int8_t> rotations;
  for (int i = 0; i < 12; ++i) {
    const float t = static_cast<float>(i);
    for (const float v : {-2.75f + 0.5f * t, -1.45f, 0.8f}) translations.push_back(v);
    for (const float v : {0.08f + 0.008f * t, 0.2f, 0.12f}) scales.push_back(v);
    const float half = 0.08f * t;  // about y
    const std::int8_t turn[] = {0, byte_of(half), 0, byte_of(std::sqrt(1 - half * half))};
    rotations.insert(rotations.end(), turn, turn + 4);
  }
  json box = asset.add_shape(make_box());
  box["material"] = material;
  asset.use_extension("EXT_mesh_gpu_instancing");
  const json attributes = {
      {"TRANSLATION", asset.file().add_floats(translations, "VEC3", 3)},
      {"ROTATION", asset.file().add_accessor(rotations.data(), rotations.size(), 5120, "VEC4", 12, true)},
      {"SCALE", asset.file().add_floats(scales, "VEC3", 3)}};
  asset.add_node({{"name", "fence"},
                  {"mesh", asset.add_mesh(box)},
                  {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}}}});
}

void add_placed(AssetBuilder& asset, Row& row, const json& ball, const Shape& shape) {
  row.add(ball, {{"scale", {-0.42, 0.42, 0.42}}});
  row.add(ball, {{"scale", {-0.2, -0.42, -0.42}}});
  // A turned child under a flat parent: sheared.
  json box = asset.add_shape(make_box());
  box["material"] = row.material();
  const std::size_t parent = row.add(ball, {{"scale", {0.42, 0.15, 0.42}}});
  asset.root()["nodes"].push_back({{"mesh", asset.add_mesh(box)},
                                   {"rotation", {0, 0, 0.38268343, 0.92387953}},
                                   {"translation", {0, 1.8, 0}},
                                   {"scale", {0.6, 0.6, 0.6}}});
  asset.root()["nodes"][parent]["children"] = {asset.root()["nodes"].size() - 1};
  // Two primitives of a mesh, the second with four-byte indices.
  json half = ball;
  std::vector<std::uint32_t> wide(shape.indices.begin(), shape.indices.end());
  const auto middle = static_cast<std::ptrdiff_t>(wide.size() / 6 * 3);
  half["indices"] = asset.file().add_accessor(wide.data(), static_cast<std::size_t>(middle) * 4, 5125, "SCALAR",
                                              static_cast<std::size_t>(middle));
  const std::size_t node = row.add(half);
  half["indices"] = asset.file().add_accessor(&wide[static_cast<std::size_t>(middle)],
                                              wide.size() * 4 - static_cast<std::size_t>(middle) * 4, 5125, "SCALAR",
                                              wide.size() - static_cast<std::size_t>(middle));
  half["material"] = 0;
  asset.root()["meshes"][asset.root()["nodes"][node]["mesh"].get<std::size_t>()]["primitives"].push_back(half);
}

}  // namespace

void make_geometry_asset(const std::string& path) {
  AssetBuilder asset;
  // The first scene is not the one to draw.
  const std::size_t red = asset.add_material({{"pbrMetallicRoughness", {{"baseColorFactor", {0.9, 0.05, 0.05, 1}}}}});
  json wrong = asset.add_shape(make_box());
  wrong["material"] = red;
  asset.add_node({{"name", "of the other scene"}, {"mesh", asset.add_mesh(wrong)}, {"scale", {3, 3, 3}}});
  asset.root()["scenes"].push_back(json::object());
  asset.root()["scene"] = 1;

  const Shape sphere = make_sphere(9, 6, false);
  const json ball = asset.add_shape(sphere);
  Row upper(asset, 1, {0.4, 0.6, 0.8, 1});
  upper.add(ball);
  upper.add(quantized(asset, sphere));
  upper.add(interleaved(asset, sphere));
  json flat = ball;
  flat["attributes"].erase("NORMAL");
  upper.add(flat);
  json loose = {{"attributes", {{"POSITION", asset.add_positions(make_box().positions)}}},
                {"mode", 5}};  // 24 vertices, no indices
  upper.add(loose, {{"rotation", {0.1, 0.3, 0, 0.94868330}}, {"scale", {0.3, 0.3, 0.3}}});
  upper.add(sparse(asset));

  Row lower(asset, -0.2, {0.8, 0.7, 0.3, 1});
  lower.add(fan(asset));
  lower.add(strip(asset));
  add_placed(asset, lower, ball, sphere);
  add_instances(asset, lower.material());

  asset.add_light({{"type", "directional"}, {"intensity", 2.5}}, {2, 3, 4}, {0, 0, 0});
  asset.root()["scenes"].back()["extras"]["background"] = {0.2, 0.22, 0.25};
  asset.add_camera("front", {0, 0.3f, 7.8f}, {0, -0.1f, 0}, 0.5);
  asset.add_orthographic_camera("flat", {2, 3, 5}, {0, -0.2f, 0}, 3.6, 2.025);
  asset.save(path);
}

}  // namespace shoal::test
