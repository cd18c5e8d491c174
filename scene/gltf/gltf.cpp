#include "scene/gltf/gltf.h"

#include <algorithm>

#include "scene/gltf/internal.h"

namespace shoal {
namespace gltf {

std::string one_line(const std::string& text, std::size_t max_length) {
  std::string line;
  for (const char c : text) {
    const bool space = static_cast<unsigned char>(c) <= ' ' || c == '\x7f';
    if (space && (line.empty() || line.back() == ' ')) continue;
    line.push_back(space ? ' ' : c);
    if (line.size() > max_length) {
      line.resize(max_length);
      // Do not cut inside a UTF-8 sequence.
      while (!line.empty() && (static_cast<unsigned char>(line.back()) & 0xC0u) == 0x80u) line.pop_back();
      if (!line.empty() && (static_cast<unsigned char>(line.back()) & 0x80u) != 0) line.pop_back();
      return line + "...";
    }
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

void fail(const std::string& path, const std::string& what, const std::string& expected) {
  throw Error(one_line(path, 4096) + ": " + one_line(what, 400) + "; " + one_line(expected, 400));
}

void warn(Document& document, const std::string& line) {
  constexpr std::size_t kMaxLines = 64;
  const std::string text = one_line(line, 400);
  auto& lines = document.warnings;
  if (lines.size() > kMaxLines || std::find(lines.begin(), lines.end(), text) != lines.end()) return;
  lines.push_back(lines.size() < kMaxLines ? text : "further warnings are left out");
}

void charge(Document& document, std::uint64_t bytes, const std::string& what) {
  const std::uint64_t limit = document.limits.max_scene_bytes;
  if (bytes > limit || document.scene_bytes > limit - bytes) {
    fail(document.path, what + " brings the scene over the memory limit",
         "expected meshes and textures of at most " + std::to_string(limit >> 20) + " MiB in all");
  }
  document.scene_bytes += bytes;
}

std::string label_of(const char* section, std::size_t index, const std::string& name) {
  std::string label = section;
  label += "[" + std::to_string(index) + "]";
  if (!name.empty()) label += " '" + one_line(name, 60) + "'";
  return label;
}

}  // namespace gltf

Scene load_gltf(const std::string& path, const LoadLimits& limits) {
  gltf::Document document;
  document.path = path;
  document.limits = limits;
  try {
    gltf::parse_file(document);
    Scene scene;
    scene.name = path;
    const std::vector<gltf::UvSource> uv_sources = gltf::read_materials(document, scene);
    gltf::read_meshes(document, scene, uv_sources);
    gltf::read_nodes(document, scene);
    gltf::read_motion(document, scene);
    scene.warnings = std::move(document.warnings);
    return scene;
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    gltf::fail(path, "not enough memory to load this scene", "expected a smaller scene or a larger machine");
  } catch (const std::exception& e) {
    gltf::fail(path, std::string("cannot be read (") + e.what() + ")", "expected a glTF 2.0 file");
  }
}

}  // namespace shoal
