// trace/: our BVH beside Embree 3 on the same rays. Rows come in pairs, `.../shoal` and `.../embree`.
//
//   primary   the camera's rays, a 4 x 4 block a packet: coherent
//   shadow    from the primary hits to the sun, any hit
//   bounce    from the primary hits, cosine-weighted directions, as packets of sixteen
//   single    the same rays, one query for each
//   build, refit
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "bench/harness.h"
#include "bench/kernels.h"
#include "bench/peers/embree/embree_queries.h"
#include "bench/scenes.h"
#include "core/thread_pool.h"

namespace shoal::bench {

namespace {

constexpr int kRaysAcross = 960, kRaysDown = 540;
constexpr float kFar = 3e38f;
constexpr std::size_t kPacketsAtATime = 64;

struct TracedScene {
  const char* name;
  std::uint64_t triangles;
  const char* size;
};
constexpr TracedScene kScenes[] = {{"pool", 128'000, "128k"}, {"pool", 2'400'000, "2.4M"}, {"knot", 2'400'000, "2.4M"}};

// A scene with both structures over it, and its rays. Alpha tests are left out: every triangle is opaque to both.
struct Traced {
  RenderScene scene;
  std::vector<DrawState> states;
  ShadingView view;
  ThreadPool pool{pool_threads()};
  Bvh16 bvh;
  std::unique_ptr<EmbreeQueries> embree;
  std::vector<RayBlock> primary, shadow, bounce;

  explicit Traced(const TracedScene& of) : scene(built_in_scene(of.name, of.triangles)) {
    for (Material& m : scene.materials.materials)
      if (m.alpha_mode == AlphaMode::kMask) m.alpha_mode = AlphaMode::kOpaque;
    states = draw_states(scene.materials.materials);
    view.geometry = view_of(scene.geometry, states.data());
    view.materials = scene.materials.materials.data();
    view.textures = scene.materials.textures.data();
    bvh.build(scene.geometry, scene.materials, Bvh16::Content::kOpaque, true, pool);
    embree = std::make_unique<EmbreeQueries>(scene, pool_threads(), false);
    make_primary();
    make_secondary();
  }

  void make_primary() {
    const Camera& camera = scene.cameras.front().camera;
    for (int y = 0; y < kRaysDown; y += 4)
      for (int x = 0; x < kRaysAcross; x += 4) {
        RayBlock block;
        for (int lane = 0; lane < 16; ++lane) {
          const float right = static_cast<float>(x + lane % 4) + 0.5f - 0.5f * kRaysAcross;
          const float up = 0.5f * kRaysDown - static_cast<float>(y + lane / 4) - 0.5f;
          const float per_px = 2.0f * camera.tan_half_yfov / kRaysDown;
          set(block, lane, camera.position_world,
              normalize(camera.forward_world + camera.right_world * (right * per_px) +
                        camera.up_world * (up * per_px)));
        }
        primary.push_back(block);
      }
  }
  static void set(RayBlock& block, int lane, Vec3f origin, Vec3f direction) {
    for (int a = 0; a < 3; ++a) block.origin_world[a][lane] = origin[a], block.direction_world[a][lane] = direction[a];
    block.t_far[lane] = kFar;
  }

  // From the hits of the primary rays; where a ray hits nothing, its neighbour's hit serves.
  void make_secondary() {
    const Vec3f to_sun = -scene.lighting.directional.front().direction_world;
    Random random;
    Vec3f point = scene.cameras.front().camera.position_world, normal{0, 1, 0};
    for (const RayBlock& rays : primary) {
      HitsOfBlock hits;
      trace_kernels(isa()).nearest(bvh, view, rays, hits);
      RayBlock towards_sun, bounced;
      for (int lane = 0; lane < 16; ++lane) {
        if (hits.id[lane] != kNoId) {
          const Geometry::TriangleRecord& r = scene.geometry.triangles[static_cast<std::size_t>(hits.id[lane])];
          const auto corner = [&](int k) { return scene.geometry.vertices[r.vertex[k]].position_world; };
          const Vec3f facet = cross(corner(1) - corner(0), corner(2) - corner(0));
          Vec3f d{0, 0, 0};
          for (int a = 0; a < 3; ++a) d[a] = rays.direction_world[a][lane];
          Vec3f o{0, 0, 0};
          for (int a = 0; a < 3; ++a) o[a] = rays.origin_world[a][lane];
          normal = normalize(dot(facet, d) > 0 ? -facet : facet);
          point = o + d * hits.t[lane] + normal * 1e-3f;
        }
        set(towards_sun, lane, point, to_sun);
        // A unit vector plus the normal: cosine-weighted.
        const float z = random.between(-1, 1), angle = random.between(0, 6.2831853f), r = std::sqrt(1 - z * z);
        const Vec3f around{r * std::cos(angle), r * std::sin(angle), z};
        const Vec3f direction = normal + around;
        set(bounced, lane, point, dot(direction, direction) < 1e-6f ? normal : normalize(direction));
      }
      shadow.push_back(towards_sun), bounce.push_back(bounced);
    }
  }
};

Traced& traced(const TracedScene& of) {
  static const TracedScene* last = nullptr;
  static std::unique_ptr<Traced> made;
  if (last != &of) made.reset(), made = std::make_unique<Traced>(of), last = &of;
  return *made;
}

// Runs `trace(const RayBlock&)` over all rays on the pool.
template <class Trace>
void run_rays(benchmark::State& state, Traced& scene, const std::vector<RayBlock>& rays, Trace trace) {
  const std::size_t groups = (rays.size() + kPacketsAtATime - 1) / kPacketsAtATime;
  std::vector<std::uint64_t> sums(groups);
  for (auto _ : state) {
    scene.pool.for_each(groups, [&](std::size_t group, int) {
      std::uint64_t sum = 0;
      const std::size_t end = std::min(rays.size(), (group + 1) * kPacketsAtATime);
      for (std::size_t i = group * kPacketsAtATime; i < end; ++i) sum += trace(rays[i]);
      sums[group] = sum;
    });
    benchmark::ClobberMemory();
  }
  count_items(state, "ray", 16.0 * static_cast<double>(rays.size()), pool_threads());
}

std::uint64_t sum_of(const std::int32_t (&id)[16]) {
  std::uint64_t sum = 0;
  for (const std::int32_t one : id) sum += static_cast<std::uint32_t>(one);
  return sum;
}

// Embree's layout; both queries' times contain such a copy's 28 cache lines or less.
RayPacket packet_of(const RayBlock& rays) { return make_packet(rays.origin_world, rays.direction_world, rays.t_far); }

using Rays = std::vector<RayBlock> Traced::*;

void nearest_ours(benchmark::State& state, const TracedScene& of, Rays rays, bool each) {
  Traced& scene = traced(of);
  const auto kernel = each ? trace_kernels(isa()).each : trace_kernels(isa()).nearest;
  run_rays(state, scene, scene.*rays, [&](const RayBlock& block) {
    HitsOfBlock hits;
    kernel(scene.bvh, scene.view, block, hits);
    return sum_of(hits.id);
  });
}
void nearest_embree(benchmark::State& state, const TracedScene& of, Rays rays, bool each, bool coherent) {
  Traced& scene = traced(of);
  run_rays(state, scene, scene.*rays, [&](const RayBlock& block) {
    RayPacket packet = packet_of(block);
    if (each)
      scene.embree->first_hit_of_each(packet, 0xFFFFu);
    else
      scene.embree->first_hits(packet, 0xFFFFu, coherent);
    return sum_of(packet.id);
  });
}

void count_triangles(benchmark::State& state, const Traced& scene) {
  count_items(state, "tri", static_cast<double>(scene.scene.geometry.triangles.size()), pool_threads());
}

void build_ours(benchmark::State& state, const TracedScene& of) {
  Traced& scene = traced(of);
  Bvh16 bvh;
  for (auto _ : state)
    bvh.build(scene.scene.geometry, scene.scene.materials, Bvh16::Content::kOpaque, true, scene.pool);
  count_triangles(state, scene);
}
void build_embree(benchmark::State& state, const TracedScene& of) {
  Traced& scene = traced(of);
  for (auto _ : state) EmbreeQueries(scene.scene, pool_threads(), false);
  count_triangles(state, scene);
}
void refit_ours(benchmark::State& state, const TracedScene& of) {
  Traced& scene = traced(of);
  Bvh16 bvh;
  bvh.build(scene.scene.geometry, scene.scene.materials, Bvh16::Content::kOpaque, true, scene.pool);
  for (auto _ : state) bvh.refit(scene.scene.geometry, scene.pool);
  count_triangles(state, scene);
}
void refit_embree(benchmark::State& state, const TracedScene& of) {
  Traced& scene = traced(of);
  EmbreeQueries moving(scene.scene, pool_threads(), true);
  for (auto _ : state) moving.refit();
  count_triangles(state, scene);
}

}  // namespace

void register_benchmarks() {
  for (const TracedScene& of : kScenes) {
    const std::string scene = std::string("/") + of.name + "/" + of.size;
    const auto pair = [&](const char* what, Rays rays, bool each, bool coherent) {
      add_pooled(what + scene + "/shoal", [=, &of](auto& state) { nearest_ours(state, of, rays, each); });
      add_pooled(what + scene + "/embree", [=, &of](auto& state) { nearest_embree(state, of, rays, each, coherent); });
    };
    pair("primary", &Traced::primary, false, true);
    add_pooled("shadow" + scene + "/shoal", [&of](auto& state) {
      Traced& t = traced(of);
      run_rays(state, t, t.shadow,
               [&](const RayBlock& block) { return trace_kernels(isa()).blocked(t.bvh, t.view, block); });
    });
    add_pooled("shadow" + scene + "/embree", [&of](auto& state) {
      Traced& t = traced(of);
      run_rays(state, t, t.shadow, [&](const RayBlock& block) { return t.embree->blocked(packet_of(block), 0xFFFFu); });
    });
    pair("bounce", &Traced::bounce, false, false);
    pair("single", &Traced::bounce, true, false);
    add_pooled("build" + scene + "/shoal", [&of](auto& state) { build_ours(state, of); });
    add_pooled("build" + scene + "/embree", [&of](auto& state) { build_embree(state, of); });
    add_pooled("refit" + scene + "/shoal", [&of](auto& state) { refit_ours(state, of); });
    add_pooled("refit" + scene + "/embree", [&of](auto& state) { refit_embree(state, of); });
  }
}

}  // namespace shoal::bench
