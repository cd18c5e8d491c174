// Invalid files: each gives an error of one line that names the file, and no scene.
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "core/error.h"
#include "scene/gltf/gltf.h"
#include "tests/scene/bad_files.h"

namespace shoal::test {
namespace {

// The message, or "loaded".
std::string error_of(const std::string& path, const LoadLimits& limits = {}) {
  try {
    load_gltf(path, limits);
  } catch (const Error& e) {
    return e.what();
  }
  return "loaded";
}

bool is_one_line_about(const std::string& message, const std::string& path) {
  return message.rfind(path + ": ", 0) == 0 && message.find('\n') == std::string::npos &&
         message.find("; expected ") != std::string::npos && message.size() < path.size() + 900;
}

}  // namespace

TEST_CASE("gltf: the file that the bad ones are made from is good", "[gltf]") {
  const TemporaryFolder folder;
  CHECK(error_of(good_file().save_gltf(folder / "good.gltf")) == "loaded");
  CHECK(error_of(good_file().save_glb(folder / "good.glb")) == "loaded");
}

TEST_CASE("gltf: each crafted invalid file is one error that names the fault", "[gltf]") {
  const TemporaryFolder folder;
  const std::vector<BadFile> files = write_bad_files(folder);
  REQUIRE(files.size() >= 100);
  for (const BadFile& file : files) {
    const std::string message = error_of(file.path);
    CAPTURE(message);
    CHECK(is_one_line_about(message, file.path));
    CHECK_THAT(message, Catch::Matchers::Contains(file.message_part));
  }
}

TEST_CASE("gltf: a file cut at any byte is an error", "[gltf]") {
  const TemporaryFolder folder;
  const std::vector<std::uint8_t> glb = good_file().glb();
  for (std::size_t size = 0; size < glb.size(); size += 7) {
    write_file(folder / "cut.glb",
               std::vector<std::uint8_t>(glb.begin(), glb.begin() + static_cast<std::ptrdiff_t>(size)));
    CHECK(is_one_line_about(error_of(folder / "cut.glb"), folder / "cut.glb"));
  }
}

// Random changes of bytes: the file loads or gives an error, and sanitizers report nothing.
TEST_CASE("gltf: a file with any byte changed loads or is one error", "[gltf]") {
  const TemporaryFolder folder;
  const std::vector<std::uint8_t> glb = good_file().glb();
  int loaded = 0, refused = 0;
  for (std::size_t at = 0; at < glb.size(); ++at) {
    std::vector<std::uint8_t> bytes = glb;
    bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ (at % 2 == 0 ? 0x11u : 0xFFu));
    write_file(folder / "changed.glb", bytes);
    const std::string message = error_of(folder / "changed.glb");
    if (message == "loaded") {
      ++loaded;
    } else {
      ++refused;
      CAPTURE(at, message);
      CHECK(is_one_line_about(message, folder / "changed.glb"));
    }
  }
  CHECK(loaded > 0);
  CHECK(refused > 500);
}

TEST_CASE("gltf: limits hold", "[gltf]") {
  const TemporaryFolder folder;
  const std::string path = good_file().save_gltf(folder / "good.gltf");
  LoadLimits limits;
  SECTION("file") {
    limits.max_file_bytes = 100;
    CHECK_THAT(error_of(path, limits), Catch::Matchers::Contains("bytes"));
  }
  SECTION("JSON") {
    limits.max_json_bytes = 100;
    CHECK_THAT(error_of(path, limits), Catch::Matchers::Contains("bytes of JSON"));
  }
  SECTION("nodes") {
    limits.max_nodes = 3;
    CHECK_THAT(error_of(path, limits), Catch::Matchers::Contains("4 nodes"));
  }
  SECTION("triangles") {
    limits.max_triangles = 0;
    CHECK_THAT(error_of(path, limits), Catch::Matchers::Contains("triangles"));
  }
  SECTION("memory") {
    limits.max_scene_bytes = 60;
    CHECK_THAT(error_of(path, limits), Catch::Matchers::Contains("memory limit"));
  }
  SECTION("depth of nodes") {
    CraftedFile file = empty_file();
    for (int i = 0; i < 1200; ++i) file.root["nodes"].push_back({{"children", {i + 1}}});
    file.root["nodes"].push_back(nlohmann::json::object());
    file.root["scenes"][0]["nodes"] = {0};
    const std::string deep = file.save_gltf(folder / "deep.gltf");
    CHECK_THAT(error_of(deep), Catch::Matchers::Contains("nests nodes deeper than 1024"));
    limits.max_node_depth = 2000;
    CHECK(error_of(deep, limits) == "loaded");
  }
  SECTION("the same mesh data in thousands of primitives") {
    CraftedFile file = good_file();
    file.add_floats(std::vector<float>(30000 * 3, 0.5f), "VEC3", 3);
    const nlohmann::json primitive = {{"attributes", {{"POSITION", 4}}}};
    for (int i = 0; i < 2000; ++i) file.root["meshes"][0]["primitives"].push_back(primitive);
    limits.max_scene_bytes = std::uint64_t{1} << 28;
    CHECK_THAT(error_of(file.save_glb(folder / "repeated.glb"), limits), Catch::Matchers::Contains("memory limit"));
  }
}

TEST_CASE("gltf: files outside of the folder are read only when that is allowed", "[gltf]") {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "scene");
  CraftedFile file = good_file();
  write_file(folder / "data.bin", file.bin);
  file.root["buffers"][0]["uri"] = "../data.bin";
  const std::string path = file.save_gltf(folder / "scene/up.gltf");
  CHECK(is_one_line_about(error_of(path), path));
  LoadLimits limits;
  limits.allow_external = true;
  CHECK(error_of(path, limits) == "loaded");
}

}  // namespace shoal::test
