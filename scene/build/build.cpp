// Builds a RenderScene from a Scene: meshlets in world space, outlines of water, placed cameras, lighting.
#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "core/math.h"
#include "raster/geometry_measure.h"
#include "scene/build/building.h"
#include "scene/build/deform.h"
#include "scene/build/motion.h"
#include "scene/scene.h"

namespace shoal {
using namespace building;
namespace {

constexpr float kDefaultDepth_m = 1.0f;    // of a body without geometry below it
constexpr float kPlanarTolerance = 1e-4f;  // of the outline's extent
constexpr float kDefaultOrthographicFar_m = 1000.0f;

// --- Geometry -------------------------------------------------------------------------------------------------------

MeshView view_of(const MeshPrimitive& p, std::size_t node, std::size_t primitive, bool drawn) {
  MeshView view;
  view.uvs = p.uvs.empty() ? nullptr : p.uvs.data();
  view.colors = p.colors.empty() ? nullptr : p.colors.data();
  view.uvs1 = p.uvs1.empty() ? nullptr : p.uvs1.data();
  view.indices = p.indices.data();
  view.vertex_count = static_cast<std::uint32_t>(p.positions.size());
  view.index_count = static_cast<std::uint32_t>(p.indices.size());
  view.node = static_cast<std::uint32_t>(node);
  view.primitive = static_cast<std::uint32_t>(primitive);
  view.material = static_cast<std::uint32_t>(p.material);
  view.drawn = drawn;
  return view;
}

template <class Fn>
void for_each_primitive(const Scene& scene, Fn&& fn) {
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
    const Mesh* mesh = mesh_of(scene, scene.nodes[n]);
    if (!mesh) continue;
    const bool drawn = !is_outline(scene, scene.nodes[n]);
    for (std::size_t p = 0; p < mesh->primitives.size(); ++p) {
      fn(n, mesh->primitives[p], view_of(mesh->primitives[p], n, p, drawn));
    }
  }
}

Geometry bake_geometry(const Scene& scene, const Pose& pose, Motion& motion) {
  GeometrySize size;
  bool with_colors = false;
  for_each_primitive(scene, [&](std::size_t, const MeshPrimitive&, const MeshView& view) {
    measure_mesh(view, size);
    with_colors |= view.colors != nullptr;
  });
  if (size.triangles >= kNoTriangle) throw Error(scene.name + ": too many triangles; expected fewer than 4294967295");

  Geometry geometry;
  reserve_geometry(geometry, size, with_colors);
  std::vector<Vec3f> positions, normals;
  std::vector<Vec4f> tangents;
  std::vector<std::uint32_t> flipped;
  for_each_primitive(scene, [&](std::size_t n, const MeshPrimitive& p, MeshView view) {
    const Deformer deformer(scene, pose, n, p);
    positions.resize(p.positions.size());
    normals.resize(p.positions.size());
    for (std::size_t i = 0; i < p.positions.size(); ++i) {
      positions[i] = deformer.position(i);
      normals[i] = deformer.normal(i);
      if (!is_finite(positions[i]))
        fail(scene, scene.nodes[n], "a vertex is not finite in world space; expected finite positions");
    }
    view.positions_world = positions.data();
    view.normals_world = normals.data();
    if (!p.tangents.empty()) {
      tangents.resize(p.tangents.size());
      for (std::size_t i = 0; i < tangents.size(); ++i) tangents[i] = deformer.tangent(i);
      view.tangents_world = tangents.data();
    }
    const bool moves = view.drawn && drawable_moves(scene, motion.node_moves, n, p);
    if (deformer.mirrored() && !moves) {  // a mirroring transform turns front faces to back
      flipped = p.indices;
      for (std::size_t i = 0; i + 2 < flipped.size(); i += 3) std::swap(flipped[i + 1], flipped[i + 2]);
      view.indices = flipped.data();
    }
    if (moves) {
      append_moving(geometry, view, deformer.mirrored(), motion);
    } else {
      const std::size_t first = geometry.vertices.size();
      append_mesh(geometry, view);
      if (!motion.node_moves.empty()) include(motion, geometry, first);
    }
  });
  return geometry;
}

void find_bounds(const Geometry& g, Vec3f& lo, Vec3f& hi) {
  lo = hi = {0, 0, 0};
  if (g.vertices.empty()) return;
  lo = hi = g.vertices[0].position_world;
  for (const VertexRecord& v : g.vertices) {
    const Vec3f p = v.position_world;
    lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
    hi = {std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z)};
  }
}

// --- Water ----------------------------------------------------------------------------------------------------------

// Appends a triangle to the outline, counter-clockwise seen from +normal. One without area is dropped.
void add_outline_triangle(WaterBody& body, Vec3f a, Vec3f b, Vec3f c) {
  const float area2 = dot(cross(b - a, c - a), body.normal);
  if (area2 == 0) return;
  if (area2 < 0) std::swap(b, c);
  body.outline.insert(body.outline.end(), {a, b, c});
}

void outline_from_size(WaterBody& body, const Mat4& world_from_local, float size_x, float size_z) {
  const float x = size_x * 0.5f, z = size_z * 0.5f;
  const auto corner = [&](float sx, float sz) { return transform_point(world_from_local, Vec3f{sx, 0, sz}); };
  const Vec3f a = corner(-x, -z), b = corner(-x, z), c = corner(x, z), d = corner(x, -z);
  add_outline_triangle(body, a, b, c);
  add_outline_triangle(body, a, c, d);
}

void outline_from_mesh(const Scene& scene, const Node& node, WaterBody& body) {
  const Mesh* mesh = mesh_of(scene, node);
  if (!mesh) fail(scene, node, "water has neither a size nor a mesh; expected one of them as its outline");
  float extent = 0, off_plane = 0;
  for (const MeshPrimitive& p : mesh->primitives) {
    for (const Vec3f& v : p.positions) {
      extent = std::max({extent, std::fabs(v.x), std::fabs(v.z)});
      off_plane = std::max(off_plane, std::fabs(v.y));
    }
  }
  if (off_plane > kPlanarTolerance * extent) {
    fail(scene, node, "the water's mesh is not planar; expected all of its vertices at local y = 0");
  }
  for (const MeshPrimitive& p : mesh->primitives) {
    for (std::size_t i = 0; i + 2 < p.indices.size(); i += 3) {
      Vec3f corner[3];
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3f v = p.positions[p.indices[i + k]];
        corner[k] = transform_point(node.world_from_local, Vec3f{v.x, 0, v.z});
      }
      add_outline_triangle(body, corner[0], corner[1], corner[2]);
    }
  }
}

float depth_to_bottom(const Geometry& geometry, const WaterBody& body) {
  float depth = 0;
  for (const VertexRecord& v : geometry.vertices) {
    depth = std::max(depth, dot(body.origin - v.position_world, body.normal));
  }
  return depth > 0 ? depth : kDefaultDepth_m;
}

}  // namespace

WaterBody building::place_water(const Scene& scene, std::size_t node_index, const Geometry* geometry) {
  const Node& node = scene.nodes[node_index];
  const WaterSpec& spec = scene.waters[static_cast<std::size_t>(node.water)];
  const Mat4& t = node.world_from_local;
  WaterBody body;
  body.name = node.name;
  body.node = static_cast<std::uint32_t>(node_index);
  body.origin = column(t, 3);
  body.axis_x = normalize_or_zero(column(t, 0));
  const Vec3f to_z = normalize_or_zero(column(t, 2)), to_y = normalize_or_zero(column(t, 1));
  // The local x and z axes span the plane. Its normal is on the side of local +y, also under shear and mirroring.
  body.normal = normalize_or_zero(cross(to_z, body.axis_x));
  if (is_zero(body.normal) || is_zero(to_y) || dot(body.normal, to_y) == 0 || !is_finite(body.origin)) {
    fail(scene, node, "the water's transform is degenerate; expected three independent axes");
  }
  if (dot(body.normal, to_y) < 0) body.normal = -body.normal;
  body.axis_z = cross(body.axis_x, body.normal);
  body.ior = spec.ior;
  body.absorption_per_m = spec.absorption;
  body.surface = spec.surface;

  if (!(spec.ior >= 1.0f / 3.0f && spec.ior <= 3.0f)) fail(scene, node, "water ior is out of range; expected 1/3 to 3");
  if (spec.has_size) {
    if (!(spec.size_x > 0 && spec.size_z > 0))
      fail(scene, node, "water size is not positive; expected [x, z] in metres");
    outline_from_size(body, t, spec.size_x, spec.size_z);
  } else {
    outline_from_mesh(scene, node, body);
  }
  if (body.outline.empty()) fail(scene, node, "the water's outline has no area; expected at least one triangle");

  if (spec.has_depth) {
    body.depth_m = std::fabs(dot(transform_direction(t, Vec3f{0, spec.depth, 0}), body.normal));
    if (!(body.depth_m > 0) || !std::isfinite(body.depth_m)) {
      fail(scene, node, "water depth is not positive; expected metres below the plane");
    }
  } else if (geometry != nullptr) {
    body.depth_m = depth_to_bottom(*geometry, body);
  }
  return body;
}

namespace {

// --- Cameras --------------------------------------------------------------------------------------------------------

// Completes an orthonormal frame that looks along `forward`; its up vector is as close to `up` as possible. Returns
// false where the two are parallel or zero.
bool aim(Camera& camera, Vec3f forward, Vec3f up) {
  camera.forward_world = normalize_or_zero(forward);
  camera.right_world = normalize_or_zero(cross(camera.forward_world, normalize_or_zero(up)));
  camera.up_world = cross(camera.right_world, camera.forward_world);
  return !is_zero(camera.forward_world) && !is_zero(camera.right_world);
}

}  // namespace

PlacedCamera building::place_camera(const Scene& scene, const Node& node, std::size_t node_index) {
  const CameraSpec& spec = scene.cameras[static_cast<std::size_t>(node.camera)];
  PlacedCamera placed;
  placed.name = node.name;
  placed.node = static_cast<std::uint32_t>(node_index);
  Camera& camera = placed.camera;
  camera.position_world = column(node.world_from_local, 3);
  if (!aim(camera, -column(node.world_from_local, 2), column(node.world_from_local, 1)) ||
      !is_finite(camera.position_world)) {
    fail(scene, node, "the camera's transform is degenerate; expected independent axes");
  }
  camera.orthographic = spec.orthographic;
  camera.tan_half_yfov = det_tan(spec.yfov * 0.5f);
  camera.xmag_m = spec.xmag;
  camera.ymag_m = spec.ymag;
  camera.near_m = spec.znear;
  camera.far_m = spec.zfar > 0 ? spec.zfar : kDefaultOrthographicFar_m;
  return placed;
}

namespace {

// A camera for a scene without one: a three-quarter view in which the bounding sphere fits a square frame of 45
// degrees.
PlacedCamera framing_camera(Vec3f lo, Vec3f hi) {
  constexpr float kTanHalf = 0.41421356f, kSinHalf = 0.38268343f;  // of 22.5 degrees
  const Vec3f centre = (lo + hi) * 0.5f, half = (hi - lo) * 0.5f;
  const float length = std::sqrt(dot(half, half));
  const float radius = length > 0 && std::isfinite(length) ? length : 1.0f;
  const Vec3f from_centre = normalize_or_zero({0.6f, 0.55f, 1.0f});
  PlacedCamera placed;
  placed.name = "default";
  placed.camera.position_world = centre + from_centre * (radius / kSinHalf);
  aim(placed.camera, -from_centre, {0, 1, 0});
  placed.camera.tan_half_yfov = kTanHalf;
  placed.camera.near_m = radius * 0.01f;
  return placed;
}

// --- Light ----------------------------------------------------------------------------------------------------------

constexpr Vec3f kDefaultToSun{0.40824829f, 0.81649658f, 0.40824829f};
constexpr Vec3f kDefaultSunIrradiance{2.6f, 2.45f, 2.2f};
constexpr float kMaxInverseRange2 = 1e12f;  // of one micrometre: products with squared distances stay finite

bool is_lit(const Scene& scene) {
  for (const Node& node : scene.nodes) {
    const Mesh* mesh = mesh_of(scene, node);
    if (!mesh || is_outline(scene, node)) continue;
    for (const MeshPrimitive& p : mesh->primitives) {
      if (!scene.materials.materials[static_cast<std::size_t>(p.material)].unlit) return true;
    }
  }
  return false;
}

// The mean radiance of each half of the background, weighted by the cosine to the vertical: irradiance over pi. For the
// sky of shading/sky.h it lies 2 (0.8 B(2, 4) + 0.2 B(2, 17)) of the way from zenith to horizon, where B is the beta
// function. The glow around the sun (less than 0.002 of it) and the haze below the horizon are left out.
void ambient_from_background(Lighting& lighting) {
  const Background& b = lighting.background;
  if (b.kind == Background::Kind::kColor) {
    lighting.ambient_up = lighting.ambient_down = b.color;
  } else {
    constexpr float kHorizonShare = 2.0f * (0.8f / 20.0f + 0.2f / 306.0f);
    lighting.ambient_up = b.zenith + (b.horizon - b.zenith) * kHorizonShare;
    lighting.ambient_down = b.ground;
  }
}

// Places a point or spot light.
// Source: KHR_lights_punctual, "Inner and Outer Cone Angles" (the falloff's scale and offset).
PunctualLight place_lamp(const Scene& scene, const Node& node, const LightSpec& spec, Vec3f direction) {
  PunctualLight light;
  light.position_world = column(node.world_from_local, 3);
  if (!is_finite(light.position_world))
    fail(scene, node, "the light's place is not finite; expected a finite position");
  light.direction_world = direction;
  light.intensity = spec.color * spec.intensity;
  if (spec.range_m > 0) {
    const float inverse = 1.0f / spec.range_m;
    light.inverse_range2 = std::min(inverse * inverse, kMaxInverseRange2);
  }
  if (spec.kind == LightKind::kSpot) {
    const float outer = det_cos(spec.outer_cone);
    light.cone_scale = 1.0f / std::max(0.001f, det_cos(spec.inner_cone) - outer);
    light.cone_offset = -outer * light.cone_scale;
  }
  return light;
}

}  // namespace

Lighting building::make_lighting(const Scene& scene) {
  Lighting lighting;
  const bool lit = is_lit(scene);
  for (const Node& node : scene.nodes) {
    if (node.light == kNoIndex) continue;
    const LightSpec& spec = scene.lights[static_cast<std::size_t>(node.light)];
    if (spec.kind == LightKind::kPoint) {
      lighting.punctual.push_back(place_lamp(scene, node, spec, {0, -1, 0}));
      continue;
    }
    const Vec3f direction = normalize_or_zero(-column(node.world_from_local, 2));
    if (is_zero(direction)) fail(scene, node, "the light's transform is degenerate; expected a direction");
    if (spec.kind == LightKind::kSpot) {
      lighting.punctual.push_back(place_lamp(scene, node, spec, direction));
    } else {
      lighting.directional.push_back({direction, spec.color * spec.intensity});
    }
  }
  const bool surrounded = scene.has_background && scene.background.kind == Background::Kind::kEnvironment;
  if (surrounded && !scene.background.environment)
    throw Error(scene.name + ": the background is an environment without one; expected it built");
  if (lit && !surrounded && lighting.directional.empty() && lighting.punctual.empty())
    lighting.directional.push_back({-kDefaultToSun, kDefaultSunIrradiance});

  if (scene.has_background) {
    lighting.background = scene.background;
  } else if (lit) {
    lighting.background.kind = Background::Kind::kSky;
    if (!lighting.directional.empty()) {
      const DirectionalLight& sun = lighting.directional[0];
      lighting.background.to_sun_world = -sun.direction_world;
      lighting.background.sun = sun.irradiance;
    }
  }
  if (lit && !surrounded) ambient_from_background(lighting);
  return lighting;
}

namespace {

// A copy without the textures, which are large and do not move.
Scene without_textures(const Scene& scene) {
  Scene copy;
  copy.name = scene.name;
  copy.nodes = scene.nodes;
  copy.meshes = scene.meshes;
  copy.cameras = scene.cameras;
  copy.lights = scene.lights;
  copy.waters = scene.waters;
  copy.skins = scene.skins;
  copy.animations = scene.animations;
  copy.locals = scene.locals;
  copy.materials.materials = scene.materials.materials;
  copy.has_background = scene.has_background;
  copy.background = scene.background;
  return copy;
}

// Builds the parts of a RenderScene that depend on nodes.
//   scene   its nodes are placed as in the pose
//   motion  `node_moves` is given; receives the moving drawables and the bounds of the rest
RenderScene build(const Scene& scene, const Pose& pose, Motion& motion) {
  RenderScene out;
  out.geometry = bake_geometry(scene, pose, motion);
  out.lighting = make_lighting(scene);
  find_bounds(out.geometry, out.bounds_min_world, out.bounds_max_world);
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
    out.node_names.push_back(scene.nodes[n].name);
    if (scene.nodes[n].water != kNoIndex) out.waters.push_back(place_water(scene, n, &out.geometry));
    if (scene.nodes[n].camera != kNoIndex) out.cameras.push_back(place_camera(scene, scene.nodes[n], n));
  }
  if (out.cameras.empty()) out.cameras.push_back(framing_camera(out.bounds_min_world, out.bounds_max_world));
  return out;
}

}  // namespace

RenderScene build_render_scene(const Scene& scene) {
  const Pose pose = pose_scene(scene, 0);
  Motion motion;
  motion.node_moves = moving_nodes(scene);
  RenderScene out;
  if (motion.node_moves.empty()) {
    out = build(scene, pose, motion);
  } else {
    motion.scene = without_textures(scene);
    place_nodes(motion.scene, pose);
    out = build(motion.scene, pose, motion);
    drop_still_vertices(motion);
    out.motion = std::move(motion);
  }
  out.materials = scene.materials;
  return out;
}

}  // namespace shoal
