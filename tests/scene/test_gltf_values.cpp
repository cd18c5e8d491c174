// Values of extras that were read as something else without a word, and valid files that the JSON library's model
// leaves out or refuses. Source: glTF 2.0 specification, 3.6.2.1, 3.7.3.1 and 4.4.
#include <catch2/catch.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "scene/gltf/gltf.h"
#include "tests/scene/bad_files.h"

namespace shoal::test {
namespace {

using nlohmann::json;

Scene load(const CraftedFile& file) {
  const TemporaryFolder folder;
  return load_gltf(file.save_glb(folder / "scene.glb"));
}

json& water_extras(CraftedFile& file) { return file.root["nodes"][3]["extras"]; }

// "perlin+perlin+..."
std::string sum_of(int count) {
  std::string text = "perlin";
  for (int i = 1; i < count; ++i) text += "+perlin";
  return text;
}

}  // namespace

TEST_CASE("gltf: a value of the wrong kind is an error that names it", "[gltf]") {
  const auto message = [](const char* key, const json& value) {
    CraftedFile file = good_file();
    water_extras(file)[key] = value;
    return error_of(file);
  };
  const auto surface = [&](const json& value) { return message("water", json{{"size", {4, 3}}, {"surface", value}}); };
  using Catch::Matchers::Contains;
  CHECK_THAT(message("water", 5), Contains("nodes[3].extras.water is a number; expected an object, true or false"));
  CHECK_THAT(message("water", nullptr), Contains("extras.water is wrong; expected an object"));
  CHECK_THAT(message("water", json::array()), Contains("extras.water is wrong; expected an object"));
  CHECK_THAT(message("water", json{{"size", nullptr}}), Contains("water.size is wrong; expected [x, z]"));
  CHECK_THAT(message("water_ior", json::object()), Contains("water_ior is wrong; expected a number"));
  CHECK_THAT(surface({{"parts", json::array()}}), Contains("surface.parts is wrong; expected a list of 1 to 16"));
  CHECK_THAT(surface({{"type", "perlin"}, {"parts", {{{"type", "gerstner"}}}}}), Contains("has a type and parts"));
  for (const json& value : {json::object(), json(nullptr), json(5)}) {
    CraftedFile file = good_file();
    file.root["scenes"][0]["extras"]["environment"] = value;
    CHECK_THAT(error_of(file), Contains("extras.environment is wrong; expected the URI"));
  }
}

TEST_CASE("gltf: a sum of surfaces has at most 16 parts in each form", "[gltf]") {
  const auto with = [](const json& surface) {
    CraftedFile file = good_file();
    water_extras(file)["water"]["surface"] = surface;
    return error_of(file);
  };
  json parts = json::array();
  for (int i = 0; i < 16; ++i) parts.push_back({{"type", "perlin"}});
  CHECK(with(sum_of(16)) == "loaded");
  CHECK(with({{"type", sum_of(16)}}) == "loaded");
  CHECK(with({{"parts", parts}}) == "loaded");
  parts.push_back({{"type", "perlin"}});
  using Catch::Matchers::Contains;
  CHECK_THAT(with(sum_of(17)), Contains("is a sum of more than 16 surfaces; expected at most 16"));
  CHECK_THAT(with({{"type", sum_of(2000)}}), Contains("is a sum of more than 16 surfaces; expected at most 16"));
  CHECK_THAT(with({{"parts", parts}}), Contains("expected a list of 1 to 16 surfaces"));
}

TEST_CASE("gltf: a spectrum's grid that is no power of two is one warning", "[gltf]") {
  for (const int grid : {0, 16, 128, 512}) {
    CraftedFile file = good_file();
    water_extras(file)["water"]["surface"] = {{"type", "spectrum"}, {"grid", grid}};
    CHECK(load(file).warnings.empty());
  }
  for (const auto& [grid, used] : {std::pair(100, "64"), std::pair(2, "16"), std::pair(1024, "512")}) {
    CraftedFile file = good_file();
    water_extras(file)["water"]["surface"] = {{"type", "spectrum"}, {"grid", grid}};
    const Scene scene = load(file);
    REQUIRE(scene.warnings.size() == 1);
    CHECK_THAT(scene.warnings[0], Catch::Matchers::Contains("a grid of " + std::to_string(grid)) &&
                                      Catch::Matchers::EndsWith(std::string("512: ") + used + " is used"));
  }
}

TEST_CASE("gltf: an empty object on a planar mesh is water with all defaults", "[gltf]") {
  CraftedFile file = good_file();
  file.root["nodes"][0]["extras"]["water"] = json::object();
  const Scene empty = load(file);
  file.root["nodes"][0]["extras"]["water"] = true;
  const Scene yes = load(file);
  REQUIRE(empty.waters.size() == 2);
  REQUIRE(yes.waters.size() == 2);
  CHECK(empty.nodes[0].water != kNoIndex);
  CHECK_FALSE(empty.waters[0].has_size);
  CHECK(empty.waters[0].ior == yes.waters[0].ior);
  CHECK(empty.waters[0].surface.kind == SurfaceKind::kFlat);
}

TEST_CASE("gltf: indices without bufferView are zeros, and a sparse part replaces some of them", "[gltf]") {
  CraftedFile file = good_file();
  const std::uint8_t elements[] = {1, 2};
  const std::uint16_t values[] = {2, 1};
  const std::size_t at = file.add_view(elements, sizeof elements), with = file.add_view(values, sizeof values);
  json& indices = file.root["accessors"][file.root["meshes"][0]["primitives"][0]["indices"].get<std::size_t>()];
  indices = {{"componentType", 5123}, {"type", "SCALAR"}, {"count", 3}};
  indices["sparse"] = {
      {"count", 2}, {"indices", {{"bufferView", at}, {"componentType", 5121}}}, {"values", {{"bufferView", with}}}};
  CHECK(load(file).meshes[0].primitives[0].indices == std::vector<std::uint32_t>{0, 2, 1});
  indices["sparse"]["values"]["bufferView"] = at;
  CHECK_THAT(error_of(file), Catch::Matchers::Contains("sparse.values needs 4 bytes"));
  indices.erase("sparse");
  CHECK(load(file).meshes[0].primitives[0].indices == std::vector<std::uint32_t>{0, 0, 0});
}

TEST_CASE("gltf: materials count towards the limits", "[gltf]") {
  CraftedFile file = good_file();
  for (int i = 0; i < 999; ++i) file.root["materials"].push_back(json::object());
  CHECK(error_of(file) == "loaded");
  LoadLimits limits;
  limits.max_scene_bytes = 1000000;
  CHECK_THAT(error_of(file, limits), Catch::Matchers::Contains("list of 1000 materials brings the scene over"));
  limits = {};
  limits.max_materials = 999;
  CHECK_THAT(error_of(file, limits), Catch::Matchers::Contains("has 1000 materials; expected at most 999"));
  // Written as text: two million of them are a file of 6 MB.
  const TemporaryFolder folder;
  std::string text = R"({"asset": {"version": "2.0"}, "scenes": [{}], "materials": [{})";
  for (int i = 1; i < 2000000; ++i) text += ",{}";
  write_file(folder / "many.gltf", text + "]}");
  CHECK_THROWS_WITH(load_gltf(folder / "many.gltf"), Catch::Matchers::Contains("has 2000000 materials"));
}

TEST_CASE("gltf: a skin without inverseBindMatrices has identities", "[gltf]") {
  CraftedFile file = good_file();
  const std::vector<std::uint8_t> joints(12, 0);
  json& attributes = file.root["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = file.add_accessor(joints.data(), joints.size(), 5121, "VEC4", 3);
  attributes["WEIGHTS_0"] = file.add_floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4);
  file.root["skins"] = json::array({json{{"joints", {1}}}});
  file.root["nodes"][0]["skin"] = 0;
  const Scene scene = load(file);
  REQUIRE(scene.skins.size() == 1);
  REQUIRE(scene.skins[0].joint_from_mesh.size() == 1);
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) CHECK(scene.skins[0].joint_from_mesh[0][c][r] == (c == r ? 1.0f : 0.0f));
  }
}

TEST_CASE("gltf: integer colours that are not normalized are read as normalized, with a warning", "[gltf]") {
  const std::vector<std::uint8_t> bytes = {255, 0, 51, 255, 0, 0, 0, 0, 255, 255, 255, 102};
  for (const bool normalized : {false, true}) {
    CraftedFile file = good_file();
    file.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
        file.add_accessor(bytes.data(), bytes.size(), 5121, "VEC4", 3, normalized);
    const Scene scene = load(file);
    CHECK(scene.warnings.size() == (normalized ? 0u : 1u));
    const auto& colors = scene.meshes[0].primitives[0].colors;
    REQUIRE(colors.size() == 3);
    CHECK(colors[0].x == 1.0f);
    CHECK(colors[0].z == 0.2f);
    CHECK(colors[2].w == 0.4f);
  }
}

TEST_CASE("gltf: a .glb whose JSON chunk is not padded is read", "[gltf]") {
  const TemporaryFolder folder;
  CraftedFile file = good_file();
  int unpadded = 0;
  for (int extra = 0; extra < 4; ++extra) {
    file.root["asset"]["generator"] = std::string(static_cast<std::size_t>(extra), 'x');
    std::vector<std::uint8_t> glb = file.glb();
    // Remove the spaces after the JSON text, and correct both lengths.
    const auto u32 = [&](std::size_t at) {
      return glb[at] | glb[at + 1] << 8 | glb[at + 2] << 16 | static_cast<int>(glb[at + 3]) << 24;
    };
    const auto set = [&](std::size_t at, int value) {
      for (int i = 0; i < 4; ++i) glb[at + static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(value >> (8 * i));
    };
    int length = u32(12), removed = 0;
    while (glb[static_cast<std::size_t>(19 + length)] == ' ') {
      glb.erase(glb.begin() + 19 + length);
      --length;
      ++removed;
    }
    set(12, length);
    set(8, u32(8) - removed);
    unpadded += removed != 0;
    write_file(folder / "unpadded.glb", glb);
    CHECK(load_gltf(folder / "unpadded.glb").meshes[0].primitives[0].indices.size() == 3);
  }
  CHECK(unpadded >= 3);
}

TEST_CASE("gltf: data in a compressed form alone name their compression", "[gltf]") {
  CraftedFile draco = good_file();
  json& primitive = draco.root["meshes"][0]["primitives"][0];
  primitive["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0}, {"attributes", {{"POSITION", 0}}}};
  CHECK(error_of(draco) == "loaded");  // with fallback data
  draco.root["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()].erase("bufferView");
  CHECK_THAT(error_of(draco), Catch::Matchers::Contains("compressed by KHR_draco_mesh_compression"));
  CraftedFile meshopt = good_file();
  meshopt.root["buffers"].push_back(
      {{"byteLength", 64}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
  CHECK_THAT(error_of(meshopt), Catch::Matchers::Contains("compressed by EXT_meshopt_compression"));
}

TEST_CASE("gltf: a Git LFS pointer is named as one", "[gltf]") {
  const TemporaryFolder folder;
  const std::string pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 12345\n";
  write_file(folder / "scene.gltf", pointer);
  CHECK_THROWS_WITH(load_gltf(folder / "scene.gltf"), Catch::Matchers::Contains("scene.gltf: is a Git LFS pointer"));
  CraftedFile file = good_file();
  write_file(folder / "data.bin", pointer);
  file.root["buffers"][0]["uri"] = "data.bin";
  CHECK_THROWS_WITH(load_gltf(file.save_gltf(folder / "with_bin.gltf")),
                    Catch::Matchers::Contains("data.bin is a Git LFS pointer"));
}

}  // namespace shoal::test
