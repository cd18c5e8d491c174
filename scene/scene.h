// What is drawn: plain data, as a glTF file or a procedural scene describes it. No library types.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/matrix.h"
#include "raster/camera.h"
#include "raster/geometry.h"
#include "shading/material.h"
#include "scene/animation.h"
#include "water/body.h"

namespace shoal {

class ThreadPool;

inline constexpr std::int32_t kNoIndex = -1;

// A triangle list in the mesh's local space; one material.
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
  std::vector<float> weights;         // the same, 0 or more, of sum 1
  std::vector<MorphTarget> targets;
  bool flat_normals = false;  // deformed, and without normals in the file: each triangle's own, at every time. Each
                              // corner has a vertex of its own then: indices count up from 0
};
struct Mesh {
  std::string name;
  std::vector<MeshPrimitive> primitives;
};

// As the camera object of a file: its place comes from its node (it looks along the node's -z, +y up).
struct CameraSpec {
  bool orthographic = false;
  float yfov = 1.0472f;           // radians, perspective
  float xmag = 1, ymag = 1;       // metres, orthographic
  float znear = 0.05f, zfar = 0;  // zfar 0: none given (infinite)
};

// `extras.water` of a node, as given (docs/scenes.md). Flat keys such as `water_ior` land here too.
struct WaterSpec {
  bool has_size = false;
  float size_x = 0, size_z = 0;  // metres, centred on the node
  bool has_depth = false;
  float depth = 0;
  float ior = 1.333f;
  Vec3f absorption{0.35f, 0.07f, 0.03f};
  SurfaceSettings surface;
};

enum class LightKind : std::uint8_t { kDirectional, kPoint, kSpot };

// At its node, a directional light and a spot shine along the node's -z.
struct LightSpec {
  Vec3f color{1, 1, 1};
  float intensity = 1;  // directional: lux; point, spot: candela
  LightKind kind = LightKind::kDirectional;
  float range_m = 0;                              // point, spot: nothing is lit beyond; 0: no end
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
  std::vector<Animation> animations;   // which of them play: playing_channels (scene/build/animate.h)
  std::vector<LocalTransform> locals;  // one a node; empty where there are no animations
  Materials materials;
  bool has_background = false;  // else: the default (a sky where the scene is lit, black where all of it is unlit)
  Background background;
  std::string environment_file;  // the picture that the scene names as its environment (extras.environment), not read
                                 // yet: load_environment (scene/images/environment.h) makes a background of it; empty: none
  std::vector<std::string> warnings;  // what the file holds and we do not read yet, a line each
};

// The scene ready to render: world space, meshleted, cameras placed.
struct PlacedCamera {
  std::string name;
  std::uint32_t node = 0;
  Camera camera;
};
// A drawable that the animations move, and where its vertices come from.
struct MovingDrawable {
  std::uint32_t drawable = 0;  // into Geometry::drawables
  std::uint32_t node = 0, primitive = 0;
  std::uint32_t first_meshlet = 0, meshlet_count = 0;
  std::uint32_t first_vertex = 0;
  std::vector<std::uint32_t> source;  // vertex of the primitive, for each vertex from first_vertex on, padding too
  bool mirrored = false;              // its triangles are turned now
};
// What update_render_scene needs: empty where nothing moves.
struct Motion {
  Scene scene;  // nodes in their present places; of the meshes, the vertices of those that move; no textures
  std::vector<MovingDrawable> drawables;
  std::vector<char> node_moves;  // one a node
  bool has_still_bounds = false;
  Vec3f still_min_world{0, 0, 0}, still_max_world{0, 0, 0};  // of all that stands still
};
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

// scene/build/build.cpp. Bakes nodes into world space, flips the winding under negative scale, resolves water bodies (outline
// from size or from the node's planar mesh, depth down to the scene's bottom where none is given) and gives a lit scene
// without lights the default sun and sky (docs/scenes.md). An animated scene is as it is at time 0.
RenderScene build_render_scene(const Scene& scene);

// scene/build/motion.cpp. Moves an animated scene to a time: vertices, normals, bounds and meshlets of the drawables that move,
// bodies of water, lights, cameras. Only those: a scene that does not move costs a test. The result depends on the time
// alone, not on the times before.
//   time_s  finite; before the first and after the last key of a channel its end stands
//   pool    the vertices' work is shared out on it; null: this thread does it
// Throws Error where a moving vertex is not finite, and for a moving camera or body of water whose transform
// degenerates.
void update_render_scene(RenderScene& scene, double time_s, ThreadPool* pool = nullptr);

// The camera of the scene where it is at a time. A camera whose node does not move is returned as it is.
Camera camera_at(const RenderScene& scene, const PlacedCamera& camera, double time_s);

// Procedural scenes (scene/procedural/registry.cpp).
struct ProceduralScene {
  const char* name;
  const char* description;
  Scene (*make)(std::uint64_t triangles);  // the count is met within 10 %
  std::uint64_t default_triangles;
};
const std::vector<ProceduralScene>& procedural_scenes();

}  // namespace shoal
