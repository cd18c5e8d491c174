// From a scene's name to something that can be rendered.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "app/options.h"
#include "scene/scene.h"

namespace shoal::app {

struct LoadedScene {
  Scene scene;  // without its meshes once `render` is built, unless they are asked for
  RenderScene render;
  std::string environment_file;  // what surrounds it; empty: a sky or a colour
  double load_ms = 0;   // reading or generating
  double build_ms = 0;  // world space and meshlets
};

// Reads a .gltf or .glb file, or makes a built-in scene.
//
// Throws Error where a file cannot be read, and UsageError for a name that is neither, for a triangle count that the
// built-in scene cannot meet within 10 %, and for --triangles with a file.
Scene read_scene(const std::string& name, std::optional<std::uint64_t> triangles);

// Reads, puts the user's water keys and background over the scene's, builds; warnings go to standard error.
LoadedScene load_scene(const SceneOptions& options, bool quiet);

// Triangles as they are drawn: a mesh counts once for each node that has it.
std::uint64_t count_triangles(const Scene& scene);

// By name, else by index in node order; the first camera where none is asked for. Throws UsageError.
const PlacedCamera& pick_camera(const RenderScene& scene, const std::optional<std::string>& camera);

// `shoal: warning: FILE: what` on standard error.
void warn(const std::string& file, const std::string& what);

}  // namespace shoal::app
