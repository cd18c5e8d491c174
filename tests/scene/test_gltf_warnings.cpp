// Content of a file that is ignored or read differently: it gives one warning, and the rest of the scene is unchanged.
// docs/gltf.md lists it.
#include <catch2/catch.hpp>
#include <functional>
#include <string>

#include "core/error.h"
#include "scene/gltf/gltf.h"
#include "tests/scene/bad_files.h"

namespace shoal::test {
namespace {

using nlohmann::json;

struct Recipe {
  const char* name;
  const char* warning;
  std::function<void(CraftedFile&)> mutate;
};

json& material(CraftedFile& f) { return f.root["materials"][0]; }
json& primitive(CraftedFile& f) { return f.root["meshes"][0]["primitives"][0]; }

std::vector<Recipe> material_recipes() {
  return {
      {"factor", "some materials have a roughness factor outside of 0 to 1: clamped",
       [](CraftedFile& f) { material(f)["pbrMetallicRoughness"]["roughnessFactor"] = 1.5; }},
      {"ior", "some materials have an ior that is neither 0 nor from 1 on: clamped",
       [](CraftedFile& f) { material(f)["extensions"]["KHR_materials_ior"]["ior"] = 0.5; }},
      {"third_set",
       "some materials use more than two sets of texture coordinates: the third and on are taken for the first",
       [](CraftedFile& f) {
         material(f)["normalTexture"] = {{"index", 0}, {"texCoord", 1}};
         material(f)["occlusionTexture"] = {{"index", 0}, {"texCoord", 2}};
       }},
      {"material_extension", "extension KHR_materials_transmission is not read yet",
       [](CraftedFile& f) { material(f)["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 1; }},
      {"basisu", "some textures have no image that can be read: their materials go without them",
       [](CraftedFile& f) {
         f.root["textures"][0] = {{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}};
       }},
      {"webp", "extension EXT_texture_webp is not read yet",
       [](CraftedFile& f) { f.root["extensionsUsed"].push_back("EXT_texture_webp"); }},
  };
}

std::vector<Recipe> mesh_recipes() {
  return {
      {"points", "points are not drawn",
       [](CraftedFile& f) {
         f.root["meshes"][0]["primitives"].push_back(primitive(f));
         f.root["meshes"][0]["primitives"][1]["mode"] = 0;
       }},
      {"lines", "lines are not drawn",
       [](CraftedFile& f) {
         f.root["meshes"][0]["primitives"].push_back(primitive(f));
         f.root["meshes"][0]["primitives"][1]["mode"] = 3;
       }},
      {"no_positions", "primitives without POSITION are not drawn",
       [](CraftedFile& f) {
         f.root["meshes"][0]["primitives"].push_back({{"attributes", json::object()}});
       }},
      {"attribute", "vertex attribute COLOR_1 is not read yet",
       [](CraftedFile& f) { primitive(f)["attributes"]["COLOR_1"] = 1; }},
      {"target", "morph targets of COLOR_0 are not read yet",
       [](CraftedFile& f) {
         primitive(f)["targets"].push_back({{"COLOR_0", 1}});
       }},
      {"normal", "some normals have no length: +y is used for them",
       [](CraftedFile& f) { std::fill_n(f.bin.begin() + 36, 12, std::uint8_t{0}); }},
      {"tangent", "some tangents have no length: +x is used for them",
       [](CraftedFile& f) {
         material(f)["normalTexture"] = {{"index", 0}};
         primitive(f)["attributes"]["TANGENT"] = f.add_floats(std::vector<float>(12, 0.0f), "VEC4", 4);
       }},
  };
}

std::vector<Recipe> scene_recipes() {
  return {
      {"scenes", "scenes other than scenes[0] are not drawn",
       [](CraftedFile& f) {
         f.root["scenes"].push_back({{"nodes", {0}}});
       }},
      {"node_extension", "extension MSFT_lod is not read yet",
       [](CraftedFile& f) { f.root["nodes"][0]["extensions"]["MSFT_lod"]["ids"] = {1}; }},
      {"instancing", "EXT_mesh_gpu_instancing without TRANSLATION, ROTATION and SCALE is not read: drawn once",
       [](CraftedFile& f) {
         f.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"_ID", 0}};
       }},
      {"weights", "animation channels of weights without morph targets are not read",
       [](CraftedFile& f) {
         const std::size_t keys = f.add_floats({0, 1}, "SCALAR", 1);
         f.root["animations"] =
             json::array({json{{"samplers", {{{"input", keys}, {"output", keys}}}},
                               {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}}});
       }},
      {"extras", "extras key 'water_colour' is not known",
       [](CraftedFile& f) { f.root["nodes"][3]["extras"]["water_colour"] = 1; }},
      {"surface", "water surface key 'hight' is not known",
       [](CraftedFile& f) {
         f.root["nodes"][3]["extras"]["water"]["surface"] = {{"type", "flat"}, {"hight", 1}};
       }},
  };
}

}  // namespace

TEST_CASE("gltf: what is left out or read otherwise is one warning", "[gltf]") {
  const TemporaryFolder folder;
  for (const auto& recipes : {material_recipes(), mesh_recipes(), scene_recipes()}) {
    for (const Recipe& recipe : recipes) {
      CAPTURE(recipe.name);
      CraftedFile file = good_file();
      recipe.mutate(file);
      const Scene scene = load_gltf(file.save_glb(folder / (std::string(recipe.name) + ".glb")));
      REQUIRE(scene.warnings.size() == 1);
      CHECK(scene.warnings[0] == recipe.warning);
      REQUIRE(scene.meshes.size() == 1);
      REQUIRE(scene.meshes[0].primitives.size() == 1);
      CHECK(scene.meshes[0].primitives[0].indices.size() == 3);
      CHECK_NOTHROW(build_render_scene(scene));
    }
  }
}

// Specification, 3.12: a loader ignores an extension that it does not support, unless the file requires it.
TEST_CASE("gltf: an unsupported extension is refused only where the file requires it", "[gltf]") {
  const TemporaryFolder folder;
  for (const char* name : {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_texture_basisu"}) {
    CraftedFile file = good_file();
    file.root["extensionsUsed"].push_back(name);
    const Scene scene = load_gltf(file.save_glb(folder / "used.glb"));
    REQUIRE(scene.warnings.size() == 1);
    CHECK(scene.warnings[0] == std::string("extension ") + name + " is not read yet");
    file.root["extensionsRequired"] = {name};
    CHECK_THROWS_WITH(load_gltf(file.save_glb(folder / "required.glb")),
                      Catch::Matchers::Contains(std::string("requires ") + name + "; expected none but EXT_mesh"));
  }
}

}  // namespace shoal::test
