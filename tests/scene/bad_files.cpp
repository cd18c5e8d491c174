#include "tests/scene/bad_files.h"

#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>

namespace shoal::test {
namespace {

using nlohmann::json;
using Mutation = std::function<void(CraftedFile&)>;

void append_u32_le(std::vector<std::uint8_t>& to, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) to.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}
void append_u32_be(std::vector<std::uint8_t>& to, std::uint32_t value) {
  for (int i = 3; i >= 0; --i) to.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) {
      text.push_back(i + k > bytes.size() ? '=' : digits[group >> (18 - 6 * k) & 63]);
    }
  }
  return text;
}

}  // namespace

void append_png_chunk(std::vector<std::uint8_t>& file, const char* type, const std::vector<std::uint8_t>& data) {
  append_u32_be(file, static_cast<std::uint32_t>(data.size()));
  const std::size_t start = file.size();
  file.insert(file.end(), type, type + 4);
  file.insert(file.end(), data.begin(), data.end());
  std::uint32_t crc = 0xFFFFFFFFu;
  for (std::size_t i = start; i < file.size(); ++i) {
    crc ^= file[i];
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1u) != 0 ? 0xEDB88320u : 0u);
  }
  append_u32_be(file, ~crc);
}

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "shoal-test-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) std::abort();
  path_ = pattern;
}
TemporaryFolder::~TemporaryFolder() {
  std::error_code ec;
  std::filesystem::remove_all(path_, ec);
}

void write_file(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}
void write_file(const std::string& path, const std::string& text) {
  write_file(path, std::vector<std::uint8_t>(text.begin(), text.end()));
}
std::vector<std::uint8_t> read_whole_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::size_t CraftedFile::add_view(const void* data, std::size_t size, std::size_t stride) {
  while (bin.size() % 4 != 0) bin.push_back(0);
  json view = {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", size}};
  if (stride != 0) view["byteStride"] = stride;
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  bin.insert(bin.end(), bytes, bytes + size);
  root["bufferViews"].push_back(view);
  root["buffers"] = json::array({json{{"byteLength", bin.size()}}});
  return root["bufferViews"].size() - 1;
}

std::size_t CraftedFile::add_accessor(const void* data, std::size_t size, int component_type, const char* type,
                                      std::size_t count, bool normalized) {
  json accessor = {
      {"bufferView", add_view(data, size)}, {"componentType", component_type}, {"type", type}, {"count", count}};
  if (normalized) accessor["normalized"] = true;
  root["accessors"].push_back(accessor);
  return root["accessors"].size() - 1;
}

std::size_t CraftedFile::add_floats(const std::vector<float>& values, const char* type, std::size_t components) {
  return add_accessor(values.data(), values.size() * 4, 5126, type, values.size() / components);
}

std::size_t CraftedFile::add_mesh(json primitive) {
  root["meshes"].push_back({{"primitives", json::array({std::move(primitive)})}});
  root["nodes"].push_back({{"mesh", root["meshes"].size() - 1}});
  root["scenes"][0]["nodes"].push_back(root["nodes"].size() - 1);
  return root["meshes"].size() - 1;
}

std::string CraftedFile::save_gltf(const std::string& path) const {
  json copy = root;
  if (copy.contains("buffers") && !copy["buffers"].empty() && copy["buffers"][0].is_object() &&
      !copy["buffers"][0].contains("uri")) {
    copy["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64(bin);
  }
  write_file(path, copy.dump());
  return path;
}

std::vector<std::uint8_t> CraftedFile::glb() const {
  std::string text = root.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::vector<std::uint8_t> padded = bin;
  padded.resize((padded.size() + 3) / 4 * 4, 0);
  std::vector<std::uint8_t> file;
  append_u32_le(file, 0x46546C67);
  append_u32_le(file, 2);
  append_u32_le(file, static_cast<std::uint32_t>(28 + text.size() + padded.size()));
  append_u32_le(file, static_cast<std::uint32_t>(text.size()));
  append_u32_le(file, 0x4E4F534A);
  file.insert(file.end(), text.begin(), text.end());
  append_u32_le(file, static_cast<std::uint32_t>(padded.size()));
  append_u32_le(file, 0x004E4942);
  file.insert(file.end(), padded.begin(), padded.end());
  return file;
}

std::string CraftedFile::save_glb(const std::string& path) const {
  write_file(path, glb());
  return path;
}

std::vector<std::uint8_t> png(std::uint32_t width, std::uint32_t height, int color_type, int depth,
                              const std::vector<std::uint8_t>& rows) {
  std::vector<std::uint8_t> file = {0x89, 'P', 'N', 'G', 0x0D, 0x0A, 0x1A, 0x0A};
  std::vector<std::uint8_t> header;
  append_u32_be(header, width);
  append_u32_be(header, height);
  for (const int byte : {depth, color_type, 0, 0, 0}) header.push_back(static_cast<std::uint8_t>(byte));
  append_png_chunk(file, "IHDR", header);

  // Filter type 0 before each row; then one stored deflate block in a zlib frame.
  std::vector<std::uint8_t> raw;
  const std::size_t row = height == 0 ? 0 : rows.size() / height;
  for (std::size_t y = 0; row > 0 && y < height; ++y) {
    raw.push_back(0);
    raw.insert(raw.end(), rows.begin() + static_cast<std::ptrdiff_t>(y * row),
               rows.begin() + static_cast<std::ptrdiff_t>((y + 1) * row));
  }
  std::vector<std::uint8_t> data = {0x78, 0x01, 0x01};
  const auto size = static_cast<std::uint16_t>(raw.size());
  for (const int value : {size & 255, size >> 8, ~size & 255, (~size >> 8) & 255}) {
    data.push_back(static_cast<std::uint8_t>(value));
  }
  data.insert(data.end(), raw.begin(), raw.end());
  std::uint32_t a = 1, b = 0;
  for (const std::uint8_t byte : raw) {
    a = (a + byte) % 65521;
    b = (b + a) % 65521;
  }
  append_u32_be(data, b << 16 | a);
  append_png_chunk(file, "IDAT", data);
  append_png_chunk(file, "IEND", {});
  return file;
}

CraftedFile empty_file() {
  CraftedFile file;
  file.root = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", json::array({json::object()})}};
  return file;
}

CraftedFile good_file() {
  CraftedFile file = empty_file();
  const std::size_t positions = file.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
  const std::size_t normals = file.add_floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
  const std::size_t uvs = file.add_floats({0, 0, 1, 0, 0, 1}, "VEC2", 2);
  const std::uint16_t corners[] = {0, 1, 2};
  const std::size_t indices = file.add_accessor(corners, sizeof corners, 5123, "SCALAR", 3);
  const std::vector<std::uint8_t> image = png(1, 1, 6, 8, {10, 20, 30, 255});
  const std::size_t view = file.add_view(image.data(), image.size());
  json& root = file.root;
  root["images"] = json::array({{{"bufferView", view}, {"mimeType", "image/png"}}});
  root["samplers"] = json::array({json{{"wrapS", 33071}}});
  root["textures"] = json::array({{{"source", 0}, {"sampler", 0}}});
  root["materials"] = json::array({json{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}});
  root["cameras"] = json::array({{{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}}});
  root["extensionsUsed"] = json::array({"KHR_lights_punctual"});
  root["extensions"]["KHR_lights_punctual"]["lights"] = json::array({json{{"type", "directional"}}});
  file.add_mesh({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", uvs}}},
                 {"indices", indices},
                 {"material", 0}});
  root["nodes"].push_back({{"name", "eye"}, {"camera", 0}});
  root["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  root["nodes"].push_back({{"extras", {{"water", {{"size", {4, 3}}}}}}});
  root["scenes"][0]["nodes"] = {0, 1, 2, 3};
  return file;
}

namespace {

struct Recipe {
  const char* name;
  const char* message_part;
  Mutation mutate;
};

void set_float(CraftedFile& file, std::size_t at, float value) { std::memcpy(&file.bin[at], &value, 4); }

// Accessors of good_file(): 0 positions, 1 normals, 2 texture coordinates, 3 indices; nodes: 0 mesh, 1 camera, 2 light,
// 3 water.
std::vector<Recipe> index_recipes() {
  return {
      {"accessor_view", "bufferViews", [](CraftedFile& f) { f.root["accessors"][0]["bufferView"] = 99; }},
      {"accessor_negative_view", "accessors[0].bufferView is -1",
       [](CraftedFile& f) { f.root["accessors"][0]["bufferView"] = -1; }},
      {"view_buffer", "buffers", [](CraftedFile& f) { f.root["bufferViews"][0]["buffer"] = 1; }},
      {"attribute", "accessors",
       [](CraftedFile& f) { f.root["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 99; }},
      {"indices", "accessors", [](CraftedFile& f) { f.root["meshes"][0]["primitives"][0]["indices"] = 77; }},
      {"indices_text", "abc", [](CraftedFile& f) { f.root["meshes"][0]["primitives"][0]["indices"] = "abc"; }},
      {"material", "materials", [](CraftedFile& f) { f.root["meshes"][0]["primitives"][0]["material"] = 3; }},
      {"texture", "textures",
       [](CraftedFile& f) { f.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 2; }},
      {"image", "images", [](CraftedFile& f) { f.root["textures"][0]["source"] = 5; }},
      {"sampler", "samplers", [](CraftedFile& f) { f.root["textures"][0]["sampler"] = 5; }},
      {"mesh", "meshes", [](CraftedFile& f) { f.root["nodes"][0]["mesh"] = 12345; }},
      {"camera", "cameras", [](CraftedFile& f) { f.root["nodes"][1]["camera"] = 1; }},
      {"light", "lights", [](CraftedFile& f) { f.root["nodes"][2]["extensions"]["KHR_lights_punctual"]["light"] = 8; }},
      {"scene", "scenes", [](CraftedFile& f) { f.root["scene"] = 1; }},
      {"scene_node", "nodes",
       [](CraftedFile& f) {
         f.root["scenes"][0]["nodes"] = {0, 9};
       }},
      {"child", "nodes", [](CraftedFile& f) { f.root["nodes"][0]["children"] = {44}; }},
      {"image_view", "bufferViews", [](CraftedFile& f) { f.root["images"][0]["bufferView"] = 44; }},
      {"vertex_number", "indices)[1] is 3",
       [](CraftedFile& f) { f.bin[f.root["bufferViews"][3]["byteOffset"].get<std::size_t>() + 2] = 3; }},
  };
}

std::vector<Recipe> range_recipes() {
  return {
      {"count", "needs 12000000 bytes",
       [](CraftedFile& f) {
         for (std::size_t i = 0; i < 3; ++i) f.root["accessors"][i]["count"] = 1000000;
       }},
      {"count_zero", "count is 0", [](CraftedFile& f) { f.root["accessors"][0]["count"] = 0; }},
      {"count_huge", "count is", [](CraftedFile& f) { f.root["accessors"][0]["count"] = 1e300; }},
      {"count_half", "count is 2.5", [](CraftedFile& f) { f.root["accessors"][0]["count"] = 2.5; }},
      {"count_wraps", "needs 8589934590 bytes", [](CraftedFile& f) { f.root["accessors"][3]["count"] = 4294967295u; }},
      {"accessor_offset", "bytes", [](CraftedFile& f) { f.root["accessors"][0]["byteOffset"] = 1000000; }},
      {"accessor_negative_offset", "byteOffset is -4",
       [](CraftedFile& f) { f.root["accessors"][0]["byteOffset"] = -4; }},
      {"accessor_odd_offset", "aligned", [](CraftedFile& f) { f.root["accessors"][3]["byteOffset"] = 1; }},
      {"view_length", "length of its buffer", [](CraftedFile& f) { f.root["bufferViews"][0]["byteLength"] = 1 << 30; }},
      {"view_offset_wraps", "byteOffset",
       [](CraftedFile& f) { f.root["bufferViews"][0]["byteOffset"] = 18446744073709551600u; }},
      {"stride_small", "byteStride", [](CraftedFile& f) { f.root["bufferViews"][0]["byteStride"] = 8; }},
      {"stride_odd", "multiple of 4", [](CraftedFile& f) { f.root["bufferViews"][0]["byteStride"] = 13; }},
      {"stride_huge", "byteStride", [](CraftedFile& f) { f.root["bufferViews"][0]["byteStride"] = 1000; }},
      {"stride_past_end", "bytes", [](CraftedFile& f) { f.root["bufferViews"][0]["byteStride"] = 252; }},
      {"stride_of_indices", "byteStride", [](CraftedFile& f) { f.root["bufferViews"][3]["byteStride"] = 4; }},
      {"component_type", "component type", [](CraftedFile& f) { f.root["accessors"][0]["componentType"] = 5124; }},
      {"component_type_unknown", "componentType is 1",
       [](CraftedFile& f) { f.root["accessors"][0]["componentType"] = 1; }},
      {"position_type", "VEC3", [](CraftedFile& f) { f.root["accessors"][0]["type"] = "VEC2"; }},
      {"unknown_type", "VEC9", [](CraftedFile& f) { f.root["accessors"][0]["type"] = "VEC9"; }},
      {"float_indices", "SCALAR", [](CraftedFile& f) { f.root["accessors"][3]["componentType"] = 5126; }},
      {"counts_differ", "expected 3", [](CraftedFile& f) { f.root["accessors"][1]["count"] = 2; }},
      {"two_corners", "multiple of three", [](CraftedFile& f) { f.root["accessors"][3]["count"] = 2; }},
      {"mode", "mode is 7", [](CraftedFile& f) { f.root["meshes"][0]["primitives"][0]["mode"] = 7; }},
      {"zeros_without_end", "elements and no bufferView",
       [](CraftedFile& f) {
         f.root["accessors"][0] = {{"componentType", 5126}, {"type", "VEC3"}, {"count", 4200000000u}};
         f.root["meshes"][0]["primitives"][0] = {{"attributes", {{"POSITION", 0}}}};
       }},
      {"many_zeros", "no bufferView",
       [](CraftedFile& f) {
         f.root["accessors"][0] = {{"componentType", 5126}, {"type", "VEC3"}, {"count", 18000000}};
         f.root["meshes"][0]["primitives"][0] = {{"attributes", {{"POSITION", 0}}}};
       }},
      {"sparse_index", "increasing indices below 3",
       [](CraftedFile& f) {
         f.root["accessors"][0]["sparse"] = {
             {"count", 2},
             {"indices", {{"bufferView", 3}, {"byteOffset", 2}, {"componentType", 5123}}},
             {"values", {{"bufferView", 0}}}};
         f.bin[f.root["bufferViews"][3]["byteOffset"].get<std::size_t>() + 4] = 200;
         f.root["meshes"][0]["primitives"][0].erase("indices");
       }},
      {"sparse_values", "sparse.values",
       [](CraftedFile& f) {
         f.root["accessors"][0]["sparse"] = {{"count", 3},
                                             {"indices", {{"bufferView", 3}, {"componentType", 5123}}},
                                             {"values", {{"bufferView", 0}, {"byteOffset", 12}}}};
       }},
      {"sparse_view", "bufferViews",
       [](CraftedFile& f) {
         f.root["accessors"][0]["sparse"] = {
             {"count", 1}, {"indices", {{"bufferView", 50}, {"componentType", 5123}}}, {"values", {{"bufferView", 0}}}};
       }},
  };
}

std::vector<Recipe> value_recipes() {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  return {
      {"nan_position", "accessors[0]", [=](CraftedFile& f) { set_float(f, 4, nan); }},
      {"infinite_position", "an infinity", [=](CraftedFile& f) { set_float(f, 8, -inf); }},
      {"far_position", "expected vertices within", [](CraftedFile& f) { set_float(f, 0, 1e30f); }},
      {"nan_normal", "accessors[1]", [=](CraftedFile& f) { set_float(f, 40, nan); }},
      {"infinite_uv", "accessors[2]", [=](CraftedFile& f) { set_float(f, 76, inf); }},
      {"scale_overflows", "nodes[0]",
       [](CraftedFile& f) {
         f.root["nodes"][0]["scale"] = {1e300, 1, 1};
       }},
      {"far_node", "expected vertices within",
       [](CraftedFile& f) {
         f.root["nodes"][0]["translation"] = {1e20, 0, 0};
       }},
      {"zero_rotation", "unit quaternion",
       [](CraftedFile& f) {
         f.root["nodes"][0]["rotation"] = {0, 0, 0, 0};
       }},
      {"short_matrix", "16 numbers",
       [](CraftedFile& f) {
         f.root["nodes"][0]["matrix"] = {1, 0, 0, 0};
       }},
      {"projective_matrix", "0 0 0 1",
       [](CraftedFile& f) { f.root["nodes"][0]["matrix"] = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; }},
      {"node_in_itself", "its own ancestor",
       [](CraftedFile& f) {
         f.root["nodes"][0]["children"] = {1};
         f.root["nodes"][1]["children"] = {0};
         f.root["scenes"][0]["nodes"] = {2, 3};
       }},
      {"two_parents", "one parent",
       [](CraftedFile& f) {
         f.root["nodes"][1]["children"] = {0};
         f.root["nodes"][2]["children"] = {0};
       }},
      {"root_that_is_a_child", "root nodes", [](CraftedFile& f) { f.root["nodes"][1]["children"] = {0}; }},
      {"no_scenes", "no scene",
       [](CraftedFile& f) {
         f.root.erase("scenes");
         f.root.erase("scene");
       }},
      {"no_asset", "asset", [](CraftedFile& f) { f.root.erase("asset"); }},
      {"version_1", "version 1.0", [](CraftedFile& f) { f.root["asset"]["version"] = "1.0"; }},
      {"required_extensions", "KHR_draco_mesh_compression, EXT_meshopt_compression",
       [](CraftedFile& f) {
         f.root["extensionsRequired"] = {"KHR_draco_mesh_compression", "KHR_materials_unlit",
                                         "EXT_meshopt_compression"};
       }},
      {"yfov", "yfov", [](CraftedFile& f) { f.root["cameras"][0]["perspective"]["yfov"] = 0; }},
      {"znear", "znear", [](CraftedFile& f) { f.root["cameras"][0]["perspective"]["znear"] = -1; }},
      {"camera_type", "perspective or orthographic", [](CraftedFile& f) { f.root["cameras"][0]["type"] = "fisheye"; }},
      {"alpha_mode", "OPAQUE, MASK or BLEND", [](CraftedFile& f) { f.root["materials"][0]["alphaMode"] = "GLASS"; }},
      {"wrap_mode", "wrap mode", [](CraftedFile& f) { f.root["samplers"][0]["wrapS"] = 5; }},
      {"min_filter", "minFilter", [](CraftedFile& f) { f.root["samplers"][0]["minFilter"] = 9990; }},
      {"water_ior", "1/3 to 3", [](CraftedFile& f) { f.root["nodes"][3]["extras"]["water"]["ior"] = 3.01; }},
      {"water_ior_text", "1/3 to 3", [](CraftedFile& f) { f.root["nodes"][3]["extras"]["water_ior"] = "1.33"; }},
      {"water_absorption", "0 or more",
       [](CraftedFile& f) {
         f.root["nodes"][3]["extras"]["water"]["absorption"] = {1, -1, 1};
       }},
      {"water_size", "[x, z]",
       [](CraftedFile& f) {
         f.root["nodes"][3]["extras"]["water"]["size"] = {4, 0};
       }},
      {"water_depth", "more than 0", [](CraftedFile& f) { f.root["nodes"][3]["extras"]["water"]["depth"] = -1; }},
      {"water_key", "iro", [](CraftedFile& f) { f.root["nodes"][3]["extras"]["water"]["iro"] = 1.3; }},
      {"water_surface", "expected flat",
       [](CraftedFile& f) {
         f.root["nodes"][3]["extras"]["water"]["surface"] = {{"type", "lava"}};
       }},
      {"water_without_outline", "planar mesh", [](CraftedFile& f) { f.root["nodes"][3]["extras"]["water"] = true; }},
      {"background", "background", [](CraftedFile& f) { f.root["scenes"][0]["extras"]["background"] = "night"; }},
  };
}

std::vector<Recipe> outside_recipes() {
  return {
      {"missing_bin", "is missing", [](CraftedFile& f) { f.root["buffers"][0]["uri"] = "nowhere.bin"; }},
      {"bin_above", "without '..'",
       [](CraftedFile& f) { f.root["buffers"][0]["uri"] = "../../../../../../etc/passwd"; }},
      {"bin_above_encoded", "without '..'", [](CraftedFile& f) { f.root["buffers"][0]["uri"] = "%2e%2e/x.bin"; }},
      {"bin_absolute", "relative path", [](CraftedFile& f) { f.root["buffers"][0]["uri"] = "/etc/passwd"; }},
      {"bin_by_scheme", "data URI", [](CraftedFile& f) { f.root["buffers"][0]["uri"] = "file:///etc/passwd"; }},
      {"bin_by_link", "out of the scene's folder", [](CraftedFile& f) { f.root["buffers"][0]["uri"] = "link.bin"; }},
      {"bin_folder", "no regular file", [](CraftedFile& f) { f.root["buffers"][0]["uri"] = "folder"; }},
      {"bin_short", "has 4 bytes", [](CraftedFile& f) { f.root["buffers"][0]["uri"] = "short.bin"; }},
      {"data_uri_type", "data URI", [](CraftedFile& f) { f.root["buffers"][0]["uri"] = "data:text/html;base64,AAAA"; }},
      {"data_uri_digits", "base64",
       [](CraftedFile& f) { f.root["buffers"][0]["uri"] = "data:application/octet-stream;base64,AA*A"; }},
      {"data_uri_short", "byteLength",
       [](CraftedFile& f) { f.root["buffers"][0]["uri"] = "data:application/octet-stream;base64,AAAA"; }},
      {"missing_image", "brick.png",
       [](CraftedFile& f) {
         f.root["images"][0] = {{"uri", "brick.png"}};
       }},
      {"image_of_text", "PNG, JPEG",
       [](CraftedFile& f) {
         f.root["images"][0] = {{"uri", "short.bin"}};
       }},
      {"image_cut", "cut short",
       [](CraftedFile& f) {
         f.root["images"][0] = {{"uri", "cut.png"}};
       }},
      {"image_damaged", "is damaged",
       [](CraftedFile& f) {
         f.root["images"][0] = {{"uri", "damaged.png"}};
       }},
      {"image_too_large", "100000 x 100000",
       [](CraftedFile& f) {
         f.root["images"][0] = {{"uri", "large.png"}};
       }},
      {"image_empty", "0 x 0",
       [](CraftedFile& f) {
         f.root["images"][0] = {{"uri", "empty.png"}};
       }},
      {"image_without_data", "neither",
       [](CraftedFile& f) {
         f.root["images"][0] = {{"name", "x"}};
       }},
  };
}

// Not one JSON value away from a good file.
void write_raw_files(const TemporaryFolder& folder, std::vector<BadFile>& files) {
  const auto add = [&](const std::string& name, const std::vector<std::uint8_t>& bytes,
                       const std::string& message_part) {
    write_file(folder / name, bytes);
    files.push_back({folder / name, message_part});
  };
  const auto add_text = [&](const std::string& name, const std::string& text, const std::string& message_part) {
    add(name, {text.begin(), text.end()}, message_part);
  };
  const std::vector<std::uint8_t> good = good_file().glb();
  const auto patched = [&](std::size_t at, std::uint32_t value) {
    std::vector<std::uint8_t> bytes = good;
    for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
    return bytes;
  };
  files.push_back({folder / "not_there.glb", "cannot be opened"});
  files.push_back({folder.path(), "no regular file"});
  add("empty.gltf", {}, "is empty");
  add("empty.glb", {}, "is empty");
  add("header.glb", {good.begin(), good.begin() + 12}, "truncated");
  add("cut_json.glb", {good.begin(), good.begin() + 100}, "truncated");
  add("cut_bin.glb", {good.begin(), good.end() - 8}, "truncated");
  add("version.glb", patched(4, 1), "version 1");
  add("json_length.glb", patched(12, 0xFFFFFFF0u), "JSON chunk");
  add("json_type.glb", patched(16, 0), "no JSON");
  add("length.glb", patched(8, 24), "JSON chunk");
  std::uint32_t json_length = 0;
  std::memcpy(&json_length, &good[12], 4);
  add("bin_length.glb", patched(20 + json_length, 0xFFFFFFFCu), "binary chunk");
  add("bin_type.glb", patched(24 + json_length, 7), "no binary chunk");
  add_text("spaces.gltf", "   \n  ", "JSON");
  add_text("text.gltf", "hello", "JSON");
  add_text("array.gltf", "[{}]", "no object");
  add_text("cut.gltf", R"({"asset":{"version":"2.0"},"scenes":[)", "JSON");
  add_text("number.gltf", R"({"asset":{"version":"2.0"},"scene":1e999})", "JSON");
  add_text("utf8.gltf", "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"name\":\"\xff\"}]}", "JSON");
  add_text("deep.gltf", std::string(200000, '[') + "{", "nested deeper");
  add_text("deep_extras.gltf",
           R"({"asset":{"version":"2.0"},"extras":)" + std::string(200000, '[') + std::string(200000, ']') + "}",
           "nested deeper");
  add("jpeg.glb", {0xFF, 0xD8, 0xFF, 0xE0, 0, 16}, "neither JSON nor a .glb");
}

}  // namespace

std::vector<BadFile> write_bad_files(const TemporaryFolder& folder) {
  std::vector<BadFile> files;
  for (const auto& recipes : {index_recipes(), range_recipes(), value_recipes(), outside_recipes()}) {
    for (const Recipe& recipe : recipes) {
      CraftedFile file = good_file();
      recipe.mutate(file);
      const std::string name = recipe.name;
      files.push_back({file.save_gltf(folder / (name + ".gltf")), recipe.message_part});
      // What is wrong inside is also wrong in the other container.
      files.push_back({file.save_glb(folder / (name + ".glb")), recipe.message_part});
    }
  }
  write_raw_files(folder, files);

  write_file(folder / "short.bin", std::string("abcd"));
  std::filesystem::create_directory(folder / "folder");
  std::filesystem::create_symlink("/etc/passwd", folder / "link.bin");
  std::vector<std::uint8_t> image = png(2, 2, 6, 8, std::vector<std::uint8_t>(16, 7));
  write_file(folder / "cut.png", std::vector<std::uint8_t>(image.begin(), image.begin() + 50));
  for (std::size_t i = 41; i < 60; ++i) image[i] = 0xAA;
  write_file(folder / "damaged.png", image);
  write_file(folder / "large.png", png(100000, 100000, 6, 8, std::vector<std::uint8_t>(16, 7)));
  write_file(folder / "empty.png", png(0, 0, 6, 8, {}));
  return files;
}

}  // namespace shoal::test
