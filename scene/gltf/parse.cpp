// Parses a file into a checked Document: container, JSON, buffers, and the model by tinygltf, which opens no file
// itself.
#include <algorithm>
#include <cstring>
#include <filesystem>

#include "scene/gltf/internal.h"
#include "scene/gltf/schema.h"

namespace shoal::gltf {
namespace {

using nlohmann::json;

std::uint32_t read_u32(Bytes bytes, std::size_t at) {
  return static_cast<std::uint32_t>(bytes[at]) | static_cast<std::uint32_t>(bytes[at + 1]) << 8 |
         static_cast<std::uint32_t>(bytes[at + 2]) << 16 | static_cast<std::uint32_t>(bytes[at + 3]) << 24;
}

struct Container {
  Bytes json, bin;
  bool has_bin = false;
};

// Splits a binary file into its chunks. Source: glTF 2.0 specification, 4.4.
Container split_glb(const Document& document) {
  const Bytes file = document.file;
  const std::string& path = document.path;
  if (file.size() < 20) {
    fail(path, "is a .glb of " + std::to_string(file.size()) + " bytes, shorter than its header",
         "expected 20 bytes or more: truncated?");
  }
  const std::uint32_t version = read_u32(file, 4);
  if (version != 2) fail(path, "is of glTF version " + std::to_string(version), "expected version 2");
  const std::uint64_t length = read_u32(file, 8);
  if (length > file.size()) {
    fail(path,
         "is truncated: its header says " + std::to_string(length) + " bytes, it has " + std::to_string(file.size()),
         "expected the whole file");
  }
  const std::uint64_t json_length = read_u32(file, 12);
  if (read_u32(file, 16) != 0x4E4F534Au) fail(path, "has no JSON as its first chunk", "expected a glTF 2.0 .glb file");
  if (json_length > length || 20 + json_length > length) {
    fail(path, "has a JSON chunk of " + std::to_string(json_length) + " bytes that runs over the file's end",
         "expected at most " + std::to_string(length < 20 ? 0 : length - 20));
  }
  Container parts;
  parts.json = file.subspan(20, static_cast<std::size_t>(json_length));
  // The specification pads the chunk to four bytes. Older exporters do not: the binary chunk follows at once.
  const auto is_binary_at = [&](std::uint64_t at) {
    return at + 8 <= length && read_u32(file, static_cast<std::size_t>(at) + 4) == 0x004E4942u;
  };
  std::uint64_t next = (20 + json_length + 3) / 4 * 4;
  if (!is_binary_at(next) && is_binary_at(20 + json_length)) next = 20 + json_length;
  if (next + 8 > length) return parts;
  const std::uint64_t bin_length = read_u32(file, static_cast<std::size_t>(next));
  if (read_u32(file, static_cast<std::size_t>(next) + 4) != 0x004E4942u) return parts;  // chunks unknown to glTF 2.0
  if (bin_length > length - next - 8) {
    fail(path, "has a binary chunk of " + std::to_string(bin_length) + " bytes that runs over the file's end",
         "expected at most " + std::to_string(length - next - 8));
  }
  parts.bin = file.subspan(static_cast<std::size_t>(next) + 8, static_cast<std::size_t>(bin_length));
  parts.has_bin = true;
  return parts;
}

// Counts nesting depth and values before a library parses the text: parsers recurse, and a value of two bytes of text
// can take 150 bytes of memory.
void check_shape(const Document& document, Bytes text) {
  int depth = 0;
  std::uint64_t values = 1;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::uint8_t c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == ',') {
      ++values;
    } else if (c == '[' || c == '{') {
      ++values;
      if (++depth > document.limits.max_json_depth) {
        fail(document.path, "has JSON nested deeper than " + std::to_string(document.limits.max_json_depth) + " levels",
             "expected a glTF 2.0 file");
      }
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  if (values > document.limits.max_json_values) {
    fail(document.path, "has JSON of about " + std::to_string(values) + " values",
         "expected at most " + std::to_string(document.limits.max_json_values));
  }
}

json parse_json(const Document& document, Bytes text) {
  if (std::all_of(text.begin(), text.end(), [](std::uint8_t c) { return c <= ' '; })) {
    fail(document.path, "holds no JSON", "expected a glTF 2.0 file");
  }
  check_shape(document, text);
  try {
    return json::parse(text.begin(), text.end());
  } catch (const json::exception& e) {
    std::string message = e.what();
    const std::size_t prefix = message.find("] ");
    if (prefix != std::string::npos) message = message.substr(prefix + 2);
    fail(document.path, "is no valid JSON (" + one_line(message) + ")", "expected a glTF 2.0 file");
  }
}

bool is_data_uri(const std::string& uri) { return uri.rfind("data:", 0) == 0; }

std::vector<std::uint8_t> decode_data_uri(const Document& document, const std::string& uri, const std::string& label) {
  std::vector<unsigned char> bytes;
  std::string mime_type;
  const std::size_t comma = uri.find(',');
  if (!tinygltf::DecodeDataURI(&bytes, mime_type, uri, 0, false) || comma == std::string::npos) {
    fail(document.path, label + " has a data URI that cannot be decoded (" + one_line(uri.substr(0, 40), 40) + "...)",
         "expected base64 data of application/octet-stream, application/gltf-buffer, image/png or image/jpeg");
  }
  // The decoder stops without an error at the first character that is not base64.
  std::size_t digits = uri.size() - comma - 1;
  while (digits > 0 && uri[comma + digits] == '=') --digits;
  if (bytes.size() != digits * 3 / 4) {
    fail(document.path, label + " has a data URI with characters that are not base64", "expected base64 data");
  }
  return bytes;
}

void load_buffers(Document& document, const json& root, const Container& parts) {
  if (!root.contains("buffers")) return;
  const json& buffers = root["buffers"];
  document.buffer_storage.resize(buffers.size());
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const std::string label = label_of("buffers", i);
    const std::uint64_t length = buffers[i]["byteLength"].get<std::uint64_t>();
    Bytes bytes;
    if (!buffers[i].contains("uri")) {
      const bool meshopt =
          buffers[i].contains("extensions") && buffers[i]["extensions"].contains("EXT_meshopt_compression");
      if (meshopt && (i != 0 || !parts.has_bin)) {
        fail(document.path, label + " is compressed by EXT_meshopt_compression and has no fallback data",
             "expected data that are not compressed");
      }
      if (i != 0 || !parts.has_bin) {
        fail(document.path, label + " has no URI" + (i == 0 ? " and the file no binary chunk" : ""),
             "expected where its bytes are");
      }
      bytes = parts.bin;
      // Padding makes the chunk up to three bytes longer than the buffer; the loader ignores further bytes.
    } else {
      const std::string& uri = buffers[i]["uri"].get_ref<const std::string&>();
      std::vector<std::uint8_t>& storage = document.buffer_storage[i];
      storage = is_data_uri(uri)
                    ? decode_data_uri(document, uri, label)
                    : read_file(resolve_uri(document, uri, label), document.limits.max_file_bytes, document.path);
      bytes = storage;
    }
    if (bytes.size() < length) {
      fail(document.path, label + " has " + std::to_string(bytes.size()) + " bytes",
           "expected " + std::to_string(length) + " (its byteLength)");
    }
    document.buffers.push_back(bytes.first(static_cast<std::size_t>(length)));
  }
}

void list_images(Document& document, const json& root) {
  if (!root.contains("images")) return;
  const json& images = root["images"];
  for (std::size_t i = 0; i < images.size(); ++i) {
    EncodedImage image;
    image.label = label_of("images", i, images[i].value("name", std::string()));
    if (images[i].contains("uri")) {
      const std::string& uri = images[i]["uri"].get_ref<const std::string&>();
      if (is_data_uri(uri)) {
        image.storage = decode_data_uri(document, uri, image.label);
      } else {
        image.uri = uri;
        image.label = label_of("images", i, uri);
      }
    } else {
      const json& view = root["bufferViews"][images[i]["bufferView"].get<std::size_t>()];
      const Bytes buffer = document.buffers[view["buffer"].get<std::size_t>()];
      image.bytes = buffer.subspan(view.value("byteOffset", std::size_t{0}), view["byteLength"].get<std::size_t>());
    }
    if (images[i].contains("extras")) image.srgb = images[i]["extras"] != json{{"linear", true}};
    document.images.push_back(std::move(image));
    if (!document.images.back().storage.empty()) document.images.back().bytes = document.images.back().storage;
  }
}

// These callbacks keep the library from opening files.
tinygltf::FsCallbacks closed_file_system() {
  tinygltf::FsCallbacks callbacks{};
  callbacks.FileExists = [](const std::string&, void*) { return false; };
  callbacks.ExpandFilePath = [](const std::string& name, void*) { return name; };
  callbacks.ReadWholeFile = [](std::vector<unsigned char>*, std::string*, const std::string&, void*) { return false; };
  callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
  };
  return callbacks;
}

// Converts extras with everything that they hold: the library leaves out null, empty objects and empty arrays.
tinygltf::Value value_of(const json& from) {
  if (from.is_boolean()) return tinygltf::Value(from.get<bool>());
  if (from.is_number()) return tinygltf::Value(from.get<double>());
  if (from.is_string()) return tinygltf::Value(from.get<std::string>());
  if (from.is_array()) {
    tinygltf::Value::Array array;
    for (const json& item : from) array.push_back(value_of(item));
    return tinygltf::Value(std::move(array));
  }
  if (!from.is_object()) return tinygltf::Value();
  tinygltf::Value::Object object;
  for (const auto& [key, item] : from.items()) object.emplace(key, value_of(item));
  return tinygltf::Value(std::move(object));
}

// Replaces the extras that the loader reads by complete ones.
void restore_extras(Document& document, const json& root) {
  const auto extras_of = [](const json& from) {
    const auto it = from.find("extras");
    return it == from.end() ? tinygltf::Value() : value_of(*it);
  };
  tinygltf::Model& model = document.model;
  model.asset.extras = extras_of(root["asset"]);
  for (std::size_t i = 0; i < model.nodes.size(); ++i) model.nodes[i].extras = extras_of(root["nodes"][i]);
  for (std::size_t i = 0; i < model.scenes.size(); ++i) model.scenes[i].extras = extras_of(root["scenes"][i]);
}

// What the library refuses though the format allows it: filled in before the library reads the file, removed after.
struct Completed {
  std::vector<std::size_t> skins;      // without inverseBindMatrices, which means identity (glTF 2.0, 3.7.3.1)
  std::vector<std::size_t> accessors;  // of indices without bufferView, which means zeros (glTF 2.0, 3.6.2.3)
};

Completed complete(json& root) {
  Completed completed;
  if (root.contains("skins")) {
    for (std::size_t i = 0; i < root["skins"].size(); ++i) {
      if (root["skins"][i].contains("inverseBindMatrices")) continue;
      root["skins"][i]["inverseBindMatrices"] = 0;
      completed.skins.push_back(i);
    }
  }
  if (!root.contains("meshes")) return completed;
  for (const json& mesh : root["meshes"]) {
    for (const json& primitive : mesh["primitives"]) {
      if (!primitive.contains("indices")) continue;
      const auto i = primitive["indices"].get<std::size_t>();
      if (root["accessors"][i].contains("bufferView")) continue;
      root["accessors"][i]["bufferView"] = 0;
      completed.accessors.push_back(i);
    }
  }
  // The library wants a bufferView of that number; a file of zeros may have none.
  if (!completed.accessors.empty() && root.value("bufferViews", json::array()).empty()) {
    root["bufferViews"] = json::array({{{"buffer", 0}, {"byteLength", 1}}});
  }
  return completed;
}

void restore(Document& document, const Completed& completed) {
  for (const std::size_t i : completed.skins) document.model.skins.at(i).inverseBindMatrices = -1;
  for (const std::size_t i : completed.accessors) document.model.accessors.at(i).bufferView = -1;
}

void run_tinygltf(Document& document, json& root) {
  // The loader reads buffers and images itself with bounds checks, because the library does not check all ranges.
  root.erase("buffers");
  root.erase("images");
  const Completed completed = complete(root);
  const std::string text = root.dump();
  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks(closed_file_system());
  std::string errors, warnings;
  const bool ok = loader.LoadASCIIFromString(&document.model, &errors, &warnings, text.data(),
                                             static_cast<unsigned int>(text.size()), "", tinygltf::REQUIRE_VERSION);
  // The library reports success even where it drops data that it cannot parse; `errors` names them.
  if (!ok || !errors.empty()) {
    const std::string message = one_line(errors);
    fail(document.path, "is no valid glTF (" + (message.empty() ? "no reason given" : message) + ")",
         "expected a glTF 2.0 file");
  }
  restore(document, completed);
  restore_extras(document, root);
}

}  // namespace

void parse_file(Document& document) {
  document.folder = std::filesystem::path(document.path).parent_path().string();
  document.file = read_file(document.path, document.limits.max_file_bytes, document.path);
  if (document.file.empty()) fail(document.path, "is empty", "expected a glTF 2.0 file");

  Container parts;
  const bool binary = document.file.size() >= 4 && std::memcmp(document.file.data(), "glTF", 4) == 0;
  parts = binary ? split_glb(document) : Container{document.file, {}, false};
  if (parts.json.size() > document.limits.max_json_bytes) {
    fail(document.path, "has " + std::to_string(parts.json.size()) + " bytes of JSON",
         "expected at most " + std::to_string(document.limits.max_json_bytes));
  }
  if (!binary && !std::any_of(parts.json.begin(), parts.json.end(), [](std::uint8_t c) { return c == '{'; })) {
    fail(document.path, "is neither JSON nor a .glb", "expected a glTF 2.0 file");
  }
  json root = parse_json(document, parts.json);
  check_schema(document, root);
  load_buffers(document, root, parts);
  list_images(document, root);
  run_tinygltf(document, root);
}

}  // namespace shoal::gltf
