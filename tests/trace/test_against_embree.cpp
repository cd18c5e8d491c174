// First hits and shadows by our BVH and by Embree on the same rays, a million a scene. Where they differ, both answers
// are judged in double: a difference is allowed only where the ray passes within 1e-5 of the scene's size from an edge
// of a triangle, or where it crosses two surfaces at the same point.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "bench/kernels.h"
#include "bench/peers/embree/embree_queries.h"
#include "core/thread_pool.h"
#include "scene/gltf/gltf.h"
#include "tests/refraction/double_vector.h"
#include "tests/refraction/oracle_scene.h"

using namespace shoal_test;
using shoal::bench::HitsOfBlock;
using shoal::bench::RayBlock;

namespace {

constexpr int kBlocks = 62'500;  // of sixteen rays: a million
constexpr float kFar = 3e38f;
constexpr double kTolerance = 1e-5;  // of the scene's size

// Every triangle in double; a ray's possible and certain hits.
class DoubleOracle {
 public:
  explicit DoubleOracle(const RenderScene& scene) : geometry_(scene.geometry), materials_(scene.materials.materials) {
    Vec3d lo{1e300, 1e300, 1e300}, hi{-1e300, -1e300, -1e300};
    for (const VertexRecord& v : geometry_.vertices)
      for (int a = 0; a < 3; ++a) {
        const double x = static_cast<double>(v.position_world[a]);
        lo[a] = std::min(lo[a], x), hi[a] = std::max(hi[a], x);
      }
    size_ = norm_of(hi - lo), middle_ = (lo + hi) * 0.5;
    for (const Geometry::TriangleRecord& r : geometry_.triangles) {
      const auto corner = [&](int k) { return as_double(geometry_.vertices[r.vertex[k]].position_world); };
      const Vec3d middle = (corner(0) + corner(1) + corner(2)) / 3.0;
      double radius = 0;
      for (int k = 0; k < 3; ++k) radius = std::max(radius, norm_of(corner(k) - middle));
      spheres_.push_back({middle, radius + 2 * kTolerance * size_});
    }
  }
  double size() const { return size_; }
  Vec3d middle() const { return middle_; }

  struct Answers {
    double clear_t = 1e300;                             // of the nearest triangle that the ray hits away from its edges
    std::vector<std::pair<double, std::int32_t>> hits;  // all, those near an edge included
  };
  //   shadow  both sides count, and materials that cast
  Answers of(Vec3d o, Vec3d direction, double t_far, bool shadow) const {
    Answers out;
    const Vec3d d = unit_of(direction);  // a float direction is a unit vector to 1e-7 only
    const double near = kTolerance * size_;
    for (const Drawable& drawable : geometry_.drawables) {
      const Material& material = materials_[drawable.material];
      if (!drawable.drawn || material.alpha_mode == AlphaMode::kBlend || (shadow && material.unlit)) continue;
      for (std::uint32_t k = 0; k < drawable.triangle_count; ++k) {
        const std::uint32_t id = drawable.first_triangle + k;
        const Vec3d to = spheres_[id].middle - o;
        const double t = dot(to, d);
        if (dot(to, to) - t * t <= spheres_[id].radius * spheres_[id].radius)
          add(o, d, t_far, id, shadow || material.double_sided, near, out);
      }
    }
    return out;
  }
  // Whether an answer for the first hit is one that the geometry allows.
  bool allows(const Answers& a, std::int32_t id) const {
    if (id == kNoId) return a.clear_t == 1e300;
    for (const auto& [t, one] : a.hits)
      if (one == id) return t <= a.clear_t + kTolerance * size_;
    return false;
  }
  bool allows_blocked(const Answers& a, bool blocked) const { return blocked ? !a.hits.empty() : a.clear_t == 1e300; }

 private:
  static double ray_to_segment(Vec3d o, Vec3d d, Vec3d a, Vec3d b) {
    const Vec3d e = b - a, r = a - o;
    const double ee = dot(e, e), de = dot(d, e), re = dot(r, e), rd = dot(r, d);
    const double det = ee - de * de;
    const double s = det > 1e-300 ? std::clamp((rd * de - re) / det, 0.0, 1.0) : 0.0;
    const Vec3d p = r + e * s;
    return norm_of(p - d * dot(p, d));
  }
  void add(Vec3d o, Vec3d d, double t_far, std::uint32_t id, bool two_sided, double near, Answers& out) const {
    const Geometry::TriangleRecord& r = geometry_.triangles[id];
    const Vec3d a = as_double(geometry_.vertices[r.vertex[0]].position_world);
    const Vec3d b = as_double(geometry_.vertices[r.vertex[1]].position_world);
    const Vec3d c = as_double(geometry_.vertices[r.vertex[2]].position_world);
    const Vec3d n = cross(b - a, c - a);
    const double along = dot(d, n), nn = dot(n, n);
    const double edge = std::min({ray_to_segment(o, d, a, b), ray_to_segment(o, d, b, c), ray_to_segment(o, d, c, a)});
    const bool near_edge = edge <= near;
    if (nn == 0 || along == 0) {
      if (near_edge && nn != 0) out.hits.emplace_back(std::max(0.0, dot(a - o, d) - near), id);
      return;
    }
    const double t = dot(a - o, n) / along;
    const Vec3d p = o + d * t - a;
    const double u = dot(cross(p, c - a), n) / nn, v = dot(cross(b - a, p), n) / nn;
    const bool inside = u >= 0 && v >= 0 && u + v <= 1;
    if (!inside && !near_edge) return;
    // Facing, and the ends of the ray, are exact but within the tolerance.
    const double sine = std::fabs(along) / std::sqrt(nn);
    // A ray that grazes an edge of a facet may be taken for one on either side of it.
    if (!two_sided && along > 0 && !(near_edge && sine < 1e-3)) return;
    const double slack = near / std::max(sine, 1e-3);
    if (t < -slack || t > t_far + slack) return;
    const bool clear =
        inside && !near_edge && t > slack && t < t_far - slack && (two_sided || along < 0) && sine > 1e-3;
    if (clear) out.clear_t = std::min(out.clear_t, t);
    // Where the ray passes an edge of a facet that it grazes, rounding moves the hit along the ray.
    out.hits.emplace_back(near_edge ? t - near / std::max(sine, 1e-6) : t, static_cast<std::int32_t>(id));
  }

  const Geometry& geometry_;
  const std::vector<Material>& materials_;
  struct Sphere {
    Vec3d middle;
    double radius;
  };
  std::vector<Sphere> spheres_;  // around the triangles
  double size_ = 0;
  Vec3d middle_{};
};

// A source of rays in a scene: random ones, real ones, and rays at shared edges.
class RaySource {
 public:
  RaySource(const RenderScene& scene, const DoubleOracle& oracle) : scene_(scene), oracle_(oracle) {}

  void fill(int block_index, RayBlock& out) {
    const Vec3f at = anywhere();
    const PlacedCamera* camera = scene_.cameras.empty() ? nullptr : &scene_.cameras[random_() % scene_.cameras.size()];
    const float x = draw(), y = draw();
    for (int lane = 0; lane < 16; ++lane) {
      Vec3f origin{}, direction{};
      switch (block_index % 8) {
        case 0:
        case 1:  // anywhere to anywhere
          origin = anywhere(), direction = unit(anywhere() - origin);
          break;
        case 2:  // a packet from one place
          origin = at, direction = unit(anywhere() - at);
          break;
        case 3:
        case 4:  // at the edges of triangles
          origin = block_index % 8 == 3 ? anywhere() : at, direction = unit(on_an_edge() - origin);
          break;
        default:  // from a camera, 4 x 4 rays a block, bent at the first body of water
          if (camera == nullptr) {
            origin = at, direction = unit(on_an_edge() - at);
            break;
          }
          from_camera(camera->camera, x + static_cast<float>(lane % 4) * 0.004f,
                      y + static_cast<float>(lane / 4) * 0.004f, block_index % 8, origin, direction);
      }
      for (int a = 0; a < 3; ++a) out.origin_world[a][lane] = origin[a], out.direction_world[a][lane] = direction[a];
      out.t_far[lane] = kFar;
    }
  }

 private:
  // -1 to 1.
  float draw() { return static_cast<float>(random_() >> 8) * 0x1p-23f - 1.0f; }
  static Vec3f unit(Vec3f v) {
    const float length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    return length > 1e-12f ? v * (1.0f / length) : Vec3f{0, -1, 0};
  }
  Vec3f anywhere() {
    const float half = static_cast<float>(0.6 * oracle_.size());
    const Vec3d m = oracle_.middle();
    return Vec3f{static_cast<float>(m.x), static_cast<float>(m.y), static_cast<float>(m.z)} +
           Vec3f{draw(), draw(), draw()} * half;
  }
  Vec3f on_an_edge() {
    const Geometry& g = scene_.geometry;
    const Geometry::TriangleRecord& r = g.triangles[random_() % g.triangles.size()];
    const std::size_t k = random_() % 3;
    const Vec3f a = g.vertices[r.vertex[k]].position_world, b = g.vertices[r.vertex[(k + 1) % 3]].position_world;
    const float s = 0.5f + 0.5f * draw();
    return a + (b - a) * s;
  }
  // kind 5: the eye's ray itself; 6: refracted at the water, its normal tilted as by waves; 7: reflected there.
  void from_camera(const Camera& camera, float x, float y, int kind, Vec3f& origin, Vec3f& direction) {
    const float tangent = camera.orthographic ? 0.5f : camera.tan_half_yfov;
    origin = camera.position_world;
    direction =
        unit(camera.forward_world + camera.right_world * (x * tangent * 1.7f) + camera.up_world * (y * tangent));
    if (kind == 5 || scene_.waters.empty()) return;
    const WaterBody& body = scene_.waters.front();
    const float approach = dot(direction, body.normal), height = dot(body.origin - origin, body.normal);
    if (approach == 0.0f || height / approach <= 0.0f) return;
    origin = origin + direction * (height / approach);
    Vec3f n = unit(body.normal + Vec3f{draw(), draw(), draw()} * 0.05f);
    const bool from_above = dot(direction, n) < 0.0f;
    if (!from_above) n = -n;
    const float cosine = -dot(direction, n), eta = from_above ? 1.0f / body.ior : body.ior;
    const float k = 1.0f - eta * eta * (1.0f - cosine * cosine);
    direction = kind == 7 || k < 0.0f ? unit(direction + n * (2.0f * cosine))
                                      : unit(direction * eta + n * (eta * cosine - std::sqrt(k)));
  }

  const RenderScene& scene_;
  const DoubleOracle& oracle_;
  std::mt19937 random_{17};
};

struct Counts {
  int rays = 0, hits = 0, blocked = 0, differ = 0, shadows_differ = 0, not_allowed = 0;
};

RayPacket packet_of(const RayBlock& rays) { return make_packet(rays.origin_world, rays.direction_world, rays.t_far); }
Vec3d lane_of(const float (&v)[3][16], int lane) {
  return {static_cast<double>(v[0][lane]), static_cast<double>(v[1][lane]), static_cast<double>(v[2][lane])};
}

// Rays from the hits of a block towards the sun, as shadow rays go.
RayBlock towards_sun(const RenderScene& scene, const RayBlock& rays, const HitsOfBlock& hits) {
  RayBlock out = rays;
  if (scene.lighting.directional.empty()) return out;
  const Vec3f sun = -scene.lighting.directional.front().direction_world;
  for (int lane = 0; lane < 16; ++lane) {
    if (hits.id[lane] == kNoId) continue;
    for (int a = 0; a < 3; ++a) {
      // A little before the hit: off the surface.
      out.origin_world[a][lane] += rays.direction_world[a][lane] * hits.t[lane] * 0.9999f;
      out.direction_world[a][lane] = sun[a];
    }
  }
  return out;
}

// All rays of a scene; alpha-tested triangles are taken as opaque by both.
void compare(const char* name, RenderScene scene) {
  for (Material& m : scene.materials.materials)
    if (m.alpha_mode == AlphaMode::kMask) m.alpha_mode = AlphaMode::kOpaque;
  const std::vector<DrawState> states = draw_states(scene.materials.materials);
  ShadingView view;
  view.geometry = view_of(scene.geometry, states.data());
  view.materials = scene.materials.materials.data();
  view.textures = scene.materials.textures.data();
  ThreadPool pool(2);
  Bvh16 bvh;
  bvh.build(scene.geometry, scene.materials, Bvh16::Content::kOpaque, true, pool);
  const EmbreeQueries embree(scene, 2, false);
  const DoubleOracle oracle(scene);
  const bench::TraceKernels& kernels = bench::trace_kernels(best_isa());

  std::vector<RayBlock> blocks(kBlocks);
  RaySource source(scene, oracle);
  for (int b = 0; b < kBlocks; ++b) source.fill(b, blocks[static_cast<std::size_t>(b)]);
  std::vector<Counts> counts(static_cast<std::size_t>(kBlocks));
  pool.for_each(blocks.size(), [&](std::size_t b, int) {
    Counts& n = counts[b];
    RayBlock& rays = blocks[b];
    HitsOfBlock ours, each;
    kernels.nearest(bvh, view, rays, ours), kernels.each(bvh, view, rays, each);
    RayPacket theirs = packet_of(rays);
    embree.first_hits(theirs, 0xFFFFu, b % 2 == 0);
    for (int lane = 0; lane < 16; ++lane) {
      ++n.rays, n.hits += ours.id[lane] != kNoId;
      // Packets and single rays find the same, bit for bit.
      if (ours.id[lane] != each.id[lane] || ours.t[lane] != each.t[lane]) ++n.not_allowed;
      if (ours.id[lane] == theirs.id[lane]) continue;
      ++n.differ;
      const auto answers =
          oracle.of(lane_of(rays.origin_world, lane), lane_of(rays.direction_world, lane), 1e200, false);
      if (!oracle.allows(answers, ours.id[lane]) || !oracle.allows(answers, theirs.id[lane])) ++n.not_allowed;
    }
    const RayBlock shadow = towards_sun(scene, rays, ours);
    const std::uint32_t blocked = kernels.blocked(bvh, view, shadow);
    const std::uint32_t theirs_blocked = embree.blocked(packet_of(shadow), 0xFFFFu);
    n.blocked += __builtin_popcount(blocked);
    for (std::uint32_t left = blocked ^ theirs_blocked; left != 0; left &= left - 1) {
      const int lane = __builtin_ctz(left);
      ++n.shadows_differ;
      const auto answers =
          oracle.of(lane_of(shadow.origin_world, lane), lane_of(shadow.direction_world, lane), 1e200, true);
      if (!oracle.allows_blocked(answers, (blocked >> lane & 1u) != 0) ||
          !oracle.allows_blocked(answers, (theirs_blocked >> lane & 1u) != 0))
        ++n.not_allowed;
    }
  });
  Counts sum;
  for (const Counts& n : counts) {
    sum.rays += n.rays, sum.hits += n.hits, sum.blocked += n.blocked, sum.differ += n.differ;
    sum.shadows_differ += n.shadows_differ, sum.not_allowed += n.not_allowed;
  }
  std::printf("%s: %d rays, %d hit, %d shadow rays blocked; first hits differ %d, shadows %d, not allowed %d\n", name,
              sum.rays, sum.hits, sum.blocked, sum.differ, sum.shadows_differ, sum.not_allowed);
  CHECK(sum.rays == 16 * kBlocks);
  CHECK(sum.hits > sum.rays / 20);
  CHECK(sum.blocked > 1000);
  CHECK(sum.not_allowed == 0);
  // Differences are rare where rays do not aim at edges: a quarter of these do.
  CHECK(sum.differ < sum.rays / 10);
}

}  // namespace

TEST_CASE("against embree: pool", "[trace]") { compare("pool", built_in("pool", 16'000)); }
TEST_CASE("against embree: pond", "[trace]") { compare("pond", built_in("pond", 16'000)); }
TEST_CASE("against embree: tank", "[trace]") { compare("tank", built_in("tank", 16'000)); }
TEST_CASE("against embree: knot", "[trace]") { compare("knot", built_in("knot", 100'000)); }

TEST_CASE("against embree: foreign files", "[trace]") {
  const char* shared = std::getenv("SHOAL_SHARED_DATA");
  if (shared == nullptr || !std::filesystem::exists(std::string(shared) + "/gltf/FlightHelmet")) {
    WARN("skipped: SHOAL_SHARED_DATA does not name a folder with gltf/FlightHelmet");
    return;
  }
  for (const char* name : {"FlightHelmet", "Fox", "Suzanne"}) {
    std::string file;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(std::string(shared) + "/gltf/" + name))
      if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb") file = entry.path().string();
    INFO(name);
    REQUIRE_FALSE(file.empty());
    compare(name, build_render_scene(load_gltf(file)));
  }
}
