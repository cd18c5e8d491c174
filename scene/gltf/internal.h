// Shared by the files of the glTF loader only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <tiny_gltf.h>

#include "core/error.h"
#include "scene/gltf/gltf.h"

namespace shoal::gltf {

using Bytes = std::span<const std::uint8_t>;

// An image as the file gives it: its encoded bytes, not decoded yet.
struct EncodedImage {
  std::string label;  // for messages: images[2] 'bricks.png'
  std::string uri;    // relative file; empty: bytes
  Bytes bytes;
  std::vector<std::uint8_t> storage;  // of a data URI
  bool srgb = true;                   // false: `extras.linear`, as export_glb writes it
};

// A parsed file, every index and range of it checked (gltf_schema.cpp).
struct Document {
  std::string path, folder;
  LoadLimits limits;
  tinygltf::Model model;  // without buffers and images: those are below
  std::vector<std::uint8_t> file;
  std::vector<std::vector<std::uint8_t>> buffer_storage;
  std::vector<Bytes> buffers;
  std::vector<EncodedImage> images;
  std::vector<std::string> warnings;
  std::uint64_t scene_bytes = 0;  // decoded so far

  // Where read_nodes put each node of the file: into Scene::nodes, or kNoIndex where no scene that is drawn has it; and
  // how many instances of its mesh follow it as nodes of their own (EXT_mesh_gpu_instancing).
  std::vector<std::int32_t> node_places;
  std::vector<std::uint32_t> instance_counts;
};

// Throws Error: "PATH: what; expected".
[[noreturn]] void fail(const std::string& path, const std::string& what, const std::string& expected);

// Adds a line once.
void warn(Document& document, const std::string& line);

// Counts decoded memory against the limit before it is taken.
void charge(Document& document, std::uint64_t bytes, const std::string& what);

// "accessors[3]", or "accessors[3] 'positions'".
std::string label_of(const char* section, std::size_t index, const std::string& name = {});

// Longer text is cut, line breaks and control characters become spaces: library messages, names of the file.
std::string one_line(const std::string& text, std::size_t max_length = 200);

// gltf_files.cpp
std::vector<std::uint8_t> read_file(const std::string& path, std::uint64_t max_bytes, const std::string& blame);
// The file that a URI names. Refuses schemes, absolute paths and `..`, and what lies outside of the folder.
std::string resolve_uri(const Document& document, const std::string& uri, const std::string& label);

// gltf_parse.cpp
void parse_file(Document& document);

// gltf_accessors.cpp. Elements as float, normalised integers scaled as the specification says; sparse applied.
//   components  of one element: 1 to 4; the result has count * components floats, all finite
std::vector<float> read_floats(Document& document, std::size_t accessor, int components, const std::string& use);
std::vector<std::uint32_t> read_indices(Document& document, std::size_t accessor, std::uint64_t vertex_count);
std::uint64_t accessor_count(const Document& document, std::size_t accessor);

// What a material reads of its meshes.
struct UvSource {
  std::vector<int> sets;        // numbers of the file's TEXCOORD sets, by the number in UvMap::set; at most two
  bool needs_tangents = false;  // it has a normal map, read with normal_uv
  UvMap normal_uv;
};

// gltf_deform.cpp. Joints, weights and morph targets of a primitive whose positions are read.
void read_deformation(Document& document, const tinygltf::Primitive& primitive, std::uint64_t vertex_count,
                      const std::string& label, MeshPrimitive& mesh);
// One vertex a corner, as the positions get where normals are generated.
void expand_deformation(Document& document, MeshPrimitive& mesh, const std::string& label);

// gltf_motion.cpp. Skins, morph weights and animations, once meshes and nodes are read.
void read_motion(Document& document, Scene& scene);

// gltf_instances.cpp. Transforms of a node's instances; empty where it has none.
std::vector<LocalTransform> read_instances(Document& document, const tinygltf::Node& node, const std::string& label);

// gltf_materials.cpp, gltf_meshes.cpp, gltf_nodes.cpp, gltf_water.cpp
std::vector<UvSource> read_materials(Document& document, Scene& scene);
void read_meshes(Document& document, Scene& scene, const std::vector<UvSource>& uv_sources);
void read_nodes(Document& document, Scene& scene);
bool read_water(Document& document, const tinygltf::Value& extras, const std::string& label, WaterSpec& water);
void read_background(Document& document, const tinygltf::Value& extras, const std::string& label, Scene& scene);
void read_environment(Document& document, const tinygltf::Value& extras, const std::string& label, Scene& scene);

}  // namespace shoal::gltf
