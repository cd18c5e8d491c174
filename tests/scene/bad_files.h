// Crafted glTF files, one valid and many invalid ones, and PNG files written by hand.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "scene/gltf/gltf.h"

namespace shoal::test {

// A folder of its own under the system's temporary folder, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

void write_file(const std::string& path, const std::vector<std::uint8_t>& bytes);
void write_file(const std::string& path, const std::string& text);
std::vector<std::uint8_t> read_whole_file(const std::string& path);

// JSON and one buffer; views and accessors are added together.
struct CraftedFile {
  nlohmann::json root;
  std::vector<std::uint8_t> bin;

  // Appends data as a new bufferView at a multiple of four bytes; returns its number.
  std::size_t add_view(const void* data, std::size_t size, std::size_t stride = 0);
  // Appends data and an accessor over it; returns the accessor's number.
  std::size_t add_accessor(const void* data, std::size_t size, int component_type, const char* type, std::size_t count,
                           bool normalized = false);
  std::size_t add_floats(const std::vector<float>& values, const char* type, std::size_t components);
  // Adds a mesh with one primitive, and a node for it in the scene; returns the mesh's number.
  std::size_t add_mesh(nlohmann::json primitive);

  std::string save_gltf(const std::string& path) const;  // the buffer as a data URI
  std::vector<std::uint8_t> glb() const;
  std::string save_glb(const std::string& path) const;
};

// The message that refuses the file as a .glb, or "loaded".
inline std::string error_of(const CraftedFile& file, const LoadLimits& limits = {}) {
  const TemporaryFolder folder;
  try {
    load_gltf(file.save_glb(folder / "scene.glb"), limits);
  } catch (const Error& e) {
    return e.what();
  }
  return "loaded";
}

// An empty scene.
CraftedFile empty_file();
// A lit, textured, indexed triangle with normals and texture coordinates, a camera, a light and a body of water.
CraftedFile good_file();

// A PNG with stored (uncompressed) data: no encoder is trusted in a test of a decoder.
//   color_type  0 grey, 2 RGB, 4 grey and alpha, 6 RGBA;  depth  8 or 16 bits
std::vector<std::uint8_t> png(std::uint32_t width, std::uint32_t height, int color_type, int depth,
                              const std::vector<std::uint8_t>& rows);

// Appends a chunk of a PNG, checksum and all.
void append_png_chunk(std::vector<std::uint8_t>& file, const char* type, const std::vector<std::uint8_t>& data);

struct BadFile {
  std::string path;
  std::string message_part;  // a part of the message
};
std::vector<BadFile> write_bad_files(const TemporaryFolder& folder);

}  // namespace shoal::test
