// Reads cameras, lights, and the tree of nodes, depth first.
#include <algorithm>
#include <cmath>

#include "scene/build/transform.h"
#include "scene/gltf/internal.h"

namespace shoal::gltf {
namespace {

// Rounds a number to float. Throws Error where it is not within (above, below).
float in_range(const Document& document, double value, double above, double below, const std::string& what,
               const std::string& expected) {
  const auto narrow_value = static_cast<float>(value);
  if (!(value > above && value < below) || !std::isfinite(narrow_value) || !(narrow_value > above)) {
    fail(document.path, what + " is " + std::to_string(value), "expected " + expected);
  }
  return narrow_value;
}

constexpr double kHuge = 1e30;

CameraSpec read_camera(const Document& document, const tinygltf::Camera& from, const std::string& label) {
  CameraSpec camera;
  const std::string metres = "more than 0 metres";
  if (from.type == "orthographic") {
    const tinygltf::OrthographicCamera& lens = from.orthographic;
    camera.orthographic = true;
    camera.xmag = in_range(document, lens.xmag, 0, kHuge, label + ".xmag", metres);
    camera.ymag = in_range(document, lens.ymag, 0, kHuge, label + ".ymag", metres);
    if (!(lens.znear >= 0)) {
      fail(document.path, label + ".znear is " + std::to_string(lens.znear), "expected 0 or more metres");
    }
    camera.zfar = in_range(document, lens.zfar, lens.znear, kHuge, label + ".zfar", "more than znear");
    camera.znear = static_cast<float>(lens.znear);
  } else {
    const tinygltf::PerspectiveCamera& lens = from.perspective;
    camera.yfov = in_range(document, lens.yfov, 0, 3.14159, label + ".yfov", "an angle between 0 and pi radians");
    camera.znear = in_range(document, lens.znear, 0, kHuge, label + ".znear", metres);
    if (lens.zfar != 0)
      camera.zfar = in_range(document, lens.zfar, lens.znear, kHuge, label + ".zfar", "more than znear");
  }
  return camera;
}

// Reads a light; tinygltf's range is 0 where the file gives none. Source: KHR_lights_punctual.
LightSpec read_light(Document& document, const tinygltf::Light& from, const std::string& label) {
  LightSpec light;
  const auto check = [&](double value, const char* what) {
    if (!(value >= 0 && value < kHuge)) {
      fail(document.path, label + " has a " + what + " of " + std::to_string(value), "expected 0 or more");
    }
    return static_cast<float>(value);
  };
  light.intensity = check(from.intensity, "intensity");
  if (from.color.size() == 3) {
    light.color.x = check(from.color[0], "color");
    light.color.y = check(from.color[1], "color");
    light.color.z = check(from.color[2], "color");
  }
  if (from.type == "directional") return light;
  if (from.type != "point" && from.type != "spot") {
    fail(document.path, label + " has type '" + one_line(from.type, 40) + "'", "expected directional, point or spot");
  }
  light.kind = from.type == "point" ? LightKind::kPoint : LightKind::kSpot;
  light.range_m = check(from.range, "range");
  if (light.kind == LightKind::kPoint) return light;
  constexpr double kQuarterTurn = 1.5707965;  // rounded to float, so that an exported angle is in range
  double inner = from.spot.innerConeAngle;
  const double outer = from.spot.outerConeAngle;
  if (!(inner >= 0 && outer > 0 && outer <= kQuarterTurn)) {
    fail(document.path, label + " has cone angles of " + std::to_string(inner) + " and " + std::to_string(outer),
         "expected 0 <= inner < outer <= pi / 2 radians");
  }
  if (inner > outer) {
    warn(document, label + " has an inner cone wider than its outer one: the outer one is used");
    inner = outer;
  }
  light.inner_cone = static_cast<float>(inner);
  light.outer_cone = static_cast<float>(outer);
  return light;
}

// The file's matrix is column-major.
LocalTransform matrix_transform(const Document& document, const std::vector<double>& m, const std::string& label) {
  if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) {
    fail(document.path, label + ".matrix has a projective part", "expected 0 0 0 1 as its last row");
  }
  LocalTransform local;
  local.is_matrix = true;
  for (int c = 0; c < 4; ++c) {
    const double* column = &m[4 * static_cast<std::size_t>(c)];
    local.matrix[c] = {column[0], column[1], column[2]};
  }
  return local;
}

LocalTransform local_transform(const Document& document, const tinygltf::Node& node, const std::string& label) {
  if (node.matrix.size() == 16) return matrix_transform(document, node.matrix, label);
  LocalTransform local;
  const std::vector<double>&t = node.translation, &s = node.scale, &q = node.rotation;
  if (t.size() == 3) local.translation = {t[0], t[1], t[2]};
  if (s.size() == 3) local.scale = {s[0], s[1], s[2]};
  if (q.size() != 4) return local;
  local.rotation = {q[0], q[1], q[2], q[3]};
  const double square = ((q[0] * q[0] + q[1] * q[1]) + q[2] * q[2]) + q[3] * q[3];
  if (!(square > 1e-12 && square < 1e12)) {
    fail(document.path, label + ".rotation has length " + std::to_string(std::sqrt(square)),
         "expected a unit quaternion");
  }
  return local;
}

struct Bounds {
  glm::dvec3 min{0, 0, 0}, max{0, 0, 0};
};
struct MeshSize {
  std::uint64_t triangles = 0, vertices = 0;
};
Bounds bounds_of(const Mesh& mesh) {
  Bounds bounds;
  for (const MeshPrimitive& primitive : mesh.primitives) {
    for (const Vec3f p : primitive.positions) {
      for (int i = 0; i < 3; ++i) {
        bounds.min[i] = std::fmin(bounds.min[i], static_cast<double>(p[i]));
        bounds.max[i] = std::fmax(bounds.max[i], static_cast<double>(p[i]));
      }
    }
  }
  return bounds;
}

class TreeReader {
 public:
  TreeReader(Document& document, Scene& scene) : document_(document), scene_(scene) {
    for (const Mesh& mesh : scene.meshes) {
      bounds_.push_back(bounds_of(mesh));
      MeshSize size;
      for (const MeshPrimitive& primitive : mesh.primitives) {
        size.triangles += primitive.indices.size() / 3;
        size.vertices += primitive.positions.size();
      }
      sizes_.push_back(size);
    }
  }

  // Traverses depth first without recursion, because a file may nest its nodes deeper than the call stack allows.
  void run(const std::vector<int>& roots) {
    struct Visit {
      int node;
      std::int32_t parent;
      int depth;
    };
    std::vector<Visit> stack;
    for (auto it = roots.rbegin(); it != roots.rend(); ++it) stack.push_back({*it, kNoIndex, 1});
    while (!stack.empty()) {
      const Visit visit = stack.back();
      stack.pop_back();
      if (visit.depth > document_.limits.max_node_depth) {
        fail(document_.path, "nests nodes deeper than " + std::to_string(document_.limits.max_node_depth) + " levels",
             "expected a flatter tree");
      }
      const auto here = static_cast<std::int32_t>(scene_.nodes.size());
      add(static_cast<std::size_t>(visit.node), visit.parent);
      const std::vector<int>& children = document_.model.nodes[static_cast<std::size_t>(visit.node)].children;
      for (auto it = children.rbegin(); it != children.rend(); ++it) stack.push_back({*it, here, visit.depth + 1});
    }
  }

 private:
  void add(std::size_t index, std::int32_t parent) {
    const tinygltf::Node& from = document_.model.nodes[index];
    const std::string label = label_of("nodes", index, from.name);
    document_.node_places[index] = static_cast<std::int32_t>(scene_.nodes.size());
    Node node;
    node.name = from.name;
    node.camera = from.camera >= 0 ? from.camera : kNoIndex;
    if (node.camera != kNoIndex && node.name.empty()) {
      node.name = document_.model.cameras[static_cast<std::size_t>(from.camera)].name;
    }
    read_extensions(from, node, label);
    WaterSpec water;
    if (read_water(document_, from.extras, label, water)) {
      if (!water.has_size && from.mesh < 0) {
        fail(document_.path, label + " is water without a size and without a mesh",
             "expected extras.water.size, or a planar mesh as its outline");
      }
      node.water = static_cast<std::int32_t>(scene_.waters.size());
      scene_.waters.push_back(water);
    }
    const std::vector<LocalTransform> instances = instances_of(from, node, label);
    node.mesh = from.mesh >= 0 && instances.empty() ? from.mesh : kNoIndex;
    place(std::move(node), parent, local_transform(document_, from, label), label);
    add_instances(index, instances, label);
  }

  // The instances of a node's mesh; empty where it is drawn once.
  std::vector<LocalTransform> instances_of(const tinygltf::Node& from, const Node& node, const std::string& label) {
    std::vector<LocalTransform> instances = read_instances(document_, from, label);
    if (instances.empty()) return instances;
    if (from.skin >= 0) {
      warn(document_, "instances of a skinned mesh are not read: it is drawn once");
      instances.clear();
    } else if (node.water != kNoIndex && !scene_.waters.back().has_size) {
      fail(document_.path, label + " is water whose outline is instanced", "expected extras.water.size, or one mesh");
    }
    return instances;
  }

  void add_instances(std::size_t index, const std::vector<LocalTransform>& instances, const std::string& label) {
    document_.instance_counts[index] = static_cast<std::uint32_t>(instances.size());
    if (instances.size() + scene_.nodes.size() > document_.limits.max_nodes) {
      fail(document_.path, "has more than " + std::to_string(document_.limits.max_nodes) + " nodes and instances",
           "expected fewer");
    }
    const tinygltf::Node& from = document_.model.nodes[index];
    for (const LocalTransform& local : instances) {
      Node node;
      node.name = from.name;
      node.mesh = from.mesh;
      place(std::move(node), document_.node_places[index], local, label);
    }
  }

  void place(Node node, std::int32_t parent, const LocalTransform& local_parts, const std::string& label) {
    node.parent = parent;
    const Affine local = local_affine(local_parts);
    const Affine world = parent == kNoIndex ? local : product(worlds_[static_cast<std::size_t>(parent)], local);
    node.world_from_local = narrow(world);
    check_finite(node.world_from_local, label);
    worlds_.push_back(world);
    if (node.mesh != kNoIndex) count_mesh(static_cast<std::size_t>(node.mesh), world, label);
    scene_.locals.push_back(local_parts);
    scene_.nodes.push_back(std::move(node));
  }

  void check_finite(const Mat4& m, const std::string& label) const {
    for (int c = 0; c < 4; ++c) {
      if (!std::isfinite(m[c].x) || !std::isfinite(m[c].y) || !std::isfinite(m[c].z)) {
        fail(document_.path, label + " has a transform that overflows", "expected finite numbers");
      }
    }
  }

  void count_mesh(std::size_t mesh, const Affine& world, const std::string& label) {
    total_triangles_ += sizes_[mesh].triangles;
    if (total_triangles_ > document_.limits.max_triangles) {
      fail(document_.path, "draws more than " + std::to_string(document_.limits.max_triangles) + " triangles",
           "expected fewer (meshes count once for each node)");
    }
    // All vertices of a mesh are transformed for each node that uses it, also those that no triangle uses.
    charge(document_,
           sizes_[mesh].vertices * (sizeof(VertexRecord) + sizeof(Vec3f)) +
               sizes_[mesh].triangles * (sizeof(Geometry::TriangleRecord) + 3),
           label);
    const Bounds& b = bounds_[mesh];
    for (int r = 0; r < 3; ++r) {
      double reach = std::fabs(world[3][r]);
      for (int i = 0; i < 3; ++i) reach += std::fabs(world[i][r]) * std::fmax(-b.min[i], b.max[i]);
      if (!(reach <= 4.0 * static_cast<double>(document_.limits.max_coordinate_m))) {
        fail(document_.path, label + " reaches " + std::to_string(reach) + " m from the origin",
             "expected vertices within " + std::to_string(document_.limits.max_coordinate_m) + " m");
      }
    }
  }

  void read_extensions(const tinygltf::Node& from, Node& node, const std::string& label) {
    for (const auto& [name, value] : from.extensions) {
      if (name == "EXT_mesh_gpu_instancing") continue;
      if (name != "KHR_lights_punctual") {
        warn(document_, "extension " + one_line(name, 60) + " is not read yet");
        continue;
      }
      // check_schema has checked the index in the JSON; this checks the parsed copy.
      const int light = value.IsObject() && value.Has("light") ? value.Get("light").GetNumberAsInt() : -1;
      if (light < 0 || static_cast<std::size_t>(light) >= scene_.lights.size()) {
        fail(document_.path, label + " names light " + std::to_string(light), "expected one of the file's lights");
      }
      node.light = light;
    }
  }

  Document& document_;
  Scene& scene_;
  std::vector<Bounds> bounds_;
  std::vector<MeshSize> sizes_;
  std::vector<Affine> worlds_;
  std::uint64_t total_triangles_ = 0;
};

}  // namespace

void read_nodes(Document& document, Scene& scene) {
  const tinygltf::Model& model = document.model;
  for (std::size_t i = 0; i < model.cameras.size(); ++i) {
    scene.cameras.push_back(read_camera(document, model.cameras[i], label_of("cameras", i, model.cameras[i].name)));
  }
  for (std::size_t i = 0; i < model.lights.size(); ++i) {
    scene.lights.push_back(read_light(document, model.lights[i], label_of("lights", i, model.lights[i].name)));
  }
  document.node_places.assign(model.nodes.size(), kNoIndex);
  document.instance_counts.assign(model.nodes.size(), 0);
  TreeReader reader(document, scene);
  read_background(document, model.asset.extras, "asset", scene);
  if (model.scenes.empty()) fail(document.path, "has no scene", "expected at least one");
  const auto first = static_cast<std::size_t>(model.defaultScene >= 0 ? model.defaultScene : 0);
  if (model.scenes.size() > 1) {
    warn(document, "scenes other than " + label_of("scenes", first, model.scenes[first].name) + " are not drawn");
  }
  reader.run(model.scenes[first].nodes);
  read_background(document, model.scenes[first].extras, label_of("scenes", first), scene);
  read_environment(document, model.scenes[first].extras, label_of("scenes", first), scene);
}

}  // namespace shoal::gltf
