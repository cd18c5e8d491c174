// Reads instances of a mesh. Source: EXT_mesh_gpu_instancing (Khronos Group, 2023).
#include <algorithm>

#include "scene/gltf/internal.h"

namespace shoal::gltf {
namespace {

constexpr const char* kName = "EXT_mesh_gpu_instancing";

// Reads one part of the transforms, `width` doubles an instance; empty where the file has none.
std::vector<double> read_part(Document& document, const tinygltf::Value& attributes, const char* name, int type,
                              int width, std::uint64_t& count, const std::string& label) {
  if (!attributes.Has(name)) return {};
  const std::string inner = label + "." + name;
  const auto index = static_cast<std::size_t>(attributes.Get(name).GetNumberAsInt());  // check_schema has checked it
  if (index >= document.model.accessors.size()) fail(document.path, inner + " has no accessor", "expected one");
  const tinygltf::Accessor& accessor = document.model.accessors[index];
  if (accessor.type != type) {
    fail(document.path, inner + " has elements of the wrong type", "expected VEC" + std::to_string(width));
  }
  if (count != 0 && accessor.count != count) {
    fail(document.path, inner + " has " + std::to_string(accessor.count) + " elements",
         "expected " + std::to_string(count) + ", as many as the others");
  }
  count = accessor.count;
  if (count > document.limits.max_nodes) {
    fail(document.path, inner + " has " + std::to_string(count) + " instances",
         "expected at most " + std::to_string(document.limits.max_nodes) + ", the limit of nodes");
  }
  const std::vector<float> values = read_floats(document, index, width, inner);
  return {values.begin(), values.end()};
}

}  // namespace

std::vector<LocalTransform> read_instances(Document& document, const tinygltf::Node& node, const std::string& label) {
  const auto found = node.extensions.find(kName);
  if (found == node.extensions.end() || node.mesh < 0) return {};
  const tinygltf::Value& attributes = found->second.Get("attributes");
  if (!attributes.IsObject()) fail(document.path, label + "." + kName + " has no attributes", "expected some");
  const std::string where = label + "." + kName;
  std::uint64_t count = 0;
  const auto translations = read_part(document, attributes, "TRANSLATION", TINYGLTF_TYPE_VEC3, 3, count, where);
  const auto rotations = read_part(document, attributes, "ROTATION", TINYGLTF_TYPE_VEC4, 4, count, where);
  const auto scales = read_part(document, attributes, "SCALE", TINYGLTF_TYPE_VEC3, 3, count, where);
  if (count == 0)
    warn(document, std::string(kName).append(" without TRANSLATION, ROTATION and SCALE is not read: drawn once"));
  charge(document, count * (sizeof(LocalTransform) + sizeof(shoal::Node) + node.name.size()), where);
  std::vector<LocalTransform> instances(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < instances.size(); ++i) {
    LocalTransform& local = instances[i];
    const auto triple = [i](const std::vector<double>& v) { return glm::dvec3{v[3 * i], v[3 * i + 1], v[3 * i + 2]}; };
    if (!translations.empty()) local.translation = triple(translations);
    if (!rotations.empty()) {
      local.rotation = {rotations[4 * i], rotations[4 * i + 1], rotations[4 * i + 2], rotations[4 * i + 3]};
    }
    if (!scales.empty()) local.scale = triple(scales);
  }
  return instances;
}

}  // namespace shoal::gltf
