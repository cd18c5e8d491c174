// What is drawn: plain data, as a glTF file or a procedural scene describes it. No library types.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/vec.h"
#include "raster/camera.h"
#include "raster/geometry.h"
#include "raster/material.h"
#include "water/body.h"

namespace shoal {

inline constexpr std::int32_t kNoIndex = -1;

// A triangle list in the mesh's local space; one material.
struct MeshPrimitive {
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;  // unit, one a vertex; never empty: the loader generates missing ones (flat)
  std::vector<Vec2f> uvs;      // empty or one a vertex
  std::vector<Vec4f> colors;   // empty or one a vertex: linear RGBA
  std::vector<std::uint32_t> indices;  // three a triangle, each < positions.size()
  std::int32_t material = 0;           // always valid: a default material is appended where the file has none
};
struct Mesh {
  std::string name;
  std::vector<MeshPrimitive> primitives;
};

// As the camera object of a file: its place comes from its node (it looks along the node's -z, +y up).
struct CameraSpec {
  bool orthographic = false;
  float yfov = 1.0472f;            // radians, perspective
  float xmag = 1, ymag = 1;        // metres, orthographic
  float znear = 0.05f, zfar = 0;   // zfar 0: none given (infinite)
};

// `extras.water` of a node, as given (DESIGN.md 4). Flat keys such as `water_ior` land here too.
struct WaterSpec {
  bool has_size = false;
  float size_x = 0, size_z = 0;    // metres, centred on the node
  bool has_depth = false;
  float depth = 0;
  float ior = 1.333f;
  Vec3f absorption{0.35f, 0.07f, 0.03f};
  SurfaceSettings surface;
};

struct LightSpec {
  Vec3f color{1, 1, 1};
  float intensity = 1;  // lux, directional: shines along the node's -z
};

struct Node {
  std::string name;
  std::int32_t parent = kNoIndex;
  Mat4 world_from_local = kIdentity4;
  std::int32_t mesh = kNoIndex, camera = kNoIndex, light = kNoIndex, water = kNoIndex;
};

struct Scene {
  std::string name;
  std::vector<Node> nodes;  // depth first: the order of triangle ids, of cameras and of bodies of water
  std::vector<Mesh> meshes;
  std::vector<CameraSpec> cameras;
  std::vector<LightSpec> lights;
  std::vector<WaterSpec> waters;
  Materials materials;
  bool has_background = false;  // else: the default (a sky where the scene is lit, black where all of it is unlit)
  Background background;
  std::vector<std::string> warnings;  // what the file holds and we do not read yet, a line each
};

// The scene ready to render: world space, chunked, cameras placed.
struct PlacedCamera {
  std::string name;
  std::uint32_t node = 0;
  Camera camera;
};
struct RenderScene {
  Geometry geometry;
  Materials materials;
  Lighting lighting;
  std::vector<WaterBody> waters;
  std::vector<PlacedCamera> cameras;  // never empty: one that frames the whole scene where the file has none
  std::vector<std::string> node_names;
  Vec3f bounds_min_world, bounds_max_world;
};

// scene/build.cpp. Bakes nodes into world space, flips the winding under negative scale, resolves water bodies (outline
// from size or from the node's planar mesh, depth down to the scene's bottom where none is given) and gives a lit scene
// without lights the default sun and sky (docs/scenes.md).
RenderScene build_render_scene(const Scene& scene);

// Procedural scenes (scene/procedural/registry.cpp).
struct ProceduralScene {
  const char* name;
  const char* description;
  Scene (*make)(std::uint64_t triangles);  // the count is met within 10 %
  std::uint64_t default_triangles;
};
const std::vector<ProceduralScene>& procedural_scenes();

}  // namespace shoal
