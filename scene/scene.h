// A scene as plain data: what a glTF file or a procedural scene describes. It holds no types of file libraries.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/matrix.h"
#include "raster/camera.h"
#include "raster/geometry.h"
#include "scene/animation.h"
#include "shading/material.h"
#include "water/body.h"

namespace shoal {

class ThreadPool;

inline constexpr std::int32_t kNoIndex = -1;

// A triangle list in the mesh's local space with one material.
struct MeshPrimitive {
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;          // unit, one a vertex; never empty: the loader generates missing ones (flat)
  std::vector<Vec2f> uvs;              // empty or one a vertex
  std::vector<Vec4f> colors;           // empty or one a vertex: linear RGBA
  std::vector<Vec2f> uvs1;             // empty, or one a vertex where the material reads a second set
  std::vector<Vec4f> tangents;         // empty, or one a vertex where the material has a normal map: unit, w 1 or -1
  std::vector<std::uint32_t> indices;  // three a triangle, each < positions.size()
  std::int32_t material = 0;           // always valid: a default material is appended where the file has none

  std::uint32_t influences = 0;       // joints a vertex; 0 where no skin can move the mesh
  std::vector<std::uint16_t> joints;  // into Skin::joints, `influences` a vertex
  std::vector<float> weights;         // `influences` a vertex, each 0 or more, of sum 1
  std::vector<MorphTarget> targets;
  // True for a mesh that is deformed and has no normals in its file: each triangle has its own normal at every time.
  // Each corner has a vertex of its own then, and indices count up from 0.
  bool flat_normals = false;
};
struct Mesh {
  std::string name;
  std::vector<MeshPrimitive> primitives;
};

// The lens of a camera. Its position and orientation are those of its node: it looks along the node's -z, +y is up.
struct CameraSpec {
  bool orthographic = false;
  float yfov = 1.0472f;           // radians, perspective
  float xmag = 1, ymag = 1;       // metres, orthographic
  float znear = 0.05f, zfar = 0;  // metres; zfar 0: infinite
};

// A body of water as `extras.water` of a node gives it, or flat keys such as `water_ior` (docs/scenes.md).
struct WaterSpec {
  bool has_size = false;
  float size_x = 0, size_z = 0;  // in the node's units, centred on the node
  bool has_depth = false;
  float depth = 0;  // in the node's units, below the plane
  float ior = 1.333f;
  Vec3f absorption{0.35f, 0.07f, 0.03f};  // 1/m
  SurfaceSettings surface;
};

enum class LightKind : std::uint8_t { kDirectional, kPoint, kSpot };

// A light. A directional light and a spot shine along the node's -z.
struct LightSpec {
  Vec3f color{1, 1, 1};
  float intensity = 1;  // directional: lux; point, spot: candela
  LightKind kind = LightKind::kDirectional;
  float range_m = 0;                              // point, spot: nothing beyond it is lit; 0: unlimited
  float inner_cone = 0, outer_cone = 0.7853982f;  // spot, radians off the axis: full light within, none beyond
};

struct Node {
  std::string name;
  std::int32_t parent = kNoIndex;
  Mat4 world_from_local = kIdentity4;
  std::int32_t mesh = kNoIndex, camera = kNoIndex, light = kNoIndex, water = kNoIndex;
  std::int32_t skin = kNoIndex;      // of the mesh, which then does not follow this node
  std::vector<float> morph_weights;  // as many as the mesh has targets
};

struct Scene {
  std::string name;
  std::vector<Node> nodes;  // depth first: the order of triangle ids, of cameras and of bodies of water
  std::vector<Mesh> meshes;
  std::vector<CameraSpec> cameras;
  std::vector<LightSpec> lights;
  std::vector<WaterSpec> waters;
  std::vector<Skin> skins;
  std::vector<Animation> animations;   // playing_channels (scene/build/animate.h) selects those that play
  std::vector<LocalTransform> locals;  // one a node; empty where there are no animations
  Materials materials;
  bool has_background = false;  // false: a sky where the scene is lit, black where all of it is unlit
  Background background;
  // The URI of the picture that the scene names as its environment (extras.environment); empty: none. The loader does
  // not read it: load_environment (scene/images/environment.h) makes a background of it.
  std::string environment_file;
  std::vector<std::string> warnings;  // one line for each kind of content that the file holds and Shoal does not read
};

// A camera in world space.
struct PlacedCamera {
  std::string name;
  std::uint32_t node = 0;
  Camera camera;
};
// A drawable that the animations move, and the source of its vertices.
struct MovingDrawable {
  std::uint32_t drawable = 0;  // into Geometry::drawables
  std::uint32_t node = 0, primitive = 0;
  std::uint32_t first_meshlet = 0, meshlet_count = 0;
  std::uint32_t first_vertex = 0;
  std::vector<std::uint32_t> source;  // vertex of the primitive for each vertex from first_vertex on, padding included
  bool mirrored = false;              // the winding of its triangles is reversed at present
};
// The state that update_render_scene reads and writes; empty where nothing moves.
struct Motion {
  Scene scene;  // its nodes in their present places; of the meshes, the vertices of those that move; no textures
  std::vector<MovingDrawable> drawables;
  std::vector<char> node_moves;  // one a node
  bool has_still_bounds = false;
  Vec3f still_min_world{0, 0, 0}, still_max_world{0, 0, 0};  // bounds of all geometry that does not move
};
// A scene ready to render: meshlets in world space, placed cameras, bodies of water and lights.
struct RenderScene {
  Geometry geometry;
  Materials materials;
  Lighting lighting;
  std::vector<WaterBody> waters;
  std::vector<PlacedCamera> cameras;  // never empty: one that frames the whole scene where the file has none
  std::vector<std::string> node_names;
  Vec3f bounds_min_world, bounds_max_world;
  Motion motion;

  bool moves() const { return !motion.node_moves.empty(); }
};

// Builds a scene for rendering (scene/build/build.cpp): transforms its nodes into world space, reverses the winding
// under negative scale, and resolves its bodies of water. The outline of a body comes from its size or from the node's
// planar mesh; a body without a depth reaches down to the scene's bottom. A lit scene without lights receives the
// default sun and sky (docs/scenes.md).
//   scene  as documented above; indices valid
// Returns the scene at time 0. Throws Error for a degenerate transform, a vertex that is not finite in world space, and
// invalid water.
RenderScene build_render_scene(const Scene& scene);

// Moves an animated scene to a time (scene/build/motion.cpp): vertices, normals, bounds and meshlets of the drawables
// that move, bodies of water, lights and cameras. A scene that does not move is left as it is. The result depends on
// the time alone, not on earlier times.
//   time_s  finite; channels hold their first and last key beyond their ends
//   pool    shares the work on vertices; null: the calling thread does all of it
// Throws Error where a moving vertex is not finite, and for a moving camera or body of water whose transform
// degenerates.
void update_render_scene(RenderScene& scene, double time_s, ThreadPool* pool = nullptr);

// Returns a camera of the scene at a time; one whose node does not move is returned unchanged.
Camera camera_at(const RenderScene& scene, const PlacedCamera& camera, double time_s);

// A procedural scene. scene/procedural/registry.cpp lists them.
struct ProceduralScene {
  const char* name;
  const char* description;
  Scene (*make)(std::uint64_t triangles);  // the count is met within 10 %
  std::uint64_t default_triangles;
};
const std::vector<ProceduralScene>& procedural_scenes();

}  // namespace shoal
