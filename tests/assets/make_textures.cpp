// Panels with a picture that shows which way it lies, each read in another way, over a floor that shows the mips.
#include "tests/assets/asset_builder.h"

namespace shoal::test {

using nlohmann::json;

namespace {

constexpr int kNearest = 9728, kLinear = 9729, kNearestMipNearest = 9984, kLinearMipLinear = 9987;
constexpr int kRepeat = 10497, kMirror = 33648, kClamp = 33071;

// Red, green, blue and yellow quarters, the first at the top left, and a white stroke from the top left down.
std::vector<std::uint8_t> quarter_color(int x, int y, int size) {
  if (x == y && x < size / 2) return {255, 255, 255, 255};
  const bool right = x >= size / 2, low = y >= size / 2;
  return {static_cast<std::uint8_t>(right == low ? 220 : 20), static_cast<std::uint8_t>(right ? 200 : 40),
          static_cast<std::uint8_t>(low && !right ? 230 : 30), 255};
}

json sampler(int magnify, int minify, int wrap_s, int wrap_t) {
  return {{"magFilter", magnify}, {"minFilter", minify}, {"wrapS", wrap_s}, {"wrapT", wrap_t}};
}
json transform(json offset, double rotation, json scale) {
  return {
      {"KHR_texture_transform", {{"offset", std::move(offset)}, {"rotation", rotation}, {"scale", std::move(scale)}}}};
}

class Panels {
 public:
  explicit Panels(AssetBuilder& asset) : asset_(asset) {
    asset_.use_extension("KHR_materials_unlit");
    asset_.use_extension("KHR_texture_transform");
  }
  // The next place, left to right and down. Without a light the texture's colours come out as they went in.
  void add(json primitive, json base_color_texture, json more = json::object()) {
    json material = {
        {"pbrMetallicRoughness", {{"baseColorTexture", std::move(base_color_texture)}, {"metallicFactor", 0}}}};
    if (more.empty() || more.contains("alphaMode")) material["extensions"]["KHR_materials_unlit"] = json::object();
    material.update(more);
    primitive["material"] = asset_.add_material(material);
    asset_.add_node({{"mesh", asset_.add_mesh(std::move(primitive))},
                     {"translation", {-2.25 + 0.9 * (count_ % 6), 1.5 - 0.9 * (count_ / 6), 0}},
                     {"scale", {0.4, 0.4, 0.4}}});
    ++count_;
  }

 private:
  AssetBuilder& asset_;
  int count_ = 0;
};

void add_sampler_panels(AssetBuilder& asset, Panels& panels, const std::vector<std::uint8_t>& quarters) {
  const json twice = asset.add_shape(make_panel(2)), thrice = asset.add_shape(make_panel(3));
  const std::size_t nearest = asset.add_texture(quarters, sampler(kNearest, kNearest, kRepeat, kRepeat));
  const std::size_t mirror = asset.add_texture(quarters, sampler(kLinear, kLinear, kMirror, kMirror));
  const std::size_t clamp = asset.add_texture(quarters, sampler(kLinear, kLinearMipLinear, kClamp, kClamp));
  const std::size_t mixed = asset.add_texture(quarters, sampler(kNearest, kLinear, kClamp, kMirror));
  const std::size_t plain = asset.add_texture(quarters);
  panels.add(twice, {{"index", nearest}});
  panels.add(thrice, {{"index", mirror}});
  panels.add(twice, {{"index", clamp}, {"extensions", transform({-0.5, -0.5}, 0, {1, 1})}});
  panels.add(thrice, {{"index", mixed}, {"extensions", transform({-1, 0}, 0, {1, 1})}});
  panels.add(twice, {{"index", plain}});
  panels.add(twice, {{"index", clamp}, {"extensions", transform({-0.6, 0.3}, 0.6, {0.8, 1.1})}});
}

void add_coordinate_panels(AssetBuilder& asset, Panels& panels) {
  // The second set of coordinates is the first one turned upside down.
  const Shape panel = make_panel();
  json both = asset.add_shape(panel);
  std::vector<float> turned;
  for (const float value : panel.uvs) turned.push_back(1 - value);
  both["attributes"]["TEXCOORD_1"] = asset.file().add_floats(turned, "VEC2", 2);
  panels.add(both, {{"index", 0}, {"texCoord", 1}},
             {{"emissiveTexture", {{"index", 0}}}, {"emissiveFactor", {0.4, 0.4, 0.4}}});
  json moved = {{"index", 0}, {"extensions", transform({0.25, 0}, 0, {1, 1})}};
  moved["extensions"]["KHR_texture_transform"]["texCoord"] = 1;
  panels.add(both, moved);

  // Bytes and shorts, normalized: a quarter of the picture and all of it.
  json bytes = asset.add_shape(panel), shorts = bytes;
  const std::uint8_t quarter[] = {0, 0, 0, 0, 128, 0, 0, 0, 0, 128, 0, 0, 128, 128, 0, 0};
  bytes["attributes"]["TEXCOORD_0"] = asset.file().root["accessors"].size();
  asset.file().root["accessors"].push_back({{"bufferView", asset.file().add_view(quarter, sizeof quarter, 4)},
                                            {"componentType", 5121},
                                            {"normalized", true},
                                            {"type", "VEC2"},
                                            {"count", 4}});
  const std::uint16_t whole[] = {0, 0, 65535, 0, 0, 65535, 65535, 65535};
  shorts["attributes"]["TEXCOORD_0"] = asset.file().add_accessor(whole, sizeof whole, 5123, "VEC2", 4, true);
  panels.add(bytes, {{"index", 0}});
  panels.add(shorts, {{"index", 0}});
}

void add_format_panels(AssetBuilder& asset, Panels& panels) {
  const json panel = asset.add_shape(make_panel());
  std::vector<std::uint8_t> grey_alpha, deep;
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      grey_alpha.push_back(static_cast<std::uint8_t>(30 * y));
      grey_alpha.push_back(static_cast<std::uint8_t>(36 * x));
      for (const int value : {8192 * x, 8192 * y, 20000}) {  // 16 bits, the high byte first
        deep.push_back(static_cast<std::uint8_t>(value >> 8));
        deep.push_back(static_cast<std::uint8_t>(value & 255));
      }
    }
  }
  const std::size_t masked =
      asset.add_texture(png(8, 8, 4, 8, grey_alpha), sampler(kNearest, kNearest, kClamp, kClamp));
  const std::size_t sixteen = asset.add_texture(png(8, 8, 2, 16, deep), sampler(kNearest, kNearest, kClamp, kClamp));
  panels.add(panel, {{"index", masked}}, {{"alphaMode", "MASK"}});
  panels.add(panel, {{"index", sixteen}});
}

}  // namespace

void make_textures_asset(const std::string& path) {
  AssetBuilder asset;
  Panels panels(asset);
  add_sampler_panels(asset, panels, make_picture(8, false, [](int x, int y) { return quarter_color(x, y, 8); }));
  add_coordinate_panels(asset, panels);
  add_format_panels(asset, panels);

  // Two floors of fine squares: all filters linear, and all nearest.
  const std::vector<std::uint8_t> squares = make_picture(32, false, [](int x, int y) {
    return (x / 4 + y / 4) % 2 == 0 ? std::vector<std::uint8_t>{230, 220, 200, 255}
                                    : std::vector<std::uint8_t>{30, 60, 90, 255};
  });
  json floor = asset.add_shape(make_panel(6));
  for (const bool smooth : {true, false}) {
    const std::size_t texture =
        asset.add_texture(squares, smooth ? sampler(kLinear, kLinearMipLinear, kRepeat, kRepeat)
                                          : sampler(kNearest, kNearestMipNearest, kRepeat, kMirror));
    floor["material"] = asset.add_material(
        {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}, {"metallicFactor", 0}}}});
    asset.add_node({{"mesh", asset.add_mesh(floor)},
                    {"translation", {smooth ? -3 : 3, -0.4, 0}},
                    {"rotation", {-0.70710678, 0, 0, 0.70710678}},
                    {"scale", {3, 4, 1}}});
  }
  asset.root()["scenes"][0]["extras"]["background"] = {0.05, 0.06, 0.08};
  asset.add_camera("front", {0, 1.05f, 6.4f}, {0, 0.75f, 0}, 0.5);
  asset.add_camera("low", {-3.5f, 0.15f, 4.5f}, {0, 0.5f, 0}, 0.8);
  asset.save(path);
}

}  // namespace shoal::test
