// Two bodies of water, lamps of each kind over, in and beside them.
#include "tests/assets/asset_builder.h"

namespace shoal::test {

using nlohmann::json;

namespace {

json plain(double r, double g, double b, double roughness) {
  return {{"pbrMetallicRoughness",
           {{"baseColorFactor", {r, g, b, 1}}, {"metallicFactor", 0}, {"roughnessFactor", roughness}}}};
}

// A basin of 4 x 3 m, 1 m deep, tiled, seen from inside and outside.
void add_basin(AssetBuilder& asset) {
  const std::size_t tiles = asset.add_texture(make_picture(16, false, [](int x, int y) {
    return x % 8 == 0 || y % 8 == 0
               ? std::vector<std::uint8_t>{90, 100, 110, 255}
               : std::vector<std::uint8_t>{static_cast<std::uint8_t>(x < 8 ? 200 : 160), 215, 220, 255};
  }));
  json wall = asset.add_shape(make_panel(3));
  json tiled = plain(1, 1, 1, 0.6);
  tiled["pbrMetallicRoughness"]["baseColorTexture"]["index"] = tiles;
  tiled["doubleSided"] = true;
  wall["material"] = asset.add_material(tiled);
  const std::size_t mesh = asset.add_mesh(wall);
  constexpr double kHalf = 0.70710678;
  const auto place = [&](json translation, json rotation, json scale) {
    asset.add_node({{"mesh", mesh},
                    {"translation", std::move(translation)},
                    {"rotation", std::move(rotation)},
                    {"scale", std::move(scale)}});
  };
  place({0, -1, 0}, {-kHalf, 0, 0, kHalf}, {2, 1.5, 1});
  place({0, -0.4, -1.5}, {0, 0, 0, 1}, {2, 0.6, 1});
  place({0, -0.4, 1.5}, {0, 1, 0, 0}, {2, 0.6, 1});
  place({-2, -0.4, 0}, {0, kHalf, 0, kHalf}, {1.5, 0.6, 1});
  place({2, -0.4, 0}, {0, -kHalf, 0, kHalf}, {1.5, 0.6, 1});
}

void add_water(AssetBuilder& asset) {
  asset.add_node(
      {{"name", "basin's water"},
       {"extras", {{"water", {{"size", {4, 3}}, {"depth", 1}, {"ior", 1.333}, {"absorption", {0.6, 0.15, 0.1}}}}}}});
  // A tub higher up, the outline a mesh, by flat keys as Blender's custom properties are.
  json outline = {{"attributes",
                   {{"POSITION", asset.add_positions({0.7f, 0, 0, 0.35f, 0, -0.6f, -0.35f, 0, -0.6f, -0.7f, 0, 0,
                                                      -0.35f, 0, 0.6f, 0.35f, 0, 0.6f})}}},
                  {"indices", asset.add_indices({0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5})}};
  asset.add_node({{"name", "tub's water"},
                  {"mesh", asset.add_mesh(outline)},
                  {"translation", {2.9, 0.45, 0.2}},
                  {"extras", {{"water_depth", 0.4}, {"water_ior", 1.5}, {"water_absorption", {2, 0.4, 1.5}}}}});
  json bottom = asset.add_shape(make_panel());
  bottom["material"] = asset.add_material(plain(0.8, 0.75, 0.7, 0.9));
  asset.add_node({{"mesh", asset.add_mesh(bottom)},
                  {"translation", {2.9, 0.05, 0.2}},
                  {"rotation", {-0.70710678, 0, 0, 0.70710678}},
                  {"scale", {0.8, 0.7, 1}}});
}

}  // namespace

void make_water_asset(const std::string& path) {
  AssetBuilder asset;
  add_basin(asset);
  json ball = asset.add_shape(make_sphere(14, 9, false));
  const double places[][4] = {
      {-1.2, -0.7, -0.4, 0.3}, {0.1, -0.05, -0.5, 0.35}, {1.1, -0.75, 0.4, 0.25}, {2.9, 0.4, 0.1, 0.2}};
  for (const auto& place : places) {
    ball["material"] = asset.add_material(plain(0.6 - 0.2 * place[0], 0.35 + 0.15 * place[0], 0.35, 0.4));
    asset.add_node({{"mesh", asset.add_mesh(ball)},
                    {"translation", {place[0], place[1], place[2]}},
                    {"scale", {place[3], place[3], place[3]}}});
  }
  add_water(asset);
  asset.add_light({{"type", "directional"}, {"intensity", 1.2}}, {-1, 3, 2}, {0, 0, 0});
  asset.add_light({{"type", "point"}, {"intensity", 0.4}, {"color", {1, 0.7, 0.4}}, {"range", 3}}, {-1.7f, -0.6f, 1},
                  {0, -1, 0});
  asset.add_light({{"type", "spot"},
                   {"intensity", 12},
                   {"color", {0.6, 0.8, 1}},
                   {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.4}}}},
                  {0.8f, 2, 1.2f}, {0.8f, -1, 0});
  asset.root()["scenes"][0]["extras"]["background"] = {
      {"type", "sky"}, {"zenith", {0.1, 0.2, 0.4}}, {"horizon", {0.5, 0.6, 0.7}}, {"ground", {0.2, 0.2, 0.2}}};
  asset.add_camera("above", {0.6f, 3.2f, 3.8f}, {0.7f, -0.3f, 0}, 0.75);
  asset.add_camera("under", {-1.5f, -0.6f, 1.2f}, {0.8f, -0.3f, -0.6f}, 1);
  asset.add_orthographic_camera("flat", {0.5f, 3, 4}, {0.5f, -0.3f, 0}, 3.2, 1.8);
  asset.save(path);
}

}  // namespace shoal::test
