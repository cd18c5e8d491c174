// glTF 2.0 files (.gltf with its .bin and images, .glb, embedded) as a Scene.
#pragma once

#include <cstdint>
#include <string>

#include "scene/scene.h"

namespace shoal {

// What a file may ask for. Everything is checked against these before memory is taken for it.
struct LoadLimits {
  std::uint64_t max_file_bytes = std::uint64_t{4} << 30;    // of the scene file, and of each file it names
  std::uint64_t max_json_bytes = std::uint64_t{512} << 20;  // of the JSON text, embedded data included
  std::uint64_t max_json_values = std::uint64_t{1} << 25;  // numbers, strings, objects...: each takes memory of its own
  int max_json_depth = 64;
  std::uint32_t max_nodes = 1u << 20;
  int max_node_depth = 1024;
  std::uint64_t max_triangles = std::uint64_t{1} << 26;    // drawn: a mesh counts once for each node that has it
  std::uint64_t max_scene_bytes = std::uint64_t{8} << 30;  // of decoded textures and meshes, and of these as drawn
  std::uint32_t max_unbacked_elements = 1u << 24;          // of an accessor that has no bytes in the file (zeros)
  int max_texture_size = 16384;                            // texels, width and height
  std::uint64_t max_texels = std::uint64_t{1} << 28;       // of one image
  float max_coordinate_m = 1e12f;                          // of any vertex, in its mesh and in the world
  // false: buffers and images lie in the scene's folder or below it, symbolic links resolved.
  bool allow_external = false;
};

// Reads a scene.
//
//   path    a .gltf or .glb file; which of the two it is, its first bytes say
//   limits  see LoadLimits
//
// Returns the file's default scene, or its first one where it names none: nodes depth first from the scene's roots, in
// the file's order; instances of a mesh (EXT_mesh_gpu_instancing) as nodes below theirs; all of the file's meshes,
// cameras, lights and animations, in the file's order; the skins that nodes of the scene use; the textures that base
// colours use. World matrices are products in double, rounded to float once. Missing normals are generated flat
// (Source: glTF 2.0 specification, 3.7.2.1), which un-indexes that primitive. An unnamed node with a camera takes the
// camera's name. KHR_texture_transform is baked into the texture coordinates. What the file holds and Shoal does not
// draw yet is named in Scene::warnings, one line a kind, without the path. Scene::name is the path.
// Throws Error, one line that begins with the path, for everything that cannot be read as meant: no byte of a file is
// trusted (tests/scene/test_gltf_bad.cpp).
// Water: `extras.water` of a node, or flat keys such as `water_ior` (docs/scenes.md).
// Background: `extras.background` of the scene or the asset: "sky", or [r, g, b], or {"type": "sky"} with any of
// zenith, horizon, ground, sun ([r, g, b], linear) and to_sun (a unit vector). `extras.environment` of the scene is the
// URI of a picture's file: Scene::environment_file.
// Source: The Khronos Group, glTF 2.0 specification (2021).
// Differs: a primitive restart index, a count of indices that makes no whole triangle, and misaligned data are errors.
Scene load_gltf(const std::string& path, const LoadLimits& limits = {});

}  // namespace shoal
