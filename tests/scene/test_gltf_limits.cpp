// Small files with large sizes: a limit refuses them before memory is allocated.
#include <catch2/catch.hpp>
#include <string>

#include "core/error.h"
#include "scene/gltf/gltf.h"
#include "tests/scene/bad_files.h"

namespace shoal::test {
namespace {

using nlohmann::json;

// An accessor without bytes in the file: zeros.
std::size_t add_zeros(CraftedFile& file, const char* type, std::uint64_t count) {
  file.root["accessors"].push_back({{"componentType", 5126}, {"type", type}, {"count", count}});
  return file.root["accessors"].size() - 1;
}

// good_file(), its mesh's node with that many instances, all in one place.
CraftedFile instanced_file(std::uint64_t count) {
  CraftedFile file = good_file();
  const std::size_t places = add_zeros(file, "VEC3", count);
  file.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = {{"attributes", {{"TRANSLATION", places}}}};
  return file;
}

LoadLimits of_memory(std::uint64_t bytes) {
  LoadLimits limits;
  limits.max_scene_bytes = bytes;
  return limits;
}

}  // namespace

TEST_CASE("gltf: accessors without bytes have a limit of elements", "[gltf]") {
  CraftedFile file = good_file();
  const std::size_t view = file.add_view("\0\0\0\0", 4);
  const json one = {{"bufferView", view}, {"componentType", 5125}};
  SECTION("sparse positions") {
    const std::size_t accessor = add_zeros(file, "VEC3", 1000000000);
    file.root["accessors"][accessor]["sparse"] = {{"count", 1}, {"indices", one}, {"values", {{"bufferView", 0}}}};
    file.root["meshes"][0]["primitives"][0] = {{"attributes", {{"POSITION", accessor}}}};
  }
  SECTION("keys of an animation") {
    const std::size_t keys = add_zeros(file, "SCALAR", 1000000000), values = add_zeros(file, "VEC3", 1000000000);
    file.root["animations"] =
        json::array({json{{"samplers", {{{"input", keys}, {"output", values}}}},
                          {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}});
  }
  CHECK_THAT(error_of(file), Catch::Matchers::Contains("1000000000 elements and no bufferView"));
}

TEST_CASE("gltf: instances count as nodes, and their memory is counted before it is taken", "[gltf]") {
  CHECK(error_of(instanced_file(1000)) == "loaded");
  CHECK_THAT(error_of(instanced_file(1000000000)), Catch::Matchers::Contains("expected at most 1048576"));
  SECTION("each has the name") {
    CraftedFile file = instanced_file(1000);
    CHECK(error_of(file, of_memory(8 << 20)) == "loaded");
    file.root["nodes"][0]["name"] = std::string(60000, 'n');
    CHECK_THAT(error_of(file, of_memory(8 << 20)), Catch::Matchers::Contains("over the memory limit"));
  }
  SECTION("each has weights of its mesh's targets") {
    CraftedFile file = instanced_file(1000);
    for (int i = 0; i < 3000; ++i) file.root["meshes"][0]["primitives"][0]["targets"].push_back(json::object());
    CHECK(error_of(file, of_memory(16 << 20)) == "loaded");
    CHECK_THAT(error_of(file, of_memory(8 << 20)), Catch::Matchers::Contains("meshes[0] brings the scene over"));
  }
  SECTION("each draws all vertices, whatever its triangles use") {
    CraftedFile file = instanced_file(1000);
    const std::size_t positions = add_zeros(file, "VEC3", 30000);
    file.root["meshes"][0]["primitives"][0] = {{"attributes", {{"POSITION", positions}, {"NORMAL", positions}}},
                                               {"indices", 3}};
    CHECK_THAT(error_of(file, of_memory(std::uint64_t{1} << 30)), Catch::Matchers::Contains("over the memory limit"));
    CHECK(error_of(file, of_memory(std::uint64_t{2} << 30)) == "loaded");
  }
}

TEST_CASE("gltf: JSON has a limit of values", "[gltf]") {
  CraftedFile file = good_file();
  file.root["extras"] = {{"text", ",,,,[[{{\\\",,,\"[[["}, {"zeros", json(std::vector<int>(5000, 0))}};
  LoadLimits limits;
  limits.max_json_values = 5000;
  CHECK_THAT(error_of(file, limits), Catch::Matchers::Contains("values; expected at most 5000"));
  limits.max_json_values = 6000;
  CHECK(error_of(file, limits) == "loaded");
}

TEST_CASE("gltf: warnings end at a number", "[gltf]") {
  const TemporaryFolder folder;
  CraftedFile file = good_file();
  for (int i = 0; i < 100; ++i) file.root["extensionsUsed"].push_back("SHOAL_none_" + std::to_string(i));
  const Scene scene = load_gltf(file.save_glb(folder / "warnings.glb"));
  REQUIRE(scene.warnings.size() == 65);
  CHECK_THAT(scene.warnings[63], Catch::Matchers::Contains("SHOAL_none_63"));
  CHECK(scene.warnings[64] == "further warnings are left out");
}

TEST_CASE("gltf: the weights of instances are moved by one channel only", "[gltf]") {
  CraftedFile file = instanced_file(2);
  file.root["meshes"][0]["primitives"][0]["targets"].push_back({{"POSITION", 1}});
  const std::size_t keys = file.add_floats({0, 1}, "SCALAR", 1);
  const json channel = {{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}};
  file.root["animations"] =
      json::array({json{{"samplers", {{{"input", keys}, {"output", keys}}}}, {"channels", {channel}}}});
  CHECK(error_of(file) == "loaded");
  file.root["animations"][0]["channels"].push_back(channel);
  CHECK_THAT(error_of(file), Catch::Matchers::Contains("a second time"));
}

}  // namespace shoal::test
