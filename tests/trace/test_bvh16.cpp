// Traversal of the BVH over a scene's triangles against all of them in double.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "raster/geometry_view.h"
#include "tests/refraction/double_vector.h"
#include "trace/nearest_hit.h"

using namespace shoal_test;

namespace {

// Triangles of all sizes in a box, every third one seen from its front alone, in the scene's order.
struct Soup {
  Geometry geometry;
  Materials materials;
  std::mt19937 random{11};

  float draw() { return static_cast<float>(random() >> 8) * 0x1p-23f - 1.0f; }
  Vec3f point(float size) { return Vec3f{draw(), draw(), draw()} * size; }

  explicit Soup(int count) {
    materials.materials.resize(2);
    materials.materials[0].double_sided = true;
    materials.materials[1].double_sided = false;
    for (int first = 0; first < count; first += 100) {
      std::vector<Vec3f> positions, normals;
      std::vector<std::uint32_t> indices;
      const Vec3f at = point(10.0f);
      for (int k = first; k < std::min(first + 100, count); ++k) {
        const Vec3f corner = at + point(2.0f);
        const float size = k % 7 == 0 ? 3.0f : 0.3f;
        positions.insert(positions.end(), {corner, corner + point(size), corner + point(size)});
      }
      for (std::uint32_t i = 0; i < positions.size(); ++i) indices.push_back(i), normals.push_back({0, 1, 0});
      MeshView mesh;
      mesh.positions_world = positions.data(), mesh.normals_world = normals.data(), mesh.indices = indices.data();
      mesh.vertex_count = mesh.index_count = static_cast<std::uint32_t>(indices.size());
      mesh.material = first / 100 % 3 == 2 ? 1 : 0;
      append_mesh(geometry, mesh);
    }
  }

  //   states  draw_states of the materials; outlives the view
  ShadingView view(const std::vector<DrawState>& states) const {
    ShadingView v;
    v.geometry = view_of(geometry, states.data());
    v.materials = materials.materials.data();
    return v;
  }
};

struct Oracle {
  double t = 1e300, second = 1e300;
  std::int32_t id = kNoId;
  bool at_edge = false;  // the nearest, or something nearer, is met or missed by less than 1e-4 of a triangle's side
};

Oracle all_triangles(const Soup& soup, Vec3f origin, Vec3f direction) {
  Oracle best;
  double edge_t = 1e300;
  const Vec3d o = as_double(origin), d = as_double(direction);
  for (std::size_t i = 0; i < soup.geometry.triangles.size(); ++i) {
    const Geometry::TriangleRecord& r = soup.geometry.triangles[i];
    const auto corner = [&](int k) { return as_double(soup.geometry.vertices[r.vertex[k]].position_world); };
    const Vec3d a = corner(0), e1 = corner(1) - a, e2 = corner(2) - a, n = cross(e1, e2);
    const double nn = dot(n, n), along = dot(d, n);
    if (nn == 0 || along == 0) continue;
    if (!soup.materials.materials[r.material].double_sided && along > 0) continue;
    const double t = dot(a - o, n) / along;
    const Vec3d p = o + d * t - a;
    const double u = dot(cross(p, e2), n) / nn, v = dot(cross(e1, p), n) / nn;
    const double inside = std::min(std::min(u, v), 1 - u - v);
    if (t <= 0 || inside < -1e-4) continue;
    if (inside < 1e-4 || std::fabs(along) < 1e-3 * std::sqrt(nn) || t < 1e-3) edge_t = std::min(edge_t, t);
    if (inside < 0) continue;
    if (t < best.t)
      best.second = best.t, best.t = t, best.id = static_cast<std::int32_t>(i);
    else
      best.second = std::min(best.second, t);
  }
  best.at_edge = edge_t < std::min(best.t * 1.001, 1e299) || (best.id != kNoId && best.second < best.t * 1.0001);
  return best;
}

// How many of the rays had one clear answer; each of those is checked. Packets of rays anywhere and, every other one,
// of rays from about one place that spread a little or more: those go as one packet frustum.
int check_rays(Soup& soup, const Bvh16& bvh, int packets) {
  const std::vector<DrawState> states = draw_states(soup.materials.materials);
  const ShadingView view = soup.view(states);
  int clear = 0;
  for (int packet = 0; packet < packets; ++packet) {
    alignas(64) float value[6][16];
    const Vec3f from = soup.point(12.0f), to = soup.point(10.0f);
    const float spread = packet % 4 == 1 ? 0.01f : 0.5f;
    for (int lane = 0; lane < 16; ++lane) {
      Vec3f origin = soup.point(12.0f), towards = soup.point(10.0f) - origin;
      // Some along an axis: directions with zeros.
      if (lane == 3) towards = {0, -1, 0};
      if (lane == 9) towards = {1, 0, 0};
      if (packet % 2 == 1) origin = from + soup.point(spread), towards = to + soup.point(4.0f * spread) - from;
      const Vec3f direction = normalize(towards);
      const float all[6] = {origin.x, origin.y, origin.z, direction.x, direction.y, direction.z};
      for (int k = 0; k < 6; ++k) value[k][lane] = all[k];
    }
    const auto vector = [&](int k) {
      return Vec3<WideF>{WideF::load(value[k]), WideF::load(value[k + 1]), WideF::load(value[k + 2])};
    };
    const Ray<WideF> ray = {vector(0), vector(3)};
    const WideM lanes = mask_from_bits(packet % 2 == 0 ? 0xFFFFu : 0xBEEFu);
    alignas(64) std::int32_t id[16], known[16];
    nearest_hits(bvh, view, ray, {}, {}, lanes).id.store(id);
    alignas(64) float near_t[16];
    for (int lane = 0; lane < 16; ++lane) {
      if ((to_bits(lanes) >> lane & 1u) == 0) continue;
      const Oracle o = all_triangles(soup, {value[0][lane], value[1][lane], value[2][lane]},
                                     {value[3][lane], value[4][lane], value[5][lane]});
      near_t[lane] = o.id == kNoId ? 1.0f : static_cast<float>(o.t * 0.99);
      if (o.at_edge) continue;
      INFO("lane " << lane << ", t " << o.t << " and " << o.second);
      REQUIRE(id[lane] == o.id);
      ++clear;
    }
    // Nothing is nearer than a little before the nearest: what is known stays.
    for (int lane = 0; lane < 16; ++lane)
      if ((to_bits(lanes) >> lane & 1u) == 0) near_t[lane] = 1.0f;
    nearest_hits(bvh, view, ray, {}, {WideI(-5), WideF::load(near_t)}, lanes).id.store(known);
    for (int lane = 0; lane < 16; ++lane)
      if ((to_bits(lanes) >> lane & 1u) != 0 && id[lane] != kNoId) CHECK(known[lane] == -5);
  }
  return clear;
}

}  // namespace

TEST_CASE("bvh16: the nearest of all triangles", "[trace]") {
  for (const int count : {1, 16, 17, 300, 5000, 20000}) {
    Soup soup(count);
    Bvh16 bvh;
    ThreadPool pool(count == 300 ? 1 : 2);
    bvh.build(soup.geometry, soup.materials, Bvh16::Content::kOpaque, count != 300, pool);
    INFO(count << " triangles");
    REQUIRE(check_rays(soup, bvh, 40) > 400);
    // After everything has moved, by the refitted BVH.
    for (VertexRecord& v : soup.geometry.vertices)
      v.position_world = Vec3f{v.position_world.y, v.position_world.z * 1.5f, -v.position_world.x};
    bvh.refit(soup.geometry, pool);
    REQUIRE(check_rays(soup, bvh, 40) > 400);
  }
}

TEST_CASE("bvh16: a bounded depth, however triangles lie", "[trace]") {
  // Each a third of the way of the one before from a corner: halving by place takes off a few at a time.
  Soup soup(3000);
  float size = 1e18f;
  for (VertexRecord& v : soup.geometry.vertices) {
    v.position_world = v.position_world * (size * 1e-2f);
    size = size < 1e-36f ? 1e18f : size * 0.93f;
  }
  ThreadPool pool(2);
  Bvh16 bvh;
  bvh.build(soup.geometry, soup.materials, Bvh16::Content::kOpaque, false, pool);
  std::vector<int> height(bvh.nodes.size(), 1);
  std::size_t triangles = 0;
  for (std::size_t n = 0; n < bvh.nodes.size(); ++n)
    for (const std::int32_t child : bvh.nodes[n].child) {
      if (child == Bvh16::kNone) continue;
      if (child < 0)
        triangles += static_cast<std::size_t>(__builtin_popcount(bvh.kinds[static_cast<std::size_t>(~child)].present));
      else
        height[n] = std::max(height[n], height[static_cast<std::size_t>(child)] + 1);
    }
  CHECK(triangles == 3000);
  CHECK(height.back() > 3);
  CHECK(height.back() <= Bvh16::kMaxLevels);
}

TEST_CASE("bvh16: builds on any number of threads are equal, and as large as stated", "[trace]") {
  Soup soup(40'000);
  const auto build = [&](int threads) {
    ThreadPool pool(threads);
    Bvh16 bvh;
    bvh.build(soup.geometry, soup.materials, Bvh16::Content::kOpaque, true, pool);
    return bvh;
  };
  const auto same = [](const auto& a, const auto& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
  };
  const Bvh16 serial = build(1);
  for (const int threads : {2, 3, 8}) {
    const Bvh16 parallel = build(threads);
    INFO(threads << " threads");
    CHECK(same(parallel.nodes, serial.nodes));
    CHECK(same(parallel.leaves, serial.leaves));
    CHECK(same(parallel.kinds, serial.kinds));
    CHECK(same(parallel.corners, serial.corners));
  }
  const auto bytes = [](const auto& v) { return static_cast<double>(v.size() * sizeof v[0]) / 40'000; };
  const double without = bytes(serial.nodes) + bytes(serial.leaves) + bytes(serial.kinds);
  CAPTURE(without, bytes(serial.corners));
  CHECK(without < 14);
  CHECK(bytes(serial.corners) < 75);
  CHECK(bytes(serial.corners) > 36);
}

TEST_CASE("bvh16: a blended triangle is in the other content alone", "[trace]") {
  Soup soup(400);
  soup.materials.materials[0].alpha_mode = AlphaMode::kBlend;
  ThreadPool pool(1);
  Bvh16 opaque, blended;
  opaque.build(soup.geometry, soup.materials, Bvh16::Content::kOpaque, false, pool);
  blended.build(soup.geometry, soup.materials, Bvh16::Content::kBlended, false, pool);
  const auto ids = [](const Bvh16& bvh) {
    std::vector<std::int32_t> all;
    for (std::size_t i = 0; i < bvh.leaves.size(); ++i)
      for (const std::int32_t id : bvh.leaves[i].id)
        if (id != Bvh16::kNone) all.push_back(id);
    return all;
  };
  const std::vector<std::int32_t> in_opaque = ids(opaque), in_blended = ids(blended);
  CHECK(in_opaque.size() + in_blended.size() == 400);
  for (const std::int32_t id : in_opaque) CHECK(soup.geometry.triangles[static_cast<std::size_t>(id)].material == 1);
  for (const std::int32_t id : in_blended) CHECK(soup.geometry.triangles[static_cast<std::size_t>(id)].material == 0);
  for (std::size_t i = 0; i < blended.kinds.size(); ++i) CHECK(blended.kinds[i].casts_shadow == 0);
}

TEST_CASE("bvh16: of nothing, and of what is blended", "[trace]") {
  Soup soup(200);
  for (Material& m : soup.materials.materials) m.alpha_mode = AlphaMode::kBlend;
  const std::vector<DrawState> states = draw_states(soup.materials.materials);
  Bvh16 bvh;
  ThreadPool pool(1);
  bvh.build(soup.geometry, soup.materials, Bvh16::Content::kOpaque, true, pool);
  const ShadingView view = soup.view(states);
  const Ray<WideF> ray = {broadcast<WideF>(Vec3f{0, 0, 20}), broadcast<WideF>(Vec3f{0, 0, -1})};
  alignas(64) std::int32_t id[16];
  nearest_hits(bvh, view, ray, {}, {}, mask_from_bits(0xFFFFu)).id.store(id);
  for (const std::int32_t one : id) CHECK(one == kNoId);
}
