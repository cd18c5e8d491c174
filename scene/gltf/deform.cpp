// Reads joints and weights (JOINTS_n, WEIGHTS_n) and morph targets. Source: glTF 2.0 specification, 3.7.2.2 and
// 3.7.3.3.
#include <algorithm>
#include <cmath>

#include "scene/gltf/internal.h"

namespace shoal::gltf {
namespace {

constexpr std::size_t kMaxJointSets = 8;
constexpr double kWeightSumTolerance = 1e-5;

const tinygltf::Accessor& checked(const Document& document, int accessor, int type, const char* type_name,
                                  std::uint64_t count, const std::string& label) {
  const tinygltf::Accessor& a = document.model.accessors.at(static_cast<std::size_t>(accessor));
  if (a.type != type)
    fail(document.path, label + " has elements of the wrong type", std::string("expected ") + type_name);
  if (a.count != count) {
    fail(document.path, label + " has " + std::to_string(a.count) + " elements",
         "expected " + std::to_string(count) + ", as many as there are positions");
  }
  return a;
}

void check_weight_set(const Document& document, const std::vector<float>& weights, const std::string& label) {
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] < 0) {
      fail(document.path, label + "[" + std::to_string(i / 4) + "] holds " + std::to_string(weights[i]),
           "expected weights of 0 or more");
    }
  }
}

// Scales weights to sum 1 and replaces joints of weight 0 by joint 0.
void normalize_weights(Document& document, MeshPrimitive& mesh) {
  const std::size_t n = mesh.influences;
  bool any_without = false;
  for (std::size_t first = 0; first < mesh.weights.size(); first += n) {
    double sum = 0;
    for (std::size_t k = first; k < first + n; ++k) sum += static_cast<double>(mesh.weights[k]);
    if (!(sum > 0)) {
      any_without = true;
      mesh.weights[first] = 1;
    } else if (std::fabs(sum - 1) > kWeightSumTolerance) {
      for (std::size_t k = first; k < first + n; ++k) {
        mesh.weights[k] = static_cast<float>(static_cast<double>(mesh.weights[k]) / sum);
      }
    }
    for (std::size_t k = first; k < first + n; ++k) {
      if (mesh.weights[k] == 0) mesh.joints[k] = 0;
    }
  }
  if (any_without) warn(document, "some vertices of a skin have no weights: they follow their first joint");
}

void read_joints(Document& document, const tinygltf::Primitive& primitive, std::uint64_t count,
                 const std::string& label, MeshPrimitive& mesh) {
  if (document.model.skins.empty()) return;
  std::vector<std::vector<float>> joints, weights;
  for (std::size_t set = 0;; ++set) {
    const std::string joints_name = "JOINTS_" + std::to_string(set), weights_name = "WEIGHTS_" + std::to_string(set);
    const auto j = primitive.attributes.find(joints_name), w = primitive.attributes.find(weights_name);
    const bool has_joints = j != primitive.attributes.end(), has_weights = w != primitive.attributes.end();
    if (!has_joints && !has_weights) break;
    if (has_joints != has_weights) {
      fail(document.path, label + " has " + (has_joints ? joints_name : weights_name) + " alone",
           "expected " + (has_joints ? weights_name : joints_name) + " beside it");
    }
    if (set == kMaxJointSets) {
      fail(document.path, label + " has more than 8 sets of joints", "expected at most 32 joints a vertex");
    }
    const std::string joints_label = label + "." + joints_name, weights_label = label + "." + weights_name;
    const tinygltf::Accessor& a = checked(document, j->second, TINYGLTF_TYPE_VEC4, "VEC4", count, joints_label);
    if (a.normalized || (a.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
                         a.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT)) {
      fail(document.path, joints_label + " are no joint numbers", "expected components of type 5121 or 5123");
    }
    checked(document, w->second, TINYGLTF_TYPE_VEC4, "VEC4", count, weights_label);
    joints.push_back(read_floats(document, static_cast<std::size_t>(j->second), 4, joints_label));
    weights.push_back(read_floats(document, static_cast<std::size_t>(w->second), 4, weights_label));
    check_weight_set(document, weights.back(), weights_label);
  }
  if (joints.empty()) return;
  const std::size_t sets = joints.size(), vertices = static_cast<std::size_t>(count);
  charge(document, count * sets * 4 * (sizeof(float) + sizeof(std::uint16_t)), label);
  mesh.influences = static_cast<std::uint32_t>(4 * sets);
  mesh.joints.reserve(vertices * 4 * sets);
  mesh.weights.reserve(vertices * 4 * sets);
  for (std::size_t v = 0; v < vertices; ++v) {
    for (std::size_t set = 0; set < sets; ++set) {
      for (std::size_t k = 4 * v; k < 4 * v + 4; ++k) {
        mesh.joints.push_back(static_cast<std::uint16_t>(joints[set][k]));
        mesh.weights.push_back(weights[set][k]);
      }
    }
  }
  normalize_weights(document, mesh);
}

std::vector<Vec3f> read_displacements(Document& document, int accessor, std::uint64_t count, const std::string& label) {
  checked(document, accessor, TINYGLTF_TYPE_VEC3, "VEC3", count, label);
  const std::vector<float> values = read_floats(document, static_cast<std::size_t>(accessor), 3, label);
  std::vector<Vec3f> result(values.size() / 3);
  const float limit = document.limits.max_coordinate_m;
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
    if (std::max({std::fabs(result[i].x), std::fabs(result[i].y), std::fabs(result[i].z)}) > limit) {
      fail(document.path, label + "[" + std::to_string(i) + "] is too long",
           "expected displacements of at most " + std::to_string(limit) + " m");
    }
  }
  return result;
}

void read_targets(Document& document, const tinygltf::Primitive& primitive, std::uint64_t count,
                  const std::string& label, MeshPrimitive& mesh) {
  for (std::size_t t = 0; t < primitive.targets.size(); ++t) {
    MorphTarget target;
    const std::string inner = label + "." + label_of("targets", t);
    for (const auto& [name, accessor] : primitive.targets[t]) {
      if (name == "POSITION") {
        target.positions = read_displacements(document, accessor, count, inner + ".POSITION");
      } else if (name == "NORMAL") {
        target.normals = read_displacements(document, accessor, count, inner + ".NORMAL");
      } else if (name != "TANGENT" && name.rfind("_", 0) != 0) {
        warn(document, "morph targets of " + one_line(name, 40) + " are not read yet");
      }
    }
    mesh.targets.push_back(std::move(target));
  }
}

template <class T>
std::vector<T> expanded(const std::vector<T>& values, const std::vector<std::uint32_t>& indices, std::size_t width) {
  std::vector<T> result;
  if (values.empty()) return result;
  result.reserve(indices.size() * width);
  for (const std::uint32_t i : indices) {
    for (std::size_t k = 0; k < width; ++k) result.push_back(values[i * width + k]);
  }
  return result;
}

}  // namespace

void read_deformation(Document& document, const tinygltf::Primitive& primitive, std::uint64_t vertex_count,
                      const std::string& label, MeshPrimitive& mesh) {
  read_joints(document, primitive, vertex_count, label, mesh);
  read_targets(document, primitive, vertex_count, label, mesh);
}

void expand_deformation(Document& document, MeshPrimitive& mesh, const std::string& label) {
  mesh.flat_normals = mesh.influences != 0 || !mesh.targets.empty();
  std::uint64_t corner_bytes = mesh.influences * (sizeof(float) + sizeof(std::uint16_t));
  for (const MorphTarget& target : mesh.targets) corner_bytes += target.positions.empty() ? 0 : sizeof(Vec3f);
  charge(document, mesh.indices.size() * corner_bytes, label);
  mesh.joints = expanded(mesh.joints, mesh.indices, mesh.influences);
  mesh.weights = expanded(mesh.weights, mesh.indices, mesh.influences);
  for (MorphTarget& target : mesh.targets) {
    target.positions = expanded(target.positions, mesh.indices, 1);
    target.normals.clear();  // the file has no normals to displace
  }
}

}  // namespace shoal::gltf
