// Two rows of balls and plates, a material each.
#include "tests/assets/asset_builder.h"

namespace shoal::test {

using nlohmann::json;

namespace {

std::vector<std::uint8_t> checker(int size, int cells, std::vector<std::uint8_t> a, std::vector<std::uint8_t> b,
                                  bool with_alpha) {
  return make_picture(size, with_alpha,
                      [&](int x, int y) { return (x * cells / size + y * cells / size) % 2 == 0 ? a : b; });
}

json texture(std::size_t index) { return {{"index", index}}; }

// Materials of the balls, in the order of their places.
std::vector<std::size_t> add_ball_materials(AssetBuilder& asset) {
  const std::size_t bumps = asset.add_texture(make_bump_map(32, 4));
  // Occlusion in red, roughness in green, metalness in blue.
  const std::size_t bands = asset.add_texture(make_picture(16, false, [](int x, int y) {
    return std::vector<std::uint8_t>{static_cast<std::uint8_t>(y % 4 == 0 ? 40 : 255),
                                     static_cast<std::uint8_t>(40 + 12 * x), static_cast<std::uint8_t>(y < 8 ? 255 : 0),
                                     255};
  }));
  const std::size_t glow = asset.add_texture(checker(16, 8, {255, 120, 20, 255}, {0, 0, 0, 255}, false));
  const std::size_t holes = asset.add_texture(checker(16, 8, {40, 160, 60, 255}, {40, 160, 60, 60}, true));
  const auto plain = [](double r, double g, double b, double metallic, double roughness) {
    return json{{"baseColorFactor", {r, g, b, 1}}, {"metallicFactor", metallic}, {"roughnessFactor", roughness}};
  };
  json bumpy = {{"pbrMetallicRoughness", plain(0.7, 0.6, 0.5, 0, 0.4)}, {"normalTexture", texture(bumps)}};
  json strong = bumpy;
  strong["normalTexture"]["scale"] = 1.5;
  json banded = {{"pbrMetallicRoughness",
                  {{"baseColorFactor", {0.9, 0.7, 0.4, 1}}, {"metallicRoughnessTexture", texture(bands)}}}};
  json occluded = {{"pbrMetallicRoughness", plain(0.8, 0.8, 0.8, 0, 0.9)}, {"occlusionTexture", texture(bands)}};
  occluded["occlusionTexture"]["strength"] = 0.75;
  json emissive = {{"pbrMetallicRoughness", plain(0.1, 0.1, 0.1, 0, 1)},
                   {"emissiveFactor", {0.5, 0.5, 1}},
                   {"emissiveTexture", texture(glow)},
                   {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 1.5}}}}}};
  json diamond = {{"pbrMetallicRoughness", plain(0.02, 0.02, 0.02, 0, 0.1)},
                  {"extensions", {{"KHR_materials_ior", {{"ior", 2.4}}}}}};
  json unlit = {{"pbrMetallicRoughness", {{"baseColorTexture", texture(glow)}}},
                {"extensions", {{"KHR_materials_unlit", json::object()}}}};
  json masked = {{"pbrMetallicRoughness", {{"baseColorTexture", texture(holes)}, {"metallicFactor", 0}}},
                 {"alphaMode", "MASK"},
                 {"alphaCutoff", 0.4},
                 {"doubleSided", true}};
  for (const char* name : {"KHR_materials_emissive_strength", "KHR_materials_ior", "KHR_materials_unlit"})
    asset.use_extension(name);
  std::vector<std::size_t> numbers;
  for (const json& material : {bumpy, strong, banded, occluded, emissive, diamond,
                               json{{"pbrMetallicRoughness", plain(0.95, 0.93, 0.88, 1, 0.15)}}, unlit, masked}) {
    numbers.push_back(asset.add_material(material));
  }
  return numbers;
}

// A box with colours at its vertices: RGBA bytes, or RGB floats.
void add_coloured_box(AssetBuilder& asset, bool bytes, double x, double y) {
  json primitive = asset.add_shape(make_box());
  std::vector<std::uint8_t> rgba;
  std::vector<float> rgb;
  for (int i = 0; i < 24; ++i) {
    for (int c = 0; c < 3; ++c) {
      const bool on = (i % 4 + 1) >> c & 1;
      rgba.push_back(on ? 255 : 30);
      rgb.push_back(on ? 1.0f : 0.02f);
    }
    rgba.push_back(255);
  }
  primitive["attributes"]["COLOR_0"] = bytes
                                           ? asset.file().add_accessor(rgba.data(), rgba.size(), 5121, "VEC4", 24, true)
                                           : asset.file().add_floats(rgb, "VEC3", 3);
  primitive["material"] =
      asset.add_material({{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.8}}}});
  asset.add_node(
      {{"mesh", asset.add_mesh(primitive)},
       {"translation", {x, y, 0}},
       {"rotation", {0.16317591, 0.33682409, 0.05939117, 0.92541658}},  // 40 degrees about y, then 20 about x
       {"scale", {0.35, 0.35, 0.35}}});
}

}  // namespace

void make_materials_asset(const std::string& path) {
  AssetBuilder asset;
  const json tangents = asset.add_shape(make_sphere(14, 9, true));
  json ball = tangents;
  ball["attributes"].erase("TANGENT");
  const std::vector<std::size_t> materials = add_ball_materials(asset);
  for (std::size_t i = 0; i <= materials.size(); ++i) {
    // The second ball brings its tangents; the last is the first one's mirror image.
    json primitive = i == 1 ? tangents : ball;
    primitive["material"] = materials[i % materials.size()];
    const double mirror = i == materials.size() ? -1 : 1;
    asset.add_node({{"mesh", asset.add_mesh(primitive)},
                    {"translation", {-2.0 + static_cast<double>(i % 5), i < 5 ? 1.0 : 0.0, 0}},
                    {"scale", {0.42 * mirror, 0.42, 0.42}}});
  }
  add_coloured_box(asset, true, -2.95, 1);
  add_coloured_box(asset, false, -2.95, 0);

  // Plates seen from behind: the first is seen, the second is not.
  json plate = asset.add_shape(make_panel());
  for (const bool double_sided : {true, false}) {
    plate["material"] = asset.add_material(
        {{"doubleSided", double_sided},
         {"normalTexture", texture(0)},
         {"pbrMetallicRoughness", {{"baseColorFactor", {0.3, 0.5, 0.9, 1}}, {"metallicFactor", 0}}}});
    asset.add_node({{"mesh", asset.add_mesh(plate)},
                    {"translation", {3, double_sided ? 1 : 0, 0}},
                    {"rotation", {0, 0.97629601, 0, 0.21643961}},  // 155 degrees about y
                    {"scale", {0.38, 0.38, 0.38}}});
  }
  json floor = asset.add_shape(make_panel());
  floor["material"] = asset.add_material(
      {{"pbrMetallicRoughness", {{"baseColorFactor", {0.35, 0.35, 0.35, 1}}, {"metallicFactor", 0}}}});
  asset.add_node({{"mesh", asset.add_mesh(floor)},
                  {"translation", {0, -0.5, 0}},
                  {"rotation", {-0.70710678, 0, 0, 0.70710678}},
                  {"scale", {4, 1.5, 1}}});

  asset.add_light({{"type", "directional"}, {"intensity", 2.5}, {"color", {1, 0.95, 0.85}}}, {1.5f, 3, 3}, {0, 0, 0});
  asset.root()["scenes"][0]["extras"]["background"] = "sky";
  asset.add_camera("front", {0, 0.9f, 7.8f}, {0, 0.45f, 0}, 0.5);
  asset.save(path);
}

}  // namespace shoal::test
