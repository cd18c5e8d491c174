// Sample models of the Khronos Group and a scan, with the triangle counts of their list. The environment variable
// SHOAL_SHARED_DATA names the folder; without it these tests load nothing.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "core/error.h"
#include "scene/gltf/gltf.h"
#include "scene/images/images.h"

namespace shoal::test {
namespace {

struct Listed {
  std::string path;
  std::uint64_t unique_triangles = 0, scene_triangles = 0;
};

// MODELS.csv: file,bytes,container,unique_tris,scene_tris,...
std::vector<Listed> read_list(const std::string& folder) {
  std::vector<Listed> list;
  std::ifstream in(folder + "/MODELS.csv");
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::vector<std::string> fields;
    std::istringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
    if (fields.size() < 5) continue;
    Listed item;
    item.path = folder + "/" + fields[0];
    // One row leaves out the folder that the other containers have.
    const std::filesystem::path file = fields[0];
    if (!std::filesystem::exists(item.path)) {
      item.path = folder + "/" + file.parent_path().string() + "/glTF-Binary/" + file.filename().string();
    }
    if (!std::filesystem::exists(item.path)) {
      item.path = folder + "/" + file.parent_path().string() + "/" + file.filename().string();
    }
    item.unique_triangles = std::stoull(fields[3]);
    item.scene_triangles = std::stoull(fields[4]);
    list.push_back(item);
  }
  return list;
}

}  // namespace

TEST_CASE("gltf: every model of the shared data loads with the triangles of its list", "[gltf]") {
  const char* shared = std::getenv("SHOAL_SHARED_DATA");
  if (shared == nullptr || !std::filesystem::exists(std::string(shared) + "/gltf/MODELS.csv")) {
    WARN("SHOAL_SHARED_DATA is not set: the sample models are not tested");
    return;
  }
  std::vector<Listed> files = read_list(std::string(shared) + "/gltf");
  REQUIRE(files.size() >= 40);
  for (const Listed& file : read_list(std::string(shared) + "/highpoly")) files.push_back(file);
  for (const Listed& file : files) {
    CAPTURE(file.path);
    const Scene scene = load_gltf(file.path);
    std::uint64_t unique = 0, drawn = 0;
    std::vector<std::uint64_t> of_mesh;
    for (const Mesh& mesh : scene.meshes) {
      std::uint64_t triangles = 0;
      for (const MeshPrimitive& primitive : mesh.primitives) triangles += primitive.indices.size() / 3;
      of_mesh.push_back(triangles);
      unique += triangles;
    }
    for (const Node& node : scene.nodes) {
      if (node.mesh != kNoIndex) drawn += of_mesh[static_cast<std::size_t>(node.mesh)];
    }
    CHECK(unique == file.unique_triangles);
    CHECK(drawn == file.scene_triangles);
  }
}

TEST_CASE("images: the pictures of the shared data decode", "[gltf]") {
  const char* shared = std::getenv("SHOAL_SHARED_DATA");
  if (shared == nullptr || !std::filesystem::exists(std::string(shared) + "/images")) {
    WARN("SHOAL_SHARED_DATA is not set: its pictures are not tested");
    return;
  }
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(shared) + "/images")) {
    const Texture texture = load_texture(entry.path().string(), true);
    CHECK(texture.width[0] >= 512);
    CHECK((entry.path().extension() == ".hdr") == (texture.format == TexelFormat::kRgba32Float));
    ++count;
    // A JPEG that stops half way is an error, not half grey.
    if (entry.path().extension() == ".jpg") {
      std::ifstream in(entry.path(), std::ios::binary);
      std::vector<char> bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
      bytes.resize(bytes.size() / 2);
      const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
      CHECK_THROWS_AS(decode_texture({data, bytes.size()}, "half", true), Error);
    }
  }
  CHECK(count >= 5);
}

}  // namespace shoal::test
