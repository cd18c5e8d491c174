// Reads mesh primitives as triangle lists with normals.
#include <array>
#include <cmath>

#include "scene/build/tangents.h"
#include "scene/gltf/internal.h"

namespace shoal::gltf {
namespace {

struct Attribute {
  bool present = false;
  std::size_t accessor = 0;
  int components = 0;
};

int components_of(int type) {
  switch (type) {
    case TINYGLTF_TYPE_SCALAR:
      return 1;
    case TINYGLTF_TYPE_VEC2:
      return 2;
    case TINYGLTF_TYPE_VEC3:
      return 3;
    case TINYGLTF_TYPE_VEC4:
      return 4;
    default:
      return 0;
  }
}

Attribute find_attribute(const Document& document, const tinygltf::Primitive& primitive, const char* name,
                         int min_components, int max_components, const std::string& label) {
  const auto it = primitive.attributes.find(name);
  if (it == primitive.attributes.end()) return {};
  Attribute attribute{true, static_cast<std::size_t>(it->second), 0};
  const tinygltf::Accessor& accessor = document.model.accessors.at(attribute.accessor);
  attribute.components = components_of(accessor.type);
  if (attribute.components < min_components || attribute.components > max_components) {
    fail(document.path, label + "." + name + " has elements of the wrong type",
         "expected VEC" + std::to_string(min_components) +
             (max_components == min_components ? "" : " or VEC" + std::to_string(max_components)));
  }
  return attribute;
}

void check_count(const Document& document, const Attribute& attribute, std::uint64_t count, const char* name,
                 const std::string& label) {
  const std::uint64_t have = accessor_count(document, attribute.accessor);
  if (have != count) {
    fail(document.path, label + "." + name + " has " + std::to_string(have) + " elements",
         "expected " + std::to_string(count) + ", as many as there are positions");
  }
}

// Scales a vector to unit length where it is not (quantized normals, rounding by exporters). Zero becomes +y.
Vec3f unit_normal(Vec3f n, bool& was_zero) {
  const double x = n.x, y = n.y, z = n.z;
  const double square = (x * x + y * y) + z * z;
  if (std::fabs(square - 1.0) <= 1e-5) return n;
  if (!(square > 0)) {
    was_zero = true;
    return {0, 1, 0};
  }
  const double length = std::sqrt(square);
  return {static_cast<float>(x / length), static_cast<float>(y / length), static_cast<float>(z / length)};
}

// The geometric normal of a triangle, whose front is counter-clockwise; +y for one without area.
Vec3f flat_normal(Vec3f a, Vec3f b, Vec3f c) {
  const double ux = double{b.x} - a.x, uy = double{b.y} - a.y, uz = double{b.z} - a.z;
  const double vx = double{c.x} - a.x, vy = double{c.y} - a.y, vz = double{c.z} - a.z;
  const double x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
  const double length = std::sqrt((x * x + y * y) + z * z);
  if (!(length > 0)) return {0, 1, 0};
  return {static_cast<float>(x / length), static_cast<float>(y / length), static_cast<float>(z / length)};
}

// Turns a strip or a fan into a list of triangles; orientation is kept. Source: specification, 3.7.2.1.
std::vector<std::uint32_t> as_triangle_list(const std::vector<std::uint32_t>& corners, int mode) {
  if (mode == TINYGLTF_MODE_TRIANGLES) return corners;
  std::vector<std::uint32_t> list;
  list.reserve((corners.size() - 2) * 3);
  for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
    const std::size_t odd = i % 2;
    const std::array<std::uint32_t, 3> triangle =
        mode == TINYGLTF_MODE_TRIANGLE_STRIP
            ? std::array<std::uint32_t, 3>{corners[i], corners[i + 1 + odd], corners[i + 2 - odd]}
            : std::array<std::uint32_t, 3>{corners[i + 1], corners[i + 2], corners[0]};
    list.insert(list.end(), triangle.begin(), triangle.end());
  }
  return list;
}

std::vector<std::uint32_t> read_corners(Document& document, const tinygltf::Primitive& primitive,
                                        std::uint64_t vertex_count, const std::string& label) {
  std::vector<std::uint32_t> corners;
  if (primitive.indices >= 0) {
    corners = read_indices(document, static_cast<std::size_t>(primitive.indices), vertex_count);
  } else {
    charge(document, vertex_count * sizeof(std::uint32_t), label);
    corners.resize(static_cast<std::size_t>(vertex_count));
    for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = static_cast<std::uint32_t>(i);
  }
  const bool list = primitive.mode == TINYGLTF_MODE_TRIANGLES;
  if (corners.size() < 3 || (list && corners.size() % 3 != 0)) {
    fail(document.path, label + " has " + std::to_string(corners.size()) + " corners",
         list ? "expected a multiple of three" : "expected three or more");
  }
  if (!list) charge(document, corners.size() * 3 * sizeof(std::uint32_t), label);
  return as_triangle_list(corners, primitive.mode);
}

template <class T>
std::vector<T> expanded(const std::vector<T>& values, const std::vector<std::uint32_t>& indices) {
  std::vector<T> result;
  if (values.empty()) return result;
  result.reserve(indices.size());
  for (const std::uint32_t i : indices) result.push_back(values[i]);
  return result;
}

// Gives each corner a vertex of its own, so that each triangle has its own normal.
void generate_flat_normals(Document& document, MeshPrimitive& mesh, const std::string& label) {
  const std::uint64_t corner_bytes = 2 * sizeof(Vec3f) + (mesh.uvs.empty() ? 0 : sizeof(Vec2f)) +
                                     (mesh.uvs1.empty() ? 0 : sizeof(Vec2f)) +
                                     (mesh.colors.empty() ? 0 : sizeof(Vec4f));
  charge(document, mesh.indices.size() * corner_bytes, label);
  mesh.positions = expanded(mesh.positions, mesh.indices);
  mesh.uvs = expanded(mesh.uvs, mesh.indices);
  mesh.uvs1 = expanded(mesh.uvs1, mesh.indices);
  mesh.colors = expanded(mesh.colors, mesh.indices);
  expand_deformation(document, mesh, label);
  mesh.normals.resize(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    const std::size_t first = i / 3 * 3;
    if (i == first) {
      mesh.normals[i] = flat_normal(mesh.positions[i], mesh.positions[i + 1], mesh.positions[i + 2]);
    } else {
      mesh.normals[i] = mesh.normals[first];
    }
    mesh.indices[i] = static_cast<std::uint32_t>(i);
  }
}

void read_positions(Document& document, const Attribute& attribute, const std::string& label, MeshPrimitive& mesh) {
  const std::vector<float> values = read_floats(document, attribute.accessor, 3, label + ".POSITION");
  const float limit = document.limits.max_coordinate_m;
  mesh.positions.resize(values.size() / 3);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    mesh.positions[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::fabs(values[i]) > limit) {
      fail(document.path,
           label + ".POSITION[" + std::to_string(i / 3) + "] is " + std::to_string(values[i]) + " m away",
           "expected vertices within " + std::to_string(limit) + " m");
    }
  }
}

void read_normals(Document& document, const Attribute& attribute, const std::string& label, MeshPrimitive& mesh) {
  const std::vector<float> values = read_floats(document, attribute.accessor, 3, label + ".NORMAL");
  bool any_zero = false;
  mesh.normals.resize(values.size() / 3);
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    mesh.normals[i] = unit_normal({values[3 * i], values[3 * i + 1], values[3 * i + 2]}, any_zero);
  }
  if (any_zero) warn(document, "some normals have no length: +y is used for them");
}

// Reads one TEXCOORD set of the file; empty where the primitive has none.
std::vector<Vec2f> read_uvs(Document& document, const tinygltf::Primitive& primitive, int set, std::uint64_t count,
                            const std::string& label) {
  const std::string name = "TEXCOORD_" + std::to_string(set);
  const Attribute attribute = find_attribute(document, primitive, name.c_str(), 2, 2, label);
  if (!attribute.present) return {};
  check_count(document, attribute, count, name.c_str(), label);
  const std::vector<float> values = read_floats(document, attribute.accessor, 2, label + "." + name);
  std::vector<Vec2f> uvs(values.size() / 2);
  for (std::size_t i = 0; i < uvs.size(); ++i) uvs[i] = {values[2 * i], values[2 * i + 1]};
  return uvs;
}

// Reads tangents of unit length, w 1 or -1. A zero tangent becomes +x.
void read_tangents(Document& document, const Attribute& attribute, const std::string& label, MeshPrimitive& mesh) {
  const std::vector<float> values = read_floats(document, attribute.accessor, 4, label + ".TANGENT");
  mesh.tangents.resize(values.size() / 4);
  for (std::size_t i = 0; i < mesh.tangents.size(); ++i) {
    bool was_zero = false;
    Vec3f t = unit_normal({values[4 * i], values[4 * i + 1], values[4 * i + 2]}, was_zero);
    if (was_zero) {
      t = {1, 0, 0};
      warn(document, "some tangents have no length: +x is used for them");
    }
    mesh.tangents[i] = {t.x, t.y, t.z, values[4 * i + 3] < 0 ? -1.0f : 1.0f};
  }
}

void make_tangents(Document& document, const UvSource& source, const std::string& label, MeshPrimitive& mesh) {
  charge(document, mesh.positions.size() * 4 * sizeof(Vec4f) + mesh.indices.size() * sizeof(Vec4f), label);
  const UvMap& map = source.normal_uv;
  std::vector<Vec2f> uvs = map.set == 1 ? mesh.uvs1 : mesh.uvs;
  uvs.resize(mesh.positions.size(), Vec2f{0, 0});
  if (map.transformed) {
    for (Vec2f& uv : uvs) uv = transform_uv<float>(map, {uv, {0, 0}, {0, 0}}).uv;
  }
  generate_tangents(mesh, uvs);
}

void read_colors(Document& document, const Attribute& attribute, const std::string& label, MeshPrimitive& mesh) {
  const auto width = static_cast<std::size_t>(attribute.components);
  std::vector<float> values = read_floats(document, attribute.accessor, attribute.components, label + ".COLOR_0");
  const tinygltf::Accessor& accessor = document.model.accessors.at(attribute.accessor);
  if (accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT && !accessor.normalized) {
    warn(document, "some vertex colours are integers that are not normalized: they are read as normalized");
    const bool bytes = accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
    if (!bytes && accessor.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) {
      fail(document.path, label + ".COLOR_0 has signed integers", "expected floats, or unsigned integers, normalized");
    }
    for (float& value : values) value /= bytes ? 255.0f : 65535.0f;
  }
  mesh.colors.resize(values.size() / width);
  for (std::size_t i = 0; i < mesh.colors.size(); ++i) {
    const float* rgba = &values[i * width];
    mesh.colors[i] = {rgba[0], rgba[1], rgba[2], width == 4 ? rgba[3] : 1.0f};
  }
}

void warn_unread(Document& document, const tinygltf::Primitive& primitive) {
  for (const auto& [name, accessor] : primitive.attributes) {
    (void)accessor;
    // Sets that no texture uses and tangents without a normal map have no effect; read_deformation reads joints and
    // weights.
    const bool known = name == "POSITION" || name == "NORMAL" || name == "TANGENT" || name == "COLOR_0" ||
                       name.rfind("TEXCOORD_", 0) == 0 || name.rfind("JOINTS_", 0) == 0 ||
                       name.rfind("WEIGHTS_", 0) == 0;
    if (known || name.rfind("_", 0) == 0) continue;
    warn(document, "vertex attribute " + one_line(name, 40) + " is not read yet");
  }
}

bool is_drawn(Document& document, const tinygltf::Primitive& primitive) {
  if (primitive.mode == TINYGLTF_MODE_POINTS) {
    warn(document, "points are not drawn");
  } else if (primitive.mode >= TINYGLTF_MODE_LINE && primitive.mode <= TINYGLTF_MODE_LINE_STRIP) {
    warn(document, "lines are not drawn");
  }
  const bool has_positions = primitive.attributes.count("POSITION") != 0;
  if (!has_positions) warn(document, "primitives without POSITION are not drawn");
  return has_positions && primitive.mode >= TINYGLTF_MODE_TRIANGLES;
}

MeshPrimitive read_primitive(Document& document, const tinygltf::Primitive& primitive, const UvSource& uv_source,
                             const std::string& label) {
  const Attribute position = find_attribute(document, primitive, "POSITION", 3, 3, label);
  const Attribute normal = find_attribute(document, primitive, "NORMAL", 3, 3, label);
  const Attribute tangent = find_attribute(document, primitive, "TANGENT", 4, 4, label);
  const Attribute color = find_attribute(document, primitive, "COLOR_0", 3, 4, label);
  const std::uint64_t count = accessor_count(document, position.accessor);
  if (normal.present) check_count(document, normal, count, "NORMAL", label);
  if (tangent.present) check_count(document, tangent, count, "TANGENT", label);
  if (color.present) check_count(document, color, count, "COLOR_0", label);

  MeshPrimitive mesh;
  read_positions(document, position, label, mesh);  // first: an accessor without bytes has a limit of elements
  mesh.indices = read_corners(document, primitive, count, label);
  if (normal.present) read_normals(document, normal, label, mesh);
  mesh.uvs = read_uvs(document, primitive, uv_source.sets.empty() ? 0 : uv_source.sets[0], count, label);
  if (uv_source.sets.size() > 1) mesh.uvs1 = read_uvs(document, primitive, uv_source.sets[1], count, label);
  if (color.present) read_colors(document, color, label, mesh);
  read_deformation(document, primitive, count, label, mesh);
  if (!normal.present) generate_flat_normals(document, mesh, label);
  // Tangents without normals are ignored (specification, 3.7.2.1).
  if (uv_source.needs_tangents) {
    if (tangent.present && normal.present) {
      read_tangents(document, tangent, label, mesh);
    } else {
      make_tangents(document, uv_source, label, mesh);
    }
  }
  warn_unread(document, primitive);
  return mesh;
}

}  // namespace

void read_meshes(Document& document, Scene& scene, const std::vector<UvSource>& uv_sources) {
  std::int32_t default_material = kNoIndex;
  for (std::size_t m = 0; m < document.model.meshes.size(); ++m) {
    const tinygltf::Mesh& from = document.model.meshes[m];
    Mesh mesh;
    mesh.name = from.name;
    for (std::size_t p = 0; p < from.primitives.size(); ++p) {
      const tinygltf::Primitive& primitive = from.primitives[p];
      if (!is_drawn(document, primitive)) continue;
      const bool has_material = primitive.material >= 0;
      const UvSource uv_source = has_material ? uv_sources[static_cast<std::size_t>(primitive.material)] : UvSource{};
      mesh.primitives.push_back(
          read_primitive(document, primitive, uv_source, label_of("meshes", m) + "." + label_of("primitives", p)));
      if (!has_material && default_material == kNoIndex) {
        default_material = static_cast<std::int32_t>(scene.materials.materials.size());
        scene.materials.materials.emplace_back();
      }
      mesh.primitives.back().material = has_material ? primitive.material : default_material;
    }
    scene.meshes.push_back(std::move(mesh));
  }
}

}  // namespace shoal::gltf
