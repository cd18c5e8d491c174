// Reads glTF 2.0 files (.gltf with its .bin and images, .glb, embedded) as a Scene.
#pragma once

#include <cstdint>
#include <string>

#include "scene/scene.h"

namespace shoal {

// Limits of a file. The loader checks every size against them before it allocates memory.
struct LoadLimits {
  std::uint64_t max_file_bytes = std::uint64_t{4} << 30;    // of the scene file, and of each file it names
  std::uint64_t max_json_bytes = std::uint64_t{512} << 20;  // of the JSON text, embedded data included
  std::uint64_t max_json_values = std::uint64_t{1} << 25;   // numbers, strings, objects and arrays
  int max_json_depth = 64;
  std::uint32_t max_nodes = 1u << 20;
  int max_node_depth = 1024;
  std::uint32_t max_materials = 1u << 18;  // each also counts towards max_scene_bytes
  std::uint64_t max_triangles = std::uint64_t{1} << 26;    // drawn: a mesh counts once for each node that uses it
  std::uint64_t max_scene_bytes = std::uint64_t{8} << 30;  // of decoded textures and meshes and of world-space geometry
  std::uint32_t max_unbacked_elements = 1u << 24;          // of an accessor without bytes in the file (all zero)
  int max_texture_size = 16384;                            // texels, width and height
  std::uint64_t max_texels = std::uint64_t{1} << 28;       // of one image
  float max_coordinate_m = 1e12f;                          // of a vertex, in its mesh and in world space
  // False: buffers and images must lie in the scene's folder or below it after symbolic links are resolved.
  bool allow_external = false;
};

// Reads a scene.
//
//   path    a .gltf or .glb file; its first bytes determine which of the two it is
//   limits  see LoadLimits
//
// Returns the file's default scene, or its first one where it names none: nodes depth first from the scene's roots, in
// the file's order; instances of a mesh (EXT_mesh_gpu_instancing) as nodes below their node; all meshes, cameras,
// lights and animations of the file, in its order; the skins that nodes of the scene use; the textures that materials
// use. World matrices are products in double, rounded to float once. Missing normals are generated flat (Source: glTF
// 2.0 specification, 3.7.2.1), which gives each corner of that primitive a vertex of its own. An unnamed node with a
// camera takes the camera's name. Scene::warnings has one line, without the path, for each kind of content that Shoal
// does not draw. Scene::name is the path.
// Throws Error, one line that begins with the path, for a file that cannot be read as intended. The loader trusts no
// byte of a file (tests/scene/test_gltf_bad.cpp). Water: `extras.water` of a node, or flat keys such as `water_ior`
// (docs/scenes.md). Background: `extras.background` of the scene or the asset: "sky", or [r, g, b], or {"type": "sky"}
// with any of zenith, horizon, ground, sun ([r, g, b], linear) and to_sun (a unit vector). `extras.environment` of the
// scene is the URI of a picture file: Scene::environment_file.
// Source: The Khronos Group, glTF 2.0 specification (2021).
// Differs: a primitive restart index, a count of indices that makes no whole triangle, and misaligned data are errors.
Scene load_gltf(const std::string& path, const LoadLimits& limits = {});

}  // namespace shoal
