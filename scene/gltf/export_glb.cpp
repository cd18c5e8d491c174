#include "scene/gltf/export_glb.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>

#include "core/error.h"
#include "scene/build/transform.h"
#include "scene/gltf/export_glb_file.h"
#include "scene/gltf/export_glb_water.h"
#include "scene/images/images.h"

namespace shoal {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF buffers are little-endian and are written as they are");

using json = nlohmann::ordered_json;  // keeps keys in the order of writing, so that the bytes are reproducible
using Bytes = std::span<const std::uint8_t>;

// The exact value of a float as JSON.
json exact(float value) { return static_cast<double>(value); }
json exact(Vec3f v) { return {exact(v.x), exact(v.y), exact(v.z)}; }

template <class T>
Bytes bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(T)};
}

constexpr int kFloat = 5126, kUnsignedInt = 5125, kUnsignedShort = 5123, kArrayBuffer = 34962,
              kElementArrayBuffer = 34963;

class GlbWriter {
 public:
  GlbWriter(const Scene& scene, std::string path) : scene_(scene), path_(std::move(path)) {}

  void build() {
    root_["asset"] = {{"version", "2.0"}, {"generator", "Shoal"}};
    add_scene();
    add_nodes();
    add_meshes();
    add_materials();
    add_cameras();
    add_lights();
    add_skins();
    add_animations();
    if (buffer_size_ > 0) root_["buffers"] = json::array({json{{"byteLength", buffer_size_}}});
    text_ = root_.dump(-1, ' ', false, json::error_handler_t::replace);
    text_.resize((text_.size() + 3) / 4 * 4, ' ');
    if (total_size() > 0xFFFFFFFFu) {
      wrong("needs " + std::to_string(total_size()) + " bytes", "expected less than 4 GiB, a .glb file's limit");
    }
  }

  void write(std::FILE* stream) const {
    write_u32(stream, 0x46546C67u);  // "glTF"
    write_u32(stream, 2);
    write_u32(stream, static_cast<std::uint32_t>(total_size()));
    write_u32(stream, static_cast<std::uint32_t>(text_.size()));
    write_u32(stream, 0x4E4F534Au);  // "JSON"
    write_bytes(stream, {reinterpret_cast<const std::uint8_t*>(text_.data()), text_.size()});
    if (buffer_size_ == 0) return;
    write_u32(stream, static_cast<std::uint32_t>(buffer_size_));
    write_u32(stream, 0x004E4942u);  // "BIN"
    const std::uint8_t zeros[3] = {0, 0, 0};
    for (const Bytes part : parts_) {
      write_bytes(stream, part);
      write_bytes(stream, {zeros, padding(part.size())});
    }
  }

 private:
  [[noreturn]] void wrong(const std::string& what, const std::string& expected) const {
    throw Error(path_ + ": the scene " + what + "; " + expected);
  }
  void require(bool ok, const std::string& what) const {
    if (!ok) wrong(what, "expected a valid scene");
  }
  void require_index(std::int32_t index, std::size_t size, bool may_be_none, const std::string& what) const {
    require((may_be_none && index == kNoIndex) || (index >= 0 && static_cast<std::size_t>(index) < size),
            "has a " + what + " numbered " + std::to_string(index));
  }

  static std::size_t padding(std::size_t size) { return (4 - size % 4) % 4; }
  std::uint64_t total_size() const { return 20 + text_.size() + (buffer_size_ > 0 ? 8 + buffer_size_ : 0); }

  void write_bytes(std::FILE* stream, Bytes bytes) const {
    if (bytes.empty()) return;
    errno = 0;
    if (std::fwrite(bytes.data(), 1, bytes.size(), stream) != bytes.size()) {
      throw Error(path_ + ": cannot be written (" + std::strerror(errno != 0 ? errno : EIO) +
                  "); expected a writable file and room for it");
    }
  }
  void write_u32(std::FILE* stream, std::uint32_t value) const {
    write_bytes(stream, {reinterpret_cast<const std::uint8_t*>(&value), sizeof value});
  }

  // Returns the number of the new bufferView.
  std::size_t add_view(Bytes bytes, int target) {
    json view = {{"buffer", 0}, {"byteOffset", buffer_size_}, {"byteLength", bytes.size()}};
    if (target != 0) view["target"] = target;
    root_["bufferViews"].push_back(std::move(view));
    parts_.push_back(bytes);
    buffer_size_ += bytes.size() + padding(bytes.size());
    return root_["bufferViews"].size() - 1;
  }

  template <class T>
  std::size_t add_accessor(const std::vector<T>& values, const char* type) {
    const bool is_index = std::is_same_v<T, std::uint32_t>;
    // This comes first: a new key in root_ moves the others.
    const std::size_t view = add_view(bytes_of(values), is_index ? kElementArrayBuffer : kArrayBuffer);
    root_["accessors"].push_back({{"bufferView", view},
                                  {"componentType", is_index ? kUnsignedInt : kFloat},
                                  {"count", values.size()},
                                  {"type", type}});
    return root_["accessors"].size() - 1;
  }

  // Adds values that the writer owns.
  template <class T>
  std::size_t add_owned(const std::vector<T>& values, int component_type, const char* type, std::size_t components) {
    const Bytes bytes = bytes_of(values);
    owned_.emplace_back(bytes.begin(), bytes.end());
    const std::size_t view = add_view(bytes_of(owned_.back()), 0);
    root_["accessors"].push_back({{"bufferView", view},
                                  {"componentType", component_type},
                                  {"count", values.size() / components},
                                  {"type", type}});
    return root_["accessors"].size() - 1;
  }

  void add_scene();
  json node_json(const Node& node) const;
  json transform_json(const LocalTransform& local) const;
  void add_joints(const MeshPrimitive& mesh, json& attributes);
  json targets_json(const MeshPrimitive& mesh);
  void add_skins();
  void add_animations();
  void add_nodes();
  void add_primitive(const MeshPrimitive& mesh, json& primitives);
  void add_meshes();
  void add_images();
  std::size_t texture_number(std::int32_t image, const Sampler& sampler);
  json map_json(std::int32_t texture, const Sampler& sampler, const UvMap& uv);
  void add_maps(const Material& material, json& out);
  json material_json(const Material& material);
  void add_materials();
  void add_cameras();
  void add_lights();
  void use_extension(const char* name) {
    json& used = root_["extensionsUsed"];
    if (std::find(used.begin(), used.end(), name) == used.end()) used.push_back(name);
  }

  const Scene& scene_;
  std::string path_;
  json root_;
  std::string text_;
  std::vector<Bytes> parts_;
  std::uint64_t buffer_size_ = 0;
  std::vector<std::vector<std::uint8_t>> images_, owned_;
  std::vector<std::int32_t> image_of_texture_;
};

void GlbWriter::add_scene() {
  json scene;
  for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
    if (scene_.nodes[i].parent == kNoIndex) scene["nodes"].push_back(i);
  }
  if (scene_.has_background && scene_.background.kind != Background::Kind::kEnvironment) {
    const Background& background = scene_.background;
    if (background.kind == Background::Kind::kColor) {
      scene["extras"]["background"] = exact(background.color);
    } else {
      scene["extras"]["background"] = {{"type", "sky"},
                                       {"zenith", exact(background.zenith)},
                                       {"horizon", exact(background.horizon)},
                                       {"ground", exact(background.ground)},
                                       {"to_sun", exact(background.to_sun_world)},
                                       {"sun", exact(background.sun)}};
    }
  }
  root_["scene"] = 0;
  root_["scenes"] = json::array({scene.is_null() ? json::object() : scene});
}

json GlbWriter::node_json(const Node& node) const {
  json out;
  if (!node.name.empty()) out["name"] = node.name;
  require_index(node.mesh, scene_.meshes.size(), true, "mesh");
  require_index(node.camera, scene_.cameras.size(), true, "camera");
  require_index(node.light, scene_.lights.size(), true, "light");
  require_index(node.water, scene_.waters.size(), true, "body of water");
  require_index(node.skin, scene_.skins.size(), true, "skin");
  if (node.mesh != kNoIndex) out["mesh"] = node.mesh;
  if (node.skin != kNoIndex) out["skin"] = node.skin;
  for (const float weight : node.morph_weights) out["weights"].push_back(exact(weight));
  if (node.camera != kNoIndex) out["camera"] = node.camera;
  if (node.light != kNoIndex) out["extensions"]["KHR_lights_punctual"]["light"] = node.light;
  if (node.water != kNoIndex) out["extras"]["water"] = water_json(scene_.waters[static_cast<std::size_t>(node.water)]);
  return out;
}

// Sixteen numbers, column by column.
json matrix_json(const Affine& m) {
  json out = json::array();
  for (int c = 0; c < 4; ++c) {
    for (const double value : {m[c].x, m[c].y, m[c].z, c == 3 ? 1.0 : 0.0}) out.push_back(value);
  }
  return out;
}

json GlbWriter::transform_json(const LocalTransform& local) const {
  json out = json::object();
  const auto triple = [](const glm::dvec3& v) { return json::array({v.x, v.y, v.z}); };
  if (local.is_matrix) {
    out["matrix"] = matrix_json(local.matrix);
  } else {
    const glm::dvec4& q = local.rotation;
    out["translation"] = triple(local.translation);
    out["rotation"] = json::array({q.x, q.y, q.z, q.w});
    out["scale"] = triple(local.scale);
  }
  return out;
}

void GlbWriter::add_nodes() {
  require(scene_.locals.empty() || scene_.locals.size() == scene_.nodes.size(),
          "has local transforms of some nodes only");
  std::vector<Affine> worlds;          // as the loader will compute them
  std::vector<std::size_t> ancestors;  // of the next node
  for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
    const Node& node = scene_.nodes[i];
    require_index(node.parent, i, true, "parent");
    while (!ancestors.empty() && static_cast<std::int32_t>(ancestors.back()) != node.parent) ancestors.pop_back();
    require(node.parent == kNoIndex || !ancestors.empty(), "has nodes that are not depth first");
    ancestors.push_back(i);

    json out = node_json(node);
    if (!scene_.locals.empty()) {
      if (node.parent != kNoIndex) root_["nodes"][static_cast<std::size_t>(node.parent)]["children"].push_back(i);
      out.update(transform_json(scene_.locals[i]));
      root_["nodes"].push_back(std::move(out));
      continue;
    }
    const Affine world = widen(node.world_from_local);
    Affine local = world;
    if (node.parent != kNoIndex) {
      const Affine& parent = worlds[static_cast<std::size_t>(node.parent)];
      Affine parent_inverse{};
      if (!inverse(parent, parent_inverse)) {
        wrong("has node '" + node.name + "' under a parent without volume", "expected parents that can be inverted");
      }
      local = product(parent_inverse, world);
      worlds.push_back(product(parent, local));
      root_["nodes"][static_cast<std::size_t>(node.parent)]["children"].push_back(i);
    } else {
      worlds.push_back(world);
    }
    if (std::memcmp(&local, &kAffineIdentity, sizeof local) != 0) out["matrix"] = matrix_json(local);
    root_["nodes"].push_back(out.is_null() ? json::object() : std::move(out));
  }
}

void GlbWriter::add_primitive(const MeshPrimitive& mesh, json& primitives) {
  const std::size_t count = mesh.positions.size();
  require(mesh.normals.size() == count && (mesh.uvs.empty() || mesh.uvs.size() == count) &&
              (mesh.colors.empty() || mesh.colors.size() == count) &&
              (mesh.uvs1.empty() || mesh.uvs1.size() == count) &&
              (mesh.tangents.empty() || mesh.tangents.size() == count),
          "has a primitive with unequal numbers of attributes");
  require(!mesh.indices.empty() && mesh.indices.size() % 3 == 0, "has a primitive without whole triangles");
  require(*std::max_element(mesh.indices.begin(), mesh.indices.end()) < count, "has an index beyond its vertices");
  require_index(mesh.material, scene_.materials.materials.size(), false, "material");

  Vec3f low = mesh.positions[0], high = low;
  for (const Vec3f p : mesh.positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  json attributes;
  attributes["POSITION"] = add_accessor(mesh.positions, "VEC3");
  root_["accessors"].back()["min"] = exact(low);
  root_["accessors"].back()["max"] = exact(high);
  if (!mesh.flat_normals) attributes["NORMAL"] = add_accessor(mesh.normals, "VEC3");
  if (!mesh.uvs.empty()) attributes["TEXCOORD_0"] = add_accessor(mesh.uvs, "VEC2");
  if (!mesh.uvs1.empty()) attributes["TEXCOORD_1"] = add_accessor(mesh.uvs1, "VEC2");
  if (!mesh.tangents.empty()) attributes["TANGENT"] = add_accessor(mesh.tangents, "VEC4");
  if (!mesh.colors.empty()) attributes["COLOR_0"] = add_accessor(mesh.colors, "VEC4");
  if (mesh.influences != 0 && !scene_.skins.empty()) add_joints(mesh, attributes);
  const std::size_t indices = add_accessor(mesh.indices, "SCALAR");
  primitives.push_back({{"attributes", std::move(attributes)}, {"indices", indices}, {"material", mesh.material}});
  if (!mesh.targets.empty()) primitives.back()["targets"] = targets_json(mesh);
}

void GlbWriter::add_joints(const MeshPrimitive& mesh, json& attributes) {
  const std::size_t count = mesh.positions.size(), influences = mesh.influences;
  require(influences % 4 == 0 && mesh.joints.size() == count * influences && mesh.weights.size() == count * influences,
          "has a primitive with unequal numbers of joints and weights");
  for (std::size_t set = 0; set < influences / 4; ++set) {
    std::vector<std::uint16_t> joints;
    std::vector<float> weights;
    for (std::size_t v = 0; v < count; ++v) {
      for (std::size_t k = v * influences + 4 * set; k < v * influences + 4 * set + 4; ++k) {
        joints.push_back(mesh.joints[k]);
        weights.push_back(mesh.weights[k]);
      }
    }
    attributes["JOINTS_" + std::to_string(set)] = add_owned(joints, kUnsignedShort, "VEC4", 4);
    attributes["WEIGHTS_" + std::to_string(set)] = add_owned(weights, kFloat, "VEC4", 4);
  }
}

json GlbWriter::targets_json(const MeshPrimitive& mesh) {
  json targets = json::array();
  const std::size_t count = mesh.positions.size();
  for (const MorphTarget& target : mesh.targets) {
    require((target.positions.empty() || target.positions.size() == count) &&
                (target.normals.empty() || target.normals.size() == count),
            "has a morph target with unequal numbers of attributes");
    json out = json::object();
    if (!target.positions.empty()) {
      Vec3f low = target.positions[0], high = low;
      for (const Vec3f p : target.positions) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
      }
      out["POSITION"] = add_accessor(target.positions, "VEC3");
      root_["accessors"].back()["min"] = exact(low);
      root_["accessors"].back()["max"] = exact(high);
    }
    if (!target.normals.empty()) out["NORMAL"] = add_accessor(target.normals, "VEC3");
    targets.push_back(std::move(out));
  }
  return targets;
}

void GlbWriter::add_skins() {
  for (const Skin& skin : scene_.skins) {
    require(!skin.joints.empty() && skin.joint_from_mesh.size() == skin.joints.size(), "has a skin without its joints");
    for (const std::int32_t joint : skin.joints) require_index(joint, scene_.nodes.size(), false, "joint");
    std::vector<float> matrices;
    for (const Mat4& m : skin.joint_from_mesh) {
      for (int c = 0; c < 4; ++c) matrices.insert(matrices.end(), {m[c].x, m[c].y, m[c].z, c < 3 ? 0.0f : 1.0f});
    }
    json out;
    if (!skin.name.empty()) out["name"] = skin.name;
    out["inverseBindMatrices"] = add_owned(matrices, kFloat, "MAT4", 16);
    out["joints"] = skin.joints;
    root_["skins"].push_back(std::move(out));
  }
}

void GlbWriter::add_animations() {
  constexpr const char* kPaths[] = {"translation", "rotation", "scale", "weights"};
  constexpr const char* kInterpolations[] = {"STEP", "LINEAR", "CUBICSPLINE"};
  for (const Animation& animation : scene_.animations) {
    json samplers = json::array(), channels = json::array();
    for (const Channel& channel : animation.channels) {
      require_index(channel.node, scene_.nodes.size(), false, "moving node");
      require(!channel.times_s.empty() && !channel.values.empty(), "has an animation channel without keys");
      const std::size_t input = add_owned(channel.times_s, kFloat, "SCALAR", 1);
      root_["accessors"].back()["min"] = json::array({exact(channel.times_s.front())});
      root_["accessors"].back()["max"] = json::array({exact(channel.times_s.back())});
      const bool rotates = channel.path == ChannelPath::kRotation, of_weights = channel.path == ChannelPath::kWeights;
      const std::size_t components = of_weights ? 1 : rotates ? 4 : 3;
      const char* type = of_weights ? "SCALAR" : rotates ? "VEC4" : "VEC3";
      const std::size_t output = add_owned(channel.values, kFloat, type, components);
      channels.push_back(
          {{"sampler", samplers.size()},
           {"target", {{"node", channel.node}, {"path", kPaths[static_cast<std::size_t>(channel.path)]}}}});
      samplers.push_back({{"input", input},
                          {"output", output},
                          {"interpolation", kInterpolations[static_cast<std::size_t>(channel.interpolation)]}});
    }
    json out;
    if (!animation.name.empty()) out["name"] = animation.name;
    out["channels"] = std::move(channels);
    out["samplers"] = std::move(samplers);
    root_["animations"].push_back(std::move(out));
  }
}

void GlbWriter::add_meshes() {
  for (const Mesh& mesh : scene_.meshes) {
    json out;
    if (!mesh.name.empty()) out["name"] = mesh.name;
    out["primitives"] = json::array();
    for (const MeshPrimitive& primitive : mesh.primitives) add_primitive(primitive, out["primitives"]);
    root_["meshes"].push_back(std::move(out));
  }
}

// The textures that materials use, in the scene's order.
void GlbWriter::add_images() {
  const std::vector<Texture>& textures = scene_.materials.textures;
  std::vector<char> used(textures.size(), 0);
  const auto use = [&](std::int32_t texture, bool as_data) {
    require_index(texture, textures.size(), true, "texture");
    if (texture == kNoTexture) return;
    used[static_cast<std::size_t>(texture)] = 1;
    require(!as_data || textures[static_cast<std::size_t>(texture)].format != TexelFormat::kRgba8Srgb,
            "reads sRGB texture " + std::to_string(texture) + " as data");
  };
  for (const Material& material : scene_.materials.materials) {
    use(material.base_color_texture, false);
    use(material.emission.texture, false);
    for (const MaterialMap* map : {&material.metallic_roughness, &material.normal, &material.occlusion}) {
      use(map->texture, true);
    }
  }
  image_of_texture_.assign(textures.size(), kNoIndex);
  images_.reserve(textures.size());
  for (std::size_t i = 0; i < textures.size(); ++i) {
    if (!used[i]) continue;
    image_of_texture_[i] = static_cast<std::int32_t>(images_.size());
    images_.push_back(encode_texture(textures[i], path_ + ": texture " + std::to_string(i)));
    const bool is_float = textures[i].format == TexelFormat::kRgba32Float;
    json image = {{"bufferView", add_view(bytes_of(images_.back()), 0)},
                  {"mimeType", is_float ? "image/x-exr" : "image/png"}};
    if (textures[i].format == TexelFormat::kRgba8Linear) image["extras"]["linear"] = true;
    root_["images"].push_back(std::move(image));
  }
}

int wrap_code(Wrap wrap) { return wrap == Wrap::kRepeat ? 10497 : wrap == Wrap::kMirror ? 33648 : 33071; }

int minify_code(const Sampler& sampler) {
  const int linear = sampler.minify == Filter::kLinear ? 1 : 0;
  if (sampler.mip == MipFilter::kNone) return 9728 + linear;
  return 9984 + linear + (sampler.mip == MipFilter::kLinear ? 2 : 0);
}

// The number of the texture for an image and a sampler; each pair is added once.
std::size_t GlbWriter::texture_number(std::int32_t image, const Sampler& sampler) {
  const auto number_of = [](json& list, const json& item) {
    if (list.is_null()) list = json::array();
    const auto it = std::find(list.begin(), list.end(), item);
    if (it != list.end()) return static_cast<std::size_t>(it - list.begin());
    list.push_back(item);
    return list.size() - 1;
  };
  const std::size_t sampler_number =
      number_of(root_["samplers"], {{"magFilter", sampler.magnify == Filter::kLinear ? 9729 : 9728},
                                    {"minFilter", minify_code(sampler)},
                                    {"wrapS", wrap_code(sampler.wrap_u)},
                                    {"wrapT", wrap_code(sampler.wrap_v)}});
  return number_of(root_["textures"], {{"sampler", sampler_number}, {"source", image}});
}

// A texture reference: the texture, its set of texture coordinates and their transform.
json GlbWriter::map_json(std::int32_t texture, const Sampler& sampler, const UvMap& uv) {
  require(uv.set == 0 || uv.set == 1, "reads texture coordinates numbered " + std::to_string(uv.set));
  json out = json::object();
  out["index"] = texture_number(image_of_texture_[static_cast<std::size_t>(texture)], sampler);
  if (uv.set != 0) out["texCoord"] = uv.set;
  if (uv.transformed) {
    out["extensions"]["KHR_texture_transform"] = {{"offset", {exact(uv.offset.x), exact(uv.offset.y)}},
                                                  {"rotation", exact(uv.rotation)},
                                                  {"scale", {exact(uv.scale.x), exact(uv.scale.y)}}};
    use_extension("KHR_texture_transform");
  }
  return out;
}

void GlbWriter::add_maps(const Material& material, json& out) {
  const auto add = [&](const MaterialMap& map, json& to, const char* key) {
    if (map.texture != kNoTexture) to[key] = map_json(map.texture, map.sampler, map.uv);
  };
  add(material.metallic_roughness, out["pbrMetallicRoughness"], "metallicRoughnessTexture");
  add(material.normal, out, "normalTexture");
  add(material.occlusion, out, "occlusionTexture");
  add(material.emission, out, "emissiveTexture");
  if (material.normal.texture != kNoTexture) out["normalTexture"]["scale"] = exact(material.normal_scale);
  if (material.occlusion.texture != kNoTexture)
    out["occlusionTexture"]["strength"] = exact(material.occlusion_strength);
  if (material.ior != 1.5f) {
    out["extensions"]["KHR_materials_ior"]["ior"] = exact(material.ior);
    use_extension("KHR_materials_ior");
  }
}

json GlbWriter::material_json(const Material& material) {
  json out;
  json& pbr = out["pbrMetallicRoughness"];
  const Vec4f base = material.base_color;
  pbr["baseColorFactor"] = {exact(base.x), exact(base.y), exact(base.z), exact(base.w)};
  pbr["metallicFactor"] = exact(material.metallic);
  pbr["roughnessFactor"] = exact(material.roughness);
  if (material.base_color_texture != kNoTexture) {
    pbr["baseColorTexture"] =
        map_json(material.base_color_texture, material.base_color_sampler, material.base_color_uv);
  }
  // glTF's factors are at most 1. A strength that is a power of two keeps every bit.
  float strength = 1;
  const Vec3f glow = material.emissive;
  while (std::max({glow.x, glow.y, glow.z}) > strength) strength *= 2;
  out["emissiveFactor"] = exact(glow / strength);
  if (strength > 1) {
    out["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = exact(strength);
    use_extension("KHR_materials_emissive_strength");
  }
  add_maps(material, out);
  if (material.alpha_mode != AlphaMode::kOpaque) {
    out["alphaMode"] = material.alpha_mode == AlphaMode::kMask ? "MASK" : "BLEND";
  }
  if (material.alpha_cutoff != 0.5f) out["alphaCutoff"] = exact(material.alpha_cutoff);
  if (material.double_sided) out["doubleSided"] = true;
  if (material.unlit) {
    out["extensions"]["KHR_materials_unlit"] = json::object();
    use_extension("KHR_materials_unlit");
  }
  return out;
}

void GlbWriter::add_materials() {
  add_images();
  for (const Material& material : scene_.materials.materials) {
    json out = material_json(material);  // first: it may add keys to root_, which move its members
    root_["materials"].push_back(std::move(out));
  }
}

void GlbWriter::add_cameras() {
  for (const CameraSpec& camera : scene_.cameras) {
    json lens;
    if (camera.orthographic) {
      lens = {{"xmag", exact(camera.xmag)}, {"ymag", exact(camera.ymag)}};
    } else {
      lens = {{"yfov", exact(camera.yfov)}};
    }
    lens["znear"] = exact(camera.znear);
    if (camera.zfar > 0) lens["zfar"] = exact(camera.zfar);
    const char* type = camera.orthographic ? "orthographic" : "perspective";
    root_["cameras"].push_back({{"type", type}, {type, std::move(lens)}});
  }
}

void GlbWriter::add_lights() {
  constexpr const char* kTypes[] = {"directional", "point", "spot"};
  for (const LightSpec& light : scene_.lights) {
    json out{{"type", kTypes[static_cast<std::size_t>(light.kind)]},
             {"color", exact(light.color)},
             {"intensity", exact(light.intensity)}};
    if (light.range_m > 0) out["range"] = exact(light.range_m);
    if (light.kind == LightKind::kSpot) {
      out["spot"] = {{"innerConeAngle", exact(light.inner_cone)}, {"outerConeAngle", exact(light.outer_cone)}};
    }
    root_["extensions"]["KHR_lights_punctual"]["lights"].push_back(std::move(out));
    use_extension("KHR_lights_punctual");
  }
}

}  // namespace

void write_glb(const Scene& scene, std::FILE* stream, const std::string& path) {
  GlbWriter writer(scene, path);
  writer.build();
  writer.write(stream);
}

void export_glb(const Scene& scene, const std::string& path) {
  GlbWriter writer(scene, path);
  writer.build();
  TemporaryFile file(path);
  writer.write(file.stream());
  file.commit();
}

}  // namespace shoal
