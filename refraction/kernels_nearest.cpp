// The narrow phase's last resort (refraction/narrow/nearest_hit.h).
#include "refraction/narrow/nearest_hit.h"

#include "refraction/narrow/confirm_hit.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

static_assert(sizeof(Geometry::TriangleRecord) == 16 && sizeof(VertexRecord) == 32, "gathered by these strides");

// Nodes that wait: at most fifteen a level, and no scene that fits into memory has ten levels.
constexpr int kMostWaiting = 160;

class Search {
 public:
  Search(const FrameData& frame, const Ray<WideF>& rays, const RayDifferential<WideF>& differential_of)
      : f(frame), packet(rays), differential(differential_of) {}

  std::int32_t nearest(int of_lane, float known_t, std::int32_t known_id) {
    lane = of_lane, t = known_t, id = known_id;
    const auto axis = [&](WideF from, WideF along, float& o, float& inverse_d) SHOAL_LAMBDA {
      o = extract(from, lane);
      const float d = extract(along, lane);
      inverse_d = 1.0f / (abs(d) < 1e-20f ? (d < 0.0f ? -1e-20f : 1e-20f) : d);
    };
    axis(packet.origin_world.x, packet.direction_world.x, origin.x, inverse.x);
    axis(packet.origin_world.y, packet.direction_world.y, origin.y, inverse.y);
    axis(packet.origin_world.z, packet.direction_world.z, origin.z, inverse.z);
    direction = {extract(packet.direction_world.x, lane), extract(packet.direction_world.y, lane),
                 extract(packet.direction_world.z, lane)};
    waiting = 0;
    if (f.tree->nodes.size() == 0) return id;
    push(static_cast<std::int32_t>(f.tree->nodes.size()) - 1, 0.0f);
    while (waiting > 0) {
      --waiting;
      if (enters[waiting] > t) continue;
      if (nodes[waiting] < 0)
        meet(static_cast<std::size_t>(~nodes[waiting]));
      else
        open(f.tree->nodes[static_cast<std::size_t>(nodes[waiting])]);
    }
    return id;
  }

 private:
  void push(std::int32_t node, float at) {
    nodes[waiting] = node;
    enters[waiting++] = at;
  }

  // The children that the ray passes, the nearest last.
  void open(const TriangleTree::Node& node) {
    const auto side = [](float inv, const float* lo, const float* hi, bool first)
                          SHOAL_LAMBDA { return WideF::load((inv >= 0.0f) == first ? lo : hi); };
    const WideF ox(origin.x), oy(origin.y), oz(origin.z), ix(inverse.x), iy(inverse.y), iz(inverse.z);
    const WideF enter = max(max((side(inverse.x, node.min_x, node.max_x, true) - ox) * ix,
                                (side(inverse.y, node.min_y, node.max_y, true) - oy) * iy),
                            max((side(inverse.z, node.min_z, node.max_z, true) - oz) * iz, WideF(0.0f)));
    const WideF leave = min(min((side(inverse.x, node.min_x, node.max_x, false) - ox) * ix,
                                (side(inverse.y, node.min_y, node.max_y, false) - oy) * iy),
                            min((side(inverse.z, node.min_z, node.max_z, false) - oz) * iz, WideF(t)));
    std::uint32_t left = to_bits(enter <= leave);
    if (left == 0) return;
    alignas(64) float at[TriangleTree::kWidth];
    enter.store(at);
    const int first = waiting;
    for (; left != 0; left &= left - 1) {
      const int k = __builtin_ctz(left);
      int place = waiting;
      push(node.child[k], at[k]);
      for (; place > first && enters[place - 1] < at[k]; --place) {
        nodes[place] = nodes[place - 1], enters[place] = enters[place - 1];
        nodes[place - 1] = node.child[k], enters[place - 1] = at[k];
      }
    }
  }

  void corners(std::size_t leaf, WideM there, Vec3<WideF>& p0, Vec3<WideF>& e1, Vec3<WideF>& e2) const {
    if (leaf < f.tree->corners.size()) {
      const TriangleTree::Corners& c = f.tree->corners[leaf];
      p0 = {WideF::load(c.p0_x), WideF::load(c.p0_y), WideF::load(c.p0_z)};
      e1 = {WideF::load(c.e1_x), WideF::load(c.e1_y), WideF::load(c.e1_z)};
      e2 = {WideF::load(c.e2_x), WideF::load(c.e2_y), WideF::load(c.e2_z)};
      return;
    }
    const WideI record = (WideI(f.tree->leaves[leaf].first_triangle) + lane_index()) << 2;
    const std::int32_t* vertex_of = reinterpret_cast<const std::int32_t*>(f.geometry.triangles);
    const float* coordinate_of = reinterpret_cast<const float*>(f.geometry.vertices);
    const auto corner = [&](int k) SHOAL_LAMBDA {
      const WideI at = gather(vertex_of, record + WideI(k), there, WideI(0)) << 3;
      return Vec3<WideF>{gather(coordinate_of, at, there, WideF(0.0f)),
                         gather(coordinate_of, at + WideI(1), there, WideF(0.0f)),
                         gather(coordinate_of, at + WideI(2), there, WideF(0.0f))};
    };
    p0 = corner(0), e1 = corner(1) - p0, e2 = corner(2) - p0;
  }

  void meet(std::size_t leaf_index) {
    const TriangleTree::Leaf& leaf = f.tree->leaves[leaf_index];
    const WideM there = lane_index() < WideI(leaf.triangle_count);
    Vec3<WideF> p0, e1, e2;
    corners(leaf_index, there, p0, e1, e2);
    const Ray<WideF> ray = {broadcast<WideF>(origin), broadcast<WideF>(direction)};
    const TriangleTest test = test_triangle(ray, p0, e1, e2, there);
    WideM met = test.inside & (test.t <= WideF(t));
    if (leaf.one_sided) met = met & (dot(ray.direction_world, cross(e1, e2)) < WideF(0.0f));
    std::uint32_t left = to_bits(met);
    if (left == 0) return;
    alignas(64) float at[TriangleTree::kWidth];
    test.t.store(at);
    for (; left != 0; left &= left - 1) {
      const int k = __builtin_ctz(left);
      const std::int32_t candidate = leaf.first_triangle + k;
      if (at[k] > t || (at[k] == t && candidate > id)) continue;
      if (leaf.masked && alpha_bits(f, packet, differential, candidate, 1u << lane) == 0) continue;
      t = at[k];
      id = candidate;
    }
  }

  const FrameData& f;
  const Ray<WideF>& packet;
  const RayDifferential<WideF>& differential;
  int lane = 0;
  Vec3f origin{}, direction{}, inverse{};
  float t = 0;
  std::int32_t id = kNoId;
  int waiting = 0;
  std::int32_t nodes[kMostWaiting];
  float enters[kMostWaiting];
};

}  // namespace

WideI nearest_hits(const FrameData& f, const Ray<WideF>& ray, const RayDifferential<WideF>& differential, WideF t,
                   WideI id, WideM lanes) {
  alignas(64) std::int32_t ids[16];
  alignas(64) float ts[16];
  id.store(ids), t.store(ts);
  Search search(f, ray, differential);
  for (std::uint32_t left = to_bits(lanes); left != 0; left &= left - 1) {
    const int lane = __builtin_ctz(left);
    ids[lane] = search.nearest(lane, ts[lane], ids[lane]);
  }
  return WideI::load(ids);
}

}  // namespace shoal::inline SHOAL_ISA_NS
