#include "scene/gltf/schema.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace shoal::gltf {
namespace {

using nlohmann::json;

constexpr std::uint64_t kMaxIndex = 0x7FFFFFFF;
constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 40;

// The extensions that a file may require: the loader reads enough of each to draw it.
constexpr const char* kSupportedExtensions[] = {
    "EXT_mesh_gpu_instancing", "KHR_lights_punctual", "KHR_materials_emissive_strength",
    "KHR_materials_ior",       "KHR_materials_unlit", "KHR_mesh_quantization",
    "KHR_texture_transform"};

bool is_supported(const std::string& name) {
  return std::find(std::begin(kSupportedExtensions), std::end(kSupportedExtensions), name) !=
         std::end(kSupportedExtensions);
}

enum class Need { kOptional, kRequired };

class Checker {
 public:
  Checker(Document& document, json& root) : document_(document), root_(root) {}

  void run();

 private:
  [[noreturn]] void wrong(const std::string& what, const std::string& expected) const {
    fail(document_.path, what, expected);
  }

  static std::string text_of(const json& value) {
    return one_line(value.is_structured() ? std::string(value.type_name())
                                          : value.dump(-1, ' ', false, json::error_handler_t::replace),
                    40);
  }

  // Returns a member, or null where an optional one is absent.
  json* member(json& object, const char* key, const std::string& where, Need need = Need::kOptional) const {
    const auto it = object.find(key);
    if (it != object.end()) return &*it;
    if (need == Need::kRequired) wrong(where + " has no " + key, "expected one (glTF 2.0)");
    return nullptr;
  }

  bool whole(json* value, const std::string& where, std::uint64_t min, std::uint64_t max) const {
    if (value == nullptr) return false;
    if (value->is_number_float()) {
      const double number = value->get<double>();
      if (number == std::floor(number) && number >= 0 && number < 9e15) *value = static_cast<std::uint64_t>(number);
    }
    if (!value->is_number_unsigned() || value->get<std::uint64_t>() < min || value->get<std::uint64_t>() > max) {
      wrong(where + " is " + text_of(*value),
            "expected a whole number from " + std::to_string(min) + " to " + std::to_string(max));
    }
    return true;
  }
  bool whole(json& object, const char* key, const std::string& where, std::uint64_t min, std::uint64_t max,
             Need need = Need::kOptional) const {
    return whole(member(object, key, where, need), where + "." + key, min, max);
  }

  std::size_t count(const char* section) const {
    const auto it = root_.find(section);
    return it == root_.end() ? 0 : it->size();
  }

  void index_value(json* value, const std::string& where, const char* section, std::size_t size) const {
    if (value == nullptr) return;
    if (value->is_number_float()) {
      const double number = value->get<double>();
      if (number == std::floor(number) && number >= 0 && number < 9e15) *value = static_cast<std::uint64_t>(number);
    }
    if (!value->is_number_unsigned() || value->get<std::uint64_t>() >= size) {
      wrong(where + " is " + text_of(*value),
            "expected the index of one of the file's " + std::to_string(size) + " " + section);
    }
  }
  void index(json& object, const char* key, const std::string& where, const char* section,
             Need need = Need::kOptional) const {
    index_value(member(object, key, where, need), where + "." + key, section, count(section));
  }

  void number(json& object, const char* key, const std::string& where, Need need = Need::kOptional) const {
    const json* value = member(object, key, where, need);
    if (value != nullptr && !value->is_number())
      wrong(where + "." + key + " is " + text_of(*value), "expected a number");
  }

  void numbers(json& object, const char* key, const std::string& where, std::size_t size) const {
    const json* value = member(object, key, where);
    if (value == nullptr) return;
    const bool ok = value->is_array() && (size == 0 || value->size() == size) &&
                    std::all_of(value->begin(), value->end(), [](const json& v) { return v.is_number(); });
    if (!ok) {
      wrong(where + "." + key + " is no array of " + (size == 0 ? "" : std::to_string(size) + " ") + "numbers",
            "expected one (glTF 2.0)");
    }
  }

  void string(json& object, const char* key, const std::string& where, Need need = Need::kOptional) const {
    const json* value = member(object, key, where, need);
    if (value != nullptr && !value->is_string())
      wrong(where + "." + key + " is " + text_of(*value), "expected a string");
  }
  void boolean(json& object, const char* key, const std::string& where) const {
    const json* value = member(object, key, where);
    if (value != nullptr && !value->is_boolean()) {
      wrong(where + "." + key + " is " + text_of(*value), "expected true or false");
    }
  }

  json* object(json& parent, const char* key, const std::string& where, Need need = Need::kOptional) const {
    json* value = member(parent, key, where, need);
    if (value != nullptr && !value->is_object())
      wrong(where + "." + key + " is " + text_of(*value), "expected an object");
    return value;
  }
  json* array(json& parent, const char* key, const std::string& where, Need need = Need::kOptional) const {
    json* value = member(parent, key, where, need);
    if (value != nullptr && !value->is_array())
      wrong(where + "." + key + " is " + text_of(*value), "expected an array");
    return value;
  }

  // Calls check(item, "section[i]") for each item of a section.
  template <class Check>
  void each(const char* section, Check check) const {
    json* items = member(root_, section, "the file");
    if (items == nullptr) return;
    for (std::size_t i = 0; i < items->size(); ++i) check((*items)[i], label_of(section, i));
  }

  void check_sections() const;
  void check_extensions() const;
  void check_buffers() const;
  void check_accessors() const;
  void check_compression(json& primitive, const std::string& where) const;
  void check_meshes() const;
  void check_texture_info(json& parent, const char* key, const std::string& where) const;
  void check_materials() const;
  void check_cameras_and_lights() const;
  void check_nodes() const;
  void check_trees() const;
  void check_skins() const;
  void check_animations() const;

  Document& document_;
  json& root_;
};

void Checker::check_sections() const {
  if (!root_.is_object()) wrong("is JSON, but no object", "expected a glTF 2.0 file");
  json* asset = object(root_, "asset", "the file", Need::kRequired);
  string(*asset, "version", "asset", Need::kRequired);
  const std::string version = (*asset)["version"].get<std::string>();
  if (version.rfind("2.", 0) != 0) wrong("is of glTF version " + one_line(version, 20), "expected version 2.0");
  if (json* minimum = member(*asset, "minVersion", "asset")) {
    if (*minimum != "2.0") wrong("needs glTF version " + text_of(*minimum), "expected 2.0");
  }
  for (const char* section : {"accessors", "animations", "buffers", "bufferViews", "cameras", "images", "materials",
                              "meshes", "nodes", "samplers", "scenes", "skins", "textures"}) {
    json* items = array(root_, section, "the file");
    if (items == nullptr) continue;
    if (items->size() > kMaxIndex) wrong(std::string("has too many ") + section, "expected fewer");
    for (std::size_t i = 0; i < items->size(); ++i) {
      if (!(*items)[i].is_object()) wrong(label_of(section, i) + " is " + text_of((*items)[i]), "expected an object");
      string((*items)[i], "name", label_of(section, i));
    }
  }
}

void Checker::check_extensions() const {
  std::string unsupported;
  std::set<std::string> required;
  for (const char* key : {"extensionsRequired", "extensionsUsed"}) {
    json* names = array(root_, key, "the file");
    if (names == nullptr) continue;
    for (const json& name : *names) {
      if (!name.is_string()) wrong(std::string(key) + " holds " + text_of(name), "expected strings");
      const std::string extension = name.get<std::string>();
      if (is_supported(extension)) continue;
      if (key == std::string("extensionsRequired")) {
        if (required.insert(extension).second)
          unsupported += (unsupported.empty() ? "" : ", ") + one_line(extension, 60);
      } else if (required.count(extension) == 0) {
        warn(document_, "extension " + extension + " is not read yet");
      }
    }
  }
  if (!unsupported.empty()) {
    std::string known;
    for (const char* name : kSupportedExtensions) known += (known.empty() ? "" : ", ") + std::string(name);
    wrong("requires " + unsupported, "expected none but " + known);
  }
}

void Checker::check_buffers() const {
  each("buffers", [&](json& buffer, const std::string& where) {
    whole(buffer, "byteLength", where, 1, kMaxBytes, Need::kRequired);
    string(buffer, "uri", where);
  });
  each("bufferViews", [&](json& view, const std::string& where) {
    index(view, "buffer", where, "buffers", Need::kRequired);
    whole(view, "byteOffset", where, 0, kMaxBytes);
    whole(view, "byteLength", where, 1, kMaxBytes, Need::kRequired);
    if (whole(view, "byteStride", where, 4, 252) && view["byteStride"].get<int>() % 4 != 0) {
      wrong(where + ".byteStride is " + text_of(view["byteStride"]), "expected a multiple of 4");
    }
    whole(view, "target", where, 0, kMaxIndex);
    const std::uint64_t end = view.value("byteOffset", std::uint64_t{0}) + view["byteLength"].get<std::uint64_t>();
    const std::uint64_t size = root_["buffers"][view["buffer"].get<std::size_t>()]["byteLength"].get<std::uint64_t>();
    if (end > size) {
      wrong(where + " ends at byte " + std::to_string(end),
            "expected at most " + std::to_string(size) + ", the length of its buffer");
    }
  });
}

void Checker::check_accessors() const {
  each("accessors", [&](json& accessor, const std::string& where) {
    index(accessor, "bufferView", where, "bufferViews");
    whole(accessor, "byteOffset", where, 0, kMaxBytes);
    whole(accessor, "componentType", where, 5120, 5126, Need::kRequired);
    whole(accessor, "count", where, 1, 0xFFFFFFFFu, Need::kRequired);
    string(accessor, "type", where, Need::kRequired);
    boolean(accessor, "normalized", where);
    numbers(accessor, "min", where, 0);
    numbers(accessor, "max", where, 0);
    json* sparse = object(accessor, "sparse", where);
    if (sparse == nullptr) return;
    const std::string inner = where + ".sparse";
    whole(*sparse, "count", inner, 1, kMaxIndex, Need::kRequired);
    json* indices = object(*sparse, "indices", inner, Need::kRequired);
    json* values = object(*sparse, "values", inner, Need::kRequired);
    index(*indices, "bufferView", inner + ".indices", "bufferViews", Need::kRequired);
    whole(*indices, "byteOffset", inner + ".indices", 0, kMaxIndex);
    whole(*indices, "componentType", inner + ".indices", 5120, 5126, Need::kRequired);
    index(*values, "bufferView", inner + ".values", "bufferViews", Need::kRequired);
    whole(*values, "byteOffset", inner + ".values", 0, kMaxIndex);
  });
}

// Refuses a primitive whose data are in a compressed form alone: its accessors would be read as zeros.
void Checker::check_compression(json& primitive, const std::string& where) const {
  json* extensions = object(primitive, "extensions", where);
  if (extensions == nullptr || !extensions->contains("KHR_draco_mesh_compression")) return;
  std::vector<std::size_t> accessors;
  for (const json& value : primitive["attributes"]) accessors.push_back(value.get<std::size_t>());
  if (primitive.contains("indices")) accessors.push_back(primitive["indices"].get<std::size_t>());
  for (const std::size_t accessor : accessors) {
    if (root_["accessors"][accessor].contains("bufferView")) continue;
    wrong(where + " is compressed by KHR_draco_mesh_compression and has no fallback data",
          "expected data that are not compressed");
  }
}

void Checker::check_meshes() const {
  const std::size_t accessors = count("accessors");
  const auto check_attributes = [&](json& attributes, const std::string& where) {
    for (auto& [name, value] : attributes.items()) {
      index_value(&value, where + "." + one_line(name, 40), "accessors", accessors);
    }
  };
  each("meshes", [&](json& mesh, const std::string& where) {
    json* primitives = array(mesh, "primitives", where, Need::kRequired);
    for (std::size_t i = 0; i < primitives->size(); ++i) {
      json& primitive = (*primitives)[i];
      const std::string inner = where + "." + label_of("primitives", i);
      if (!primitive.is_object()) wrong(inner + " is " + text_of(primitive), "expected an object");
      check_attributes(*object(primitive, "attributes", inner, Need::kRequired), inner + ".attributes");
      index(primitive, "indices", inner, "accessors");
      index(primitive, "material", inner, "materials");
      whole(primitive, "mode", inner, 0, 6);
      check_compression(primitive, inner);
      if (json* targets = array(primitive, "targets", inner)) {
        for (json& target : *targets) {
          if (!target.is_object()) wrong(inner + ".targets holds " + text_of(target), "expected objects");
          check_attributes(target, inner + ".targets");
        }
      }
    }
    numbers(mesh, "weights", where, 0);
  });
}

void Checker::check_texture_info(json& parent, const char* key, const std::string& where) const {
  json* info = object(parent, key, where);
  if (info == nullptr) return;
  const std::string inner = where + "." + key;
  index(*info, "index", inner, "textures", Need::kRequired);
  whole(*info, "texCoord", inner, 0, 1024);
  number(*info, "scale", inner);
  number(*info, "strength", inner);
  json* extensions = object(*info, "extensions", inner);
  json* transform = extensions == nullptr ? nullptr : object(*extensions, "KHR_texture_transform", inner);
  if (transform != nullptr) {
    numbers(*transform, "offset", inner + ".KHR_texture_transform", 2);
    numbers(*transform, "scale", inner + ".KHR_texture_transform", 2);
    number(*transform, "rotation", inner + ".KHR_texture_transform");
    whole(*transform, "texCoord", inner + ".KHR_texture_transform", 0, 1024);
  }
}

void Checker::check_materials() const {
  // The text `{}` of a material becomes some kilobytes: a copy for the library, and its default values.
  constexpr std::uint64_t kMaterialBytes = 3072;
  if (count("materials") > document_.limits.max_materials) {
    wrong("has " + std::to_string(count("materials")) + " materials",
          "expected at most " + std::to_string(document_.limits.max_materials));
  }
  charge(document_, count("materials") * kMaterialBytes,
         "the file's list of " + std::to_string(count("materials")) + " materials");
  each("materials", [&](json& material, const std::string& where) {
    if (json* pbr = object(material, "pbrMetallicRoughness", where)) {
      const std::string inner = where + ".pbrMetallicRoughness";
      numbers(*pbr, "baseColorFactor", inner, 4);
      number(*pbr, "metallicFactor", inner);
      number(*pbr, "roughnessFactor", inner);
      check_texture_info(*pbr, "baseColorTexture", inner);
      check_texture_info(*pbr, "metallicRoughnessTexture", inner);
    }
    for (const char* key : {"normalTexture", "occlusionTexture", "emissiveTexture"}) {
      check_texture_info(material, key, where);
    }
    numbers(material, "emissiveFactor", where, 3);
    number(material, "alphaCutoff", where);
    boolean(material, "doubleSided", where);
    string(material, "alphaMode", where);
    json* extensions = object(material, "extensions", where);
    json* strength = extensions == nullptr ? nullptr : object(*extensions, "KHR_materials_emissive_strength", where);
    if (strength != nullptr) number(*strength, "emissiveStrength", where);
    json* ior = extensions == nullptr ? nullptr : object(*extensions, "KHR_materials_ior", where);
    if (ior != nullptr) number(*ior, "ior", where);
  });
  each("textures", [&](json& texture, const std::string& where) {
    index(texture, "sampler", where, "samplers");
    index(texture, "source", where, "images");
  });
  each("images", [&](json& image, const std::string& where) {
    index(image, "bufferView", where, "bufferViews");
    string(image, "uri", where);
    string(image, "mimeType", where);
    if (image.contains("uri") == image.contains("bufferView")) {
      wrong(
          where + (image.contains("uri") ? " has both a URI and a bufferView" : " has neither a URI nor a bufferView"),
          "expected one of the two");
    }
  });
  each("samplers", [&](json& sampler, const std::string& where) {
    for (const char* key : {"magFilter", "minFilter", "wrapS", "wrapT"}) whole(sampler, key, where, 0, kMaxIndex);
  });
}

void Checker::check_cameras_and_lights() const {
  each("cameras", [&](json& camera, const std::string& where) {
    string(camera, "type", where, Need::kRequired);
    const std::string type = camera["type"].get<std::string>();
    if (type != "perspective" && type != "orthographic") {
      wrong(where + ".type is '" + one_line(type, 40) + "'", "expected perspective or orthographic");
    }
    json* lens = object(camera, type.c_str(), where, Need::kRequired);
    if (type == "perspective") {
      number(*lens, "yfov", where, Need::kRequired);
      number(*lens, "aspectRatio", where);
      number(*lens, "zfar", where);
    } else {
      number(*lens, "xmag", where, Need::kRequired);
      number(*lens, "ymag", where, Need::kRequired);
      number(*lens, "zfar", where, Need::kRequired);
    }
    number(*lens, "znear", where, Need::kRequired);
  });
  json* extensions = object(root_, "extensions", "the file");
  json* punctual = extensions == nullptr ? nullptr : object(*extensions, "KHR_lights_punctual", "extensions");
  json* lights = punctual == nullptr ? nullptr : array(*punctual, "lights", "KHR_lights_punctual");
  if (lights == nullptr) return;
  for (std::size_t i = 0; i < lights->size(); ++i) {
    const std::string where = label_of("KHR_lights_punctual.lights", i);
    if (!(*lights)[i].is_object()) wrong(where + " is " + text_of((*lights)[i]), "expected an object");
    string((*lights)[i], "type", where, Need::kRequired);
    string((*lights)[i], "name", where);
    numbers((*lights)[i], "color", where, 3);
    number((*lights)[i], "intensity", where);
    number((*lights)[i], "range", where);
    if (json* spot = object((*lights)[i], "spot", where)) {
      number(*spot, "innerConeAngle", where + ".spot");
      number(*spot, "outerConeAngle", where + ".spot");
    }
  }
}

void Checker::check_nodes() const {
  if (count("nodes") > document_.limits.max_nodes) {
    wrong("has " + std::to_string(count("nodes")) + " nodes",
          "expected at most " + std::to_string(document_.limits.max_nodes));
  }
  std::size_t light_count = 0;
  try {
    light_count = root_.at("extensions").at("KHR_lights_punctual").at("lights").size();
  } catch (const json::exception&) {
    light_count = 0;
  }
  each("nodes", [&](json& node, const std::string& where) {
    index(node, "mesh", where, "meshes");
    index(node, "camera", where, "cameras");
    index(node, "skin", where, "skins");
    numbers(node, "matrix", where, 16);
    numbers(node, "translation", where, 3);
    numbers(node, "rotation", where, 4);
    numbers(node, "scale", where, 3);
    numbers(node, "weights", where, 0);
    if (json* children = array(node, "children", where)) {
      for (json& child : *children) index_value(&child, where + ".children", "nodes", count("nodes"));
    }
    json* extensions = object(node, "extensions", where);
    json* instancing = extensions == nullptr ? nullptr : object(*extensions, "EXT_mesh_gpu_instancing", where);
    if (instancing != nullptr) {
      json* attributes = object(*instancing, "attributes", where + ".EXT_mesh_gpu_instancing", Need::kRequired);
      for (auto& [name, value] : attributes->items()) {
        index_value(&value, where + ".EXT_mesh_gpu_instancing." + one_line(name, 40), "accessors", count("accessors"));
      }
    }
    json* light = extensions == nullptr ? nullptr : object(*extensions, "KHR_lights_punctual", where);
    if (light != nullptr) {
      index_value(member(*light, "light", where, Need::kRequired), where + ".light", "lights", light_count);
    }
  });
  each("scenes", [&](json& scene, const std::string& where) {
    if (json* nodes = array(scene, "nodes", where)) {
      for (json& node : *nodes) index_value(&node, where + ".nodes", "nodes", count("nodes"));
    }
  });
  index(root_, "scene", "the file", "scenes");
}

// Checks that every node has at most one parent and that no node is its own ancestor.
void Checker::check_trees() const {
  std::vector<std::int64_t> parent(count("nodes"), -1);
  each("nodes", [&](json& node, const std::string& where) {
    const std::size_t self = static_cast<std::size_t>(&node - &root_["nodes"][0]);
    if (!node.contains("children")) return;
    for (const json& child : node["children"]) {
      const std::size_t c = child.get<std::size_t>();
      if (parent[c] >= 0) {
        wrong(label_of("nodes", c) + " is a child of both " + label_of("nodes", static_cast<std::size_t>(parent[c])) +
                  " and " + where,
              "expected one parent");
      }
      parent[c] = static_cast<std::int64_t>(self);
    }
  });
  // Walk up from each node. A later walk stops at nodes that an earlier one has visited.
  std::vector<std::size_t> seen_by(parent.size(), 0);
  for (std::size_t i = 0; i < parent.size(); ++i) {
    for (std::int64_t n = static_cast<std::int64_t>(i); n >= 0; n = parent[static_cast<std::size_t>(n)]) {
      std::size_t& mark = seen_by[static_cast<std::size_t>(n)];
      if (mark == i + 1)
        wrong(label_of("nodes", static_cast<std::size_t>(n)) + " is its own ancestor", "expected trees");
      if (mark != 0) break;
      mark = i + 1;
    }
  }
  each("scenes", [&](json& scene, const std::string& where) {
    if (!scene.contains("nodes")) return;
    std::set<std::size_t> roots;
    for (const json& node : scene["nodes"]) {
      const std::size_t n = node.get<std::size_t>();
      if (!roots.insert(n).second) wrong(where + " names " + label_of("nodes", n) + " twice", "expected it once");
      if (parent[n] >= 0) {
        wrong(where + " names " + label_of("nodes", n) + ", which is a child of " +
                  label_of("nodes", static_cast<std::size_t>(parent[n])),
              "expected root nodes");
      }
    }
  });
}

void Checker::check_skins() const {
  each("skins", [&](json& skin, const std::string& where) {
    index(skin, "inverseBindMatrices", where, "accessors");
    index(skin, "skeleton", where, "nodes");
    json* joints = array(skin, "joints", where, Need::kRequired);
    if (joints->empty() || joints->size() > 0xFFFFu) {
      wrong(where + " has " + std::to_string(joints->size()) + " joints", "expected 1 to 65535");
    }
    for (json& joint : *joints) index_value(&joint, where + ".joints", "nodes", count("nodes"));
  });
}

void Checker::check_animations() const {
  each("animations", [&](json& animation, const std::string& where) {
    json* samplers = array(animation, "samplers", where, Need::kRequired);
    for (std::size_t i = 0; i < samplers->size(); ++i) {
      json& sampler = (*samplers)[i];
      const std::string inner = where + "." + label_of("samplers", i);
      if (!sampler.is_object()) wrong(inner + " is " + text_of(sampler), "expected an object");
      index(sampler, "input", inner, "accessors", Need::kRequired);
      index(sampler, "output", inner, "accessors", Need::kRequired);
      string(sampler, "interpolation", inner);
    }
    json* channels = array(animation, "channels", where, Need::kRequired);
    for (std::size_t i = 0; i < channels->size(); ++i) {
      json& channel = (*channels)[i];
      const std::string inner = where + "." + label_of("channels", i);
      if (!channel.is_object()) wrong(inner + " is " + text_of(channel), "expected an object");
      index_value(member(channel, "sampler", inner, Need::kRequired), inner + ".sampler", "samplers", samplers->size());
      json* target = object(channel, "target", inner, Need::kRequired);
      index(*target, "node", inner + ".target", "nodes");
      string(*target, "path", inner + ".target", Need::kRequired);
    }
    // The specification says to ignore them; the library would refuse them.
    const std::size_t all = channels->size();
    for (std::size_t i = all; i-- > 0;) {
      if (!(*channels)[i]["target"].contains("node")) channels->erase(i);
    }
    if (channels->size() != all) warn(document_, "animation channels of no node are not read");
  });
}

void Checker::run() {
  check_sections();
  check_extensions();
  check_buffers();
  check_accessors();
  check_meshes();
  check_materials();
  check_cameras_and_lights();
  check_nodes();
  check_trees();
  check_skins();
  check_animations();
}

}  // namespace

void check_schema(Document& document, json& root) { Checker(document, root).run(); }

}  // namespace shoal::gltf
