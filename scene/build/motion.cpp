#include "scene/build/motion.h"

#include <algorithm>
#include <utility>

#include "core/thread_pool.h"
#include "raster/geometry_measure.h"
#include "scene/build/deform.h"

namespace shoal {
namespace {

using namespace building;

struct Bounds {
  bool any = false;
  Vec3f lo{0, 0, 0}, hi{0, 0, 0};

  void add(Vec3f p, Vec3f q) {
    if (!any) lo = p, hi = q;
    any = true;
    lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
    hi = {std::max(hi.x, q.x), std::max(hi.y, q.y), std::max(hi.z, q.z)};
  }
};

bool place_moves(const std::vector<char>& node_moves, std::size_t node) {
  return (node_moves[node] & kPlaceMoves) != 0;
}

const MeshPrimitive& primitive_of(const Scene& scene, const MovingDrawable& d) {
  return mesh_of(scene, scene.nodes[d.node])->primitives[d.primitive];
}

// Reverses the winding: the second and third corner of every triangle are exchanged.
void reverse_winding(Geometry& g, MovingDrawable& d) {
  const Drawable& drawable = g.drawables[d.drawable];
  for (std::uint32_t t = 0; t < drawable.triangle_count; ++t) {
    Geometry::TriangleRecord& triangle = g.triangles[drawable.first_triangle + t];
    std::swap(triangle.vertex[1], triangle.vertex[2]);
  }
  for (std::uint32_t c = d.first_meshlet; c < d.first_meshlet + d.meshlet_count; ++c) {
    const Meshlet& meshlet = g.meshlets[c];
    for (std::size_t i = meshlet.first_index; i < meshlet.first_index + std::size_t{meshlet.triangle_count}; ++i) {
      std::swap(g.corner1[i], g.corner2[i]);
    }
  }
  d.mirrored = !d.mirrored;
}

void update_meshlet(const MovingDrawable& d, const Deformer& deformer, Meshlet& meshlet, Geometry& g,
                    const Scene& scene) {
  const std::size_t padded = (std::size_t{meshlet.vertex_count} + 15) & ~std::size_t{15};
  for (std::size_t i = meshlet.first_vertex; i < meshlet.first_vertex + padded; ++i) {
    VertexRecord& vertex = g.vertices[i];
    if (i < meshlet.first_vertex + std::size_t{meshlet.vertex_count}) {
      const std::uint32_t source = d.source[i - d.first_vertex];
      vertex.position_world = deformer.position(source);
      vertex.normal_world = deformer.normal(source);
      if (deformer.has_tangents()) g.tangents[i] = deformer.tangent(source);
      if (!is_finite(vertex.position_world)) {
        fail(scene, scene.nodes[d.node], "a vertex is not finite in world space; expected finite positions");
      }
    } else {
      vertex = g.vertices[i - 1];
      if (deformer.has_tangents()) g.tangents[i] = g.tangents[i - 1];
    }
    g.x_world[i] = vertex.position_world.x;
    g.y_world[i] = vertex.position_world.y;
    g.z_world[i] = vertex.position_world.z;
  }
  measure_meshlet(g, meshlet);
}

void update_geometry(RenderScene& out, const Pose& pose, ThreadPool* pool) {
  Motion& m = out.motion;
  Geometry& g = out.geometry;
  std::vector<Deformer> deformers;
  deformers.reserve(m.drawables.size());
  struct Job {
    std::uint32_t drawable, meshlet;
  };
  std::vector<Job> jobs;
  for (std::size_t i = 0; i < m.drawables.size(); ++i) {
    MovingDrawable& d = m.drawables[i];
    deformers.emplace_back(m.scene, pose, d.node, primitive_of(m.scene, d));
    if (deformers[i].mirrored() != d.mirrored) reverse_winding(g, d);
    for (std::uint32_t c = 0; c < d.meshlet_count; ++c)
      jobs.push_back({static_cast<std::uint32_t>(i), d.first_meshlet + c});
  }
  const auto work = [&](std::size_t j, int) {
    const Job job = jobs[j];
    update_meshlet(m.drawables[job.drawable], deformers[job.drawable], g.meshlets[job.meshlet], g, m.scene);
  };
  if (pool != nullptr) {
    pool->for_each(jobs.size(), work);
  } else {
    for (std::size_t j = 0; j < jobs.size(); ++j) work(j, 0);
  }

  Bounds bounds;
  if (m.has_still_bounds) bounds.add(m.still_min_world, m.still_max_world);
  for (const Job job : jobs)
    bounds.add(g.meshlets[job.meshlet].bounds_min_world, g.meshlets[job.meshlet].bounds_max_world);
  out.bounds_min_world = bounds.lo;
  out.bounds_max_world = bounds.hi;
}

// Places the lights again. A default sky takes its sun from the scene's first directional light and follows it.
void update_lights(RenderScene& out) {
  const Motion& m = out.motion;
  bool any = false;
  for (std::size_t n = 0; n < m.scene.nodes.size(); ++n) {
    any |= m.scene.nodes[n].light != kNoIndex && place_moves(m.node_moves, n);
  }
  if (!any) return;
  const Lighting now = make_lighting(m.scene);
  out.lighting.directional = now.directional;
  out.lighting.punctual = now.punctual;
  Background& background = out.lighting.background;
  if (!m.scene.has_background && background.kind == now.background.kind) {
    background.to_sun_world = now.background.to_sun_world;
    background.sun = now.background.sun;
  }
}

}  // namespace

namespace building {

bool drawable_moves(const Scene& scene, const std::vector<char>& node_moves, std::size_t node,
                    const MeshPrimitive& mesh) {
  if (node_moves.empty()) return false;
  if ((node_moves[node] & kShapeMoves) != 0 && !mesh.targets.empty()) return true;
  if (!is_skinned(scene.nodes[node], mesh)) return place_moves(node_moves, node);
  const std::vector<std::int32_t>& joints = scene.skins[static_cast<std::size_t>(scene.nodes[node].skin)].joints;
  return std::any_of(joints.begin(), joints.end(),
                     [&](std::int32_t j) { return place_moves(node_moves, static_cast<std::size_t>(j)); });
}

void append_moving(Geometry& g, const MeshView& mesh, bool mirrored, Motion& motion) {
  MovingDrawable d;
  d.drawable = static_cast<std::uint32_t>(g.drawables.size());
  d.node = mesh.node;
  d.primitive = mesh.primitive;
  d.first_meshlet = static_cast<std::uint32_t>(g.meshlets.size());
  d.first_vertex = static_cast<std::uint32_t>(g.vertices.size());
  append_mesh(g, mesh);
  d.meshlet_count = static_cast<std::uint32_t>(g.meshlets.size()) - d.first_meshlet;
  d.source.assign(g.vertices.size() - d.first_vertex, 0);
  const std::size_t first = g.drawables[d.drawable].first_triangle;
  for (std::size_t i = 0; i < mesh.index_count; ++i) {
    d.source[g.triangles[first + i / 3].vertex[i % 3] - d.first_vertex] = mesh.indices[i];
  }
  if (mirrored) reverse_winding(g, d);
  motion.drawables.push_back(std::move(d));
}

void include(Motion& motion, const Geometry& g, std::size_t first) {
  Bounds bounds{motion.has_still_bounds, motion.still_min_world, motion.still_max_world};
  for (std::size_t v = first; v < g.vertices.size(); ++v) {
    bounds.add(g.vertices[v].position_world, g.vertices[v].position_world);
  }
  motion.has_still_bounds = bounds.any;
  motion.still_min_world = bounds.lo;
  motion.still_max_world = bounds.hi;
}

void place_nodes(Scene& scene, const Pose& pose) {
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
    scene.nodes[n].world_from_local = narrow(pose.world_from_local[n]);
  }
}

void drop_still_vertices(Motion& motion) {
  Scene& scene = motion.scene;
  std::vector<char> kept(scene.meshes.size(), 0);
  for (const MovingDrawable& d : motion.drawables) kept[static_cast<std::size_t>(scene.nodes[d.node].mesh)] = 1;
  for (const Node& node : scene.nodes) {
    if (is_outline(scene, node) && node.mesh != kNoIndex) kept[static_cast<std::size_t>(node.mesh)] = 1;
  }
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    if (kept[m] != 0) continue;
    for (MeshPrimitive& p : scene.meshes[m].primitives) {
      MeshPrimitive bare;
      bare.material = p.material;
      p = std::move(bare);
    }
  }
}

}  // namespace building

void update_render_scene(RenderScene& out, double time_s, ThreadPool* pool) {
  if (!out.moves()) return;
  Motion& m = out.motion;
  const Pose pose = pose_scene(m.scene, time_s);
  place_nodes(m.scene, pose);
  update_geometry(out, pose, pool);
  for (WaterBody& body : out.waters) {
    if (!place_moves(m.node_moves, body.node)) continue;
    const float depth_m = body.depth_m;
    body = place_water(m.scene, body.node, nullptr);
    if (body.depth_m == 0) body.depth_m = depth_m;  // its depth to the scene's bottom at time 0 stays
  }
  for (PlacedCamera& placed : out.cameras) placed.camera = camera_at(out, placed, time_s);
  update_lights(out);
}

Camera camera_at(const RenderScene& scene, const PlacedCamera& placed, double time_s) {
  const Motion& m = scene.motion;
  const bool of_node = scene.moves() && m.scene.nodes[placed.node].camera != kNoIndex;
  if (!of_node || !place_moves(m.node_moves, placed.node)) return placed.camera;
  Node node = m.scene.nodes[placed.node];
  node.world_from_local = narrow(pose_scene(m.scene, time_s).world_from_local[placed.node]);
  return place_camera(m.scene, node, placed.node).camera;
}

}  // namespace shoal
