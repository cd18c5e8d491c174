// shoal info: what is in a scene.
#include <fmt/format.h>

#include <algorithm>

#include "app/commands.h"
#include "app/json_report.h"
#include "app/load.h"
#include "app/output.h"

namespace shoal::app {
namespace {

// Returns whether a node of the scene has a camera; otherwise the only camera is the one that frames the whole scene.
bool has_camera_node(const Scene& scene) {
  return std::any_of(scene.nodes.begin(), scene.nodes.end(), [](const Node& node) { return node.camera != kNoIndex; });
}

Json camera_json(const PlacedCamera& placed, const RenderScene& scene, const Scene& source) {
  const Camera& camera = placed.camera;
  Json json = Json::object();
  json["name"] = placed.name;
  json["node"] = has_camera_node(source) ? Json(scene.node_names[placed.node]) : Json(nullptr);
  json["projection"] = camera.orthographic ? "orthographic" : "perspective";
  if (camera.orthographic) {
    json["xmag"] = json_float(camera.xmag_m);
    json["ymag"] = json_float(camera.ymag_m);
  } else {
    json["tan_half_yfov"] = json_float(camera.tan_half_yfov);
  }
  json["position"] = json_vector(camera.position_world);
  json["forward"] = json_vector(camera.forward_world);
  return json;
}

Json body_json(const WaterBody& body) {
  Json json = Json::object();
  json["name"] = body.name;
  json["origin"] = json_vector(body.origin);
  json["normal"] = json_vector(body.normal);
  json.update(water_json(body));
  return json;
}

std::uint64_t count_vertices(const Scene& scene) {
  std::uint64_t count = 0;
  for (const Node& node : scene.nodes) {
    if (node.mesh == kNoIndex) continue;
    for (const MeshPrimitive& p : scene.meshes[static_cast<std::size_t>(node.mesh)].primitives)
      count += p.positions.size();
  }
  return count;
}

Json info_json(const std::string& name, const LoadedScene& loaded) {
  const Scene& scene = loaded.scene;
  std::size_t primitives = 0;
  for (const Mesh& mesh : scene.meshes) primitives += mesh.primitives.size();
  Json json = Json::object();
  json["scene"] = name;
  json["nodes"] = scene.nodes.size();
  json["meshes"] = scene.meshes.size();
  json["primitives"] = primitives;
  json["triangles"] = count_triangles(scene);
  json["vertices"] = count_vertices(scene);
  json["materials"] = scene.materials.materials.size();
  json["textures"] = scene.materials.textures.size();
  json["lights"] = scene.lights.size();
  json["environment"] = scene.environment_file.empty() ? Json(nullptr) : Json(scene.environment_file);
  json["skins"] = scene.skins.size();
  json["animations"] = Json::array();
  for (const Animation& animation : scene.animations) json["animations"].push_back(animation.name);
  json["cameras"] = Json::array();
  for (const PlacedCamera& camera : loaded.render.cameras)
    json["cameras"].push_back(camera_json(camera, loaded.render, scene));
  json["water"] = Json::array();
  for (const WaterBody& body : loaded.render.waters) json["water"].push_back(body_json(body));
  json["bounds"] = {{"min", json_vector(loaded.render.bounds_min_world)},
                    {"max", json_vector(loaded.render.bounds_max_world)}};
  json["warnings"] = scene.warnings;
  return json;
}

// "key value", and the objects of a list under it: the same facts as the JSON.
void append_text(const Json& json, const std::string& indent, std::string& text) {
  for (const auto& [key, value] : json.items()) {
    if (value.is_array() && !value.empty() && value.front().is_object()) {
      text += fmt::format("{}{} {}\n", indent, key, value.size());
      for (const Json& item : value) {
        text += fmt::format("{}  {}\n", indent, item.begin()->get<std::string>());
        Json rest = item;
        rest.erase(rest.begin());
        append_text(rest, indent + "    ", text);
      }
    } else if (value.is_object()) {
      text += fmt::format("{}{}\n", indent, key);
      append_text(value, indent + "  ", text);
    } else if (value.is_array()) {
      std::string line = indent + key;
      for (const Json& item : value) line += " " + (item.is_string() ? item.get<std::string>() : item.dump());
      text += line + (value.empty() ? " none\n" : "\n");
    } else {
      text += fmt::format("{}{} {}\n", indent, key, value.is_string() ? value.get<std::string>() : value.dump());
    }
  }
}

}  // namespace

int run_info(const RawOptions& raw) {
  const LoadedScene loaded = load_scene(read_scene_options(raw), raw.quiet);
  const Json json = info_json(raw.scene, loaded);
  if (raw.json) {
    const bool on_stdout = raw.json->empty() || *raw.json == "-";
    write_text(on_stdout ? "-" : *raw.json, json_text(json));
    if (on_stdout) return 0;
  }
  std::string text;
  append_text(json, "", text);
  if (!raw.quiet) write_stdout(text);
  return 0;
}

}  // namespace shoal::app
