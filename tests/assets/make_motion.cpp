// What moves: a skin, morph targets, nodes with each interpolation, a lamp and a camera.
#include "core/math.h"
#include "tests/assets/asset_builder.h"

namespace shoal::test {

using nlohmann::json;

namespace {

std::size_t plain_material(AssetBuilder& asset, double r, double g, double b) {
  return asset.add_material(
      {{"pbrMetallicRoughness", {{"baseColorFactor", {r, g, b, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0.6}}}});
}

class Clip {
 public:
  Clip(AssetBuilder& asset, const std::vector<float>& times) : asset_(asset) {
    input_ = asset.file().add_floats(times, "SCALAR", 1);
    asset.root()["accessors"][input_]["min"] = {times.front()};
    asset.root()["accessors"][input_]["max"] = {times.back()};
    asset.root()["animations"] =
        json::array({json{{"name", "all"}, {"samplers", json::array()}, {"channels", json::array()}}});
  }
  void move(std::size_t node, const char* path, std::size_t output, const char* interpolation) {
    json& animation = asset_.root()["animations"][0];
    animation["samplers"].push_back({{"input", input_}, {"output", output}, {"interpolation", interpolation}});
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size() - 1}, {"target", {{"node", node}, {"path", path}}}});
  }

 private:
  AssetBuilder& asset_;
  std::size_t input_;
};

// A tube of two bones, bent by its upper one; the keys are normalized shorts.
void add_skin(AssetBuilder& asset, Clip& clip) {
  constexpr int kRings = 9, kSides = 8;
  Shape tube;
  std::vector<std::uint8_t> joints, weights;
  for (int ring = 0; ring < kRings; ++ring) {
    for (int side = 0; side < kSides; ++side) {
      float sine, cosine;
      det_sincos(2 * kPi * static_cast<float>(side) / kSides, sine, cosine);
      const float y = static_cast<float>(ring) * 0.25f;
      for (const float v : {0.3f * sine, y, 0.3f * cosine}) tube.positions.push_back(v);
      for (const float v : {sine, 0.0f, cosine}) tube.normals.push_back(v);
      const int upper = ring <= 2 ? 0 : ring >= 6 ? 255 : (ring - 2) * 64 - 1;
      for (const int v : {0, 1, 0, 0}) joints.push_back(static_cast<std::uint8_t>(v));
      for (const int v : {255 - upper, upper, 0, 0}) weights.push_back(static_cast<std::uint8_t>(v));
      if (ring == 0) continue;
      const int a = ring * kSides + side, b = a - kSides, right = side + 1 == kSides ? 1 - kSides : 1;
      for (const int k : {a, b, a + right, a + right, b, b + right})
        tube.indices.push_back(static_cast<std::uint16_t>(k));
    }
  }
  json primitive = asset.add_shape(tube);
  primitive["attributes"]["JOINTS_0"] =
      asset.file().add_accessor(joints.data(), joints.size(), 5121, "VEC4", joints.size() / 4);
  primitive["attributes"]["WEIGHTS_0"] =
      asset.file().add_accessor(weights.data(), weights.size(), 5121, "VEC4", weights.size() / 4, true);
  primitive["material"] = plain_material(asset, 0.3, 0.7, 0.3);
  const std::size_t binds = asset.file().add_floats(
      {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1}, "MAT4", 16);
  json& nodes = asset.root()["nodes"];
  const std::size_t tip = nodes.size();
  nodes.push_back({{"name", "upper bone"}, {"translation", {0, 1, 0}}});
  const std::size_t base = asset.add_node({{"name", "lower bone"}, {"translation", {-2.2, 0, 0}}, {"children", {tip}}});
  asset.root()["skins"] = json::array({json{{"joints", {base, tip}}, {"inverseBindMatrices", binds}}});
  asset.add_node({{"name", "tube"}, {"mesh", asset.add_mesh(primitive)}, {"skin", 0}, {"translation", {5, 5, 5}}});
  const std::int16_t keys[] = {0, 0, 0, 32767, 0, 0, -16384, 28377, 16384, 0, 0, 28377};
  clip.move(tip, "rotation", asset.file().add_accessor(keys, sizeof keys, 5122, "VEC4", 3, true), "LINEAR");
}

// A ball that two targets pull up and to the side.
void add_morph(AssetBuilder& asset, Clip& clip) {
  const Shape ball = make_sphere(10, 7, false);
  std::vector<float> tall, tall_normals, wide;
  for (std::size_t i = 0; i < ball.positions.size(); i += 3) {
    const float y = ball.positions[i + 1], x = ball.positions[i];
    for (const float v : {0.0f, y > 0 ? y * y : 0.0f, 0.0f}) tall.push_back(v);
    for (const float v : {0.0f, y > 0 ? -0.5f * y : 0.0f, 0.0f}) tall_normals.push_back(v);
    for (const float v : {0.7f * x, 0.0f, 0.0f}) wide.push_back(v);
  }
  json primitive = asset.add_shape(ball);
  primitive["targets"] = json::array(
      {json{{"POSITION", asset.add_positions(tall)}, {"NORMAL", asset.file().add_floats(tall_normals, "VEC3", 3)}},
       json{{"POSITION", asset.add_positions(wide)}}});
  primitive["material"] = plain_material(asset, 0.8, 0.4, 0.2);
  const std::size_t mesh = asset.add_mesh(primitive);
  asset.root()["meshes"][mesh]["weights"] = {0.2, 0};
  const std::size_t node =
      asset.add_node({{"mesh", mesh}, {"translation", {-0.9, 0.5, 0}}, {"scale", {0.45, 0.45, 0.45}}});
  // Tangent in, value, tangent out; two weights each.
  clip.move(node, "weights",
            asset.file().add_floats({0, 0, 0, 1, 2, 0, 0, 0, 1, 0, 0, 1, 0, -1, 0.5f, 1, 0, 0}, "SCALAR", 1),
            "CUBICSPLINE");
}

void add_boxes(AssetBuilder& asset, Clip& clip) {
  const json box = asset.add_shape(make_box());
  const auto add_box = [&](double x, double y, double r, double g, double b) {
    json primitive = box;
    primitive["material"] = plain_material(asset, r, g, b);
    return asset.add_node(
        {{"mesh", asset.add_mesh(primitive)}, {"translation", {x, y, 0}}, {"scale", {0.25, 0.25, 0.25}}});
  };
  CraftedFile& file = asset.file();
  const std::size_t step = add_box(0.3, 0.3, 0.8, 0.2, 0.2), turning = add_box(1.2, 0.6, 0.2, 0.4, 0.9),
                    growing = add_box(2.1, 0.4, 0.8, 0.8, 0.2);
  clip.move(step, "translation", file.add_floats({0.3f, 0.3f, 0, 0.3f, 1, 0, 0.3f, 1.6f, 0}, "VEC3", 3), "STEP");
  clip.move(turning, "rotation",
            file.add_floats({0, 0,    0,    0, 0, 0, 0, 1, 0, 0, 0.8f,        0, 0, 0,           0.8f, 0, 0, 0.6f,
                             0, 0.8f, 0.5f, 0, 0, 0, 0, 0, 0, 0, 0.70710678f, 0, 0, 0.70710678f, 0,    0, 0, 0},
                            "VEC4", 4),
            "CUBICSPLINE");
  clip.move(growing, "scale", file.add_floats({0.25f, 0.25f, 0.25f, 0.3f, 0.6f, 0.1f, 0.1f, 0.9f, 0.3f}, "VEC3", 3),
            "LINEAR");
  // A smaller one rides on the one that turns.
  json child = {
      {"mesh", asset.root()["nodes"][growing]["mesh"]}, {"translation", {0, 1.6, 1}}, {"scale", {0.5, 0.5, 0.5}}};
  asset.root()["nodes"].push_back(child);
  asset.root()["nodes"][turning]["children"] = {asset.root()["nodes"].size() - 1};
}

}  // namespace

void make_motion_asset(const std::string& path) {
  AssetBuilder asset;
  Clip clip(asset, {0, 0.5f, 1});
  add_skin(asset, clip);
  add_morph(asset, clip);
  add_boxes(asset, clip);
  json floor = asset.add_shape(make_panel());
  floor["material"] = plain_material(asset, 0.5, 0.5, 0.5);
  asset.add_node(
      {{"mesh", asset.add_mesh(floor)}, {"rotation", {-0.70710678, 0, 0, 0.70710678}}, {"scale", {4, 3, 1}}});

  asset.add_light({{"type", "directional"}, {"intensity", 1.5}}, {2, 5, 3}, {0, 0, 0});
  asset.add_light({{"type", "spot"},
                   {"intensity", 25},
                   {"color", {1, 0.8, 0.5}},
                   {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.35}}}},
                  {0, 3, 2}, {0, 0, 0});
  // What moves has translation, rotation and scale; the lamp looks down along -y then.
  json& lamp = asset.root()["nodes"].back();
  lamp.erase("matrix");
  lamp["translation"] = {0, 3, 1};
  lamp["rotation"] = {-0.70710678, 0, 0, 0.70710678};
  clip.move(asset.root()["nodes"].size() - 1, "translation",
            asset.file().add_floats({-2, 3, 1, 0, 3, 1, 2, 3, 1}, "VEC3", 3), "LINEAR");
  asset.root()["scenes"][0]["extras"]["background"] = {0.25, 0.3, 0.4};
  asset.add_camera("front", {0, 1.6f, 6.5f}, {0, 0.9f, 0}, 0.5);
  asset.root()["cameras"].push_back({{"type", "perspective"}, {"perspective", {{"yfov", 0.6}, {"znear", 0.05}}}});
  const std::size_t rider = asset.add_node({{"name", "rider"}, {"camera", 1}, {"translation", {-2, 1, 5}}});
  clip.move(rider, "translation", asset.file().add_floats({-2, 1, 5, 0, 1.4f, 5, 2, 1, 5}, "VEC3", 3), "LINEAR");
  asset.save(path);
}

}  // namespace shoal::test
