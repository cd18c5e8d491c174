// Declarations shared by the files of the glTF loader.
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

// An image as the file gives it, not decoded.
struct EncodedImage {
  std::string label;  // for messages: images[2] 'bricks.png'
  std::string uri;    // relative path of its file; empty: `bytes` holds it
  Bytes bytes;
  std::vector<std::uint8_t> storage;  // the decoded bytes of a data URI
  bool srgb = true;                   // false where the file has `extras.linear`, which export_glb writes
};

// A parsed file. check_schema has checked its indices and ranges (schema.cpp).
struct Document {
  std::string path, folder;
  LoadLimits limits;
  tinygltf::Model model;  // without buffers and images, which are below
  std::vector<std::uint8_t> file;
  std::vector<std::vector<std::uint8_t>> buffer_storage;
  std::vector<Bytes> buffers;
  std::vector<EncodedImage> images;
  std::vector<std::string> warnings;
  std::uint64_t scene_bytes = 0;  // memory of what is decoded so far; see charge

  // For each node of the file: its index in Scene::nodes, or kNoIndex where the scene that is drawn does not contain
  // it; and the number of instances of its mesh that follow it as nodes (EXT_mesh_gpu_instancing). read_nodes fills
  // both.
  std::vector<std::int32_t> node_places;
  std::vector<std::uint32_t> instance_counts;
};

// Throws Error with the message "PATH: what; expected".
[[noreturn]] void fail(const std::string& path, const std::string& what, const std::string& expected);

// Adds a warning, unless the document has the same one already.
void warn(Document& document, const std::string& line);

// Adds to the memory of decoded data before it is allocated. Throws Error above LoadLimits::max_scene_bytes.
//   what  begins the message
void charge(Document& document, std::uint64_t bytes, const std::string& what);

// Returns a label for messages: "accessors[3]", or "accessors[3] 'positions'".
std::string label_of(const char* section, std::size_t index, const std::string& name = {});

// Returns a text as one line for messages: runs of spaces and control characters become one space, and text beyond
// max_length bytes is replaced by "...".
std::string one_line(const std::string& text, std::size_t max_length = 200);

// files.cpp. Reads a file of at most max_bytes.
//   blame  begins the message of an Error
std::vector<std::uint8_t> read_file(const std::string& path, std::uint64_t max_bytes, const std::string& blame);
// Returns the path that a URI names. Throws Error for schemes, absolute paths, `..`, and files outside of the scene's
// folder.
std::string resolve_uri(const Document& document, const std::string& uri, const std::string& label);

// parse.cpp. Reads and parses document.path.
void parse_file(Document& document);

// accessors.cpp. Reads the elements of an accessor as floats: normalized integers are scaled as the specification says,
// and sparse values are applied.
//   components  of one element: 1 to 4, or 16 of a matrix
//   use         names the accessor in messages
// Returns count * components floats, all finite.
std::vector<float> read_floats(Document& document, std::size_t accessor, int components, const std::string& use);
// Reads vertex indices, each below vertex_count.
std::vector<std::uint32_t> read_indices(Document& document, std::size_t accessor, std::uint64_t vertex_count);
std::uint64_t accessor_count(const Document& document, std::size_t accessor);

// The texture coordinates and tangents that a material needs from its meshes.
struct UvSource {
  std::vector<int> sets;        // at most two TEXCOORD sets of the file; UvMap::set is an index into this list
  bool needs_tangents = false;  // true where it has a normal map, which is sampled with normal_uv
  UvMap normal_uv;
};

// deform.cpp. Reads joints, weights and morph targets of a primitive after its positions.
void read_deformation(Document& document, const tinygltf::Primitive& primitive, std::uint64_t vertex_count,
                      const std::string& label, MeshPrimitive& mesh);
// Gives each corner a vertex of its own, as generated flat normals need.
void expand_deformation(Document& document, MeshPrimitive& mesh, const std::string& label);

// motion.cpp. Reads skins, morph weights and animations, after meshes and nodes.
void read_motion(Document& document, Scene& scene);

// instances.cpp. Returns the transforms of a node's instances; empty where it has none.
std::vector<LocalTransform> read_instances(Document& document, const tinygltf::Node& node, const std::string& label);

// materials.cpp, meshes.cpp, nodes.cpp, water.cpp
std::vector<UvSource> read_materials(Document& document, Scene& scene);
void read_meshes(Document& document, Scene& scene, const std::vector<UvSource>& uv_sources);
void read_nodes(Document& document, Scene& scene);
// Returns false where the extras describe no water.
bool read_water(Document& document, const tinygltf::Value& extras, const std::string& label, WaterSpec& water);
void read_background(Document& document, const tinygltf::Value& extras, const std::string& label, Scene& scene);
void read_environment(Document& document, const tinygltf::Value& extras, const std::string& label, Scene& scene);

}  // namespace shoal::gltf
