// Traversal of a BVH by sixteen rays: one algorithm for every query. Rays that advance together go as one packet
// frustum, the others one by one, each against sixteen boxes or triangles at once.
//
// A ray hits a triangle where the triangle test says so (raster/triangle_test.h) and the ray enters the triangle's own
// box before the hit. The second condition never fails for a hit away from the triangle's edges. It makes the result
// independent of the hierarchy: a node's box holds its triangles' boxes, and the box test is monotone in rounding, so a
// ray that enters a triangle's box enters the boxes of all nodes above it. So neither the tree, nor the order of the
// traversal, nor the packets change a hit (tests/trace/test_against_embree.cpp compares packets with single rays).
#pragma once

#include "raster/triangle_test.h"
#include "trace/packet_frustum.h"

namespace shoal::inline SHOAL_ISA_NS {

// What a query is given of a leaf's triangle, or of all sixteen.
struct LeafView {
  const Bvh16::Leaf& leaf;
  const Bvh16::Kinds& kinds;
};

// Traverses a BVH with one query of sixteen rays.
//
//   Query  holds how far each ray goes and what it has found:
//          WideF t
//            in lengths of the direction; traversal leaves out what lies beyond. The query shortens it as it finds
//            hits; negative: the ray has ended.
//          std::uint32_t wanted(kinds)
//            the triangles of a leaf that count, a bit each
//          void hit_triangle(leaf, k, normal, test)
//            rays against the leaf's triangle k, whose geometric normal is `normal` (cross(e1, e2)); test.inside holds
//            the lanes that hit it
//          void hit_ray(lane, leaf, facing, t, triangles)
//            one ray against a leaf: it hits the triangles of the bits `triangles` at t[k]; bit k of `facing`: from its
//            front
template <class Query>
class Traversal {
 public:
  //   geometry  that the BVH is over: the corners where the BVH holds none
  //   ray       world, direction of about unit length (0.5 to 2)
  Traversal(const Bvh16& tree, const GeometryView& geometry, const Ray<WideF>& rays, Query& of)
      : bvh_(tree), geometry_(geometry), ray_(rays), query_(of) {
    const auto inverted = [](WideF d) SHOAL_LAMBDA {
      const WideF least_d = select(d < WideF(0.0f), WideF(-1e-20f), WideF(1e-20f));
      return WideF(1.0f) / select(abs(d) < WideF(1e-20f), least_d, d);
    };
    inverse_ = {inverted(ray_.direction_world.x), inverted(ray_.direction_world.y), inverted(ray_.direction_world.z)};
    for (int a = 0; a < 3; ++a) {
      along(ray_.origin_world, a).store(ray_of_[a]), along(ray_.direction_world, a).store(ray_of_[a + 3]);
      along(inverse_, a).store(ray_of_[a + 6]);
    }
  }

  // Follows the rays of `lanes` to their ends.
  void run(WideM lanes) {
    if (bvh_.nodes.size() == 0) return;
    while (any(lanes)) {
      const Heading heading = find_heading(ray_, lanes);
      const WideM together =
          lanes & (along(ray_.direction_world, heading.axis) * WideF(heading.sense) > WideF(kMinAlong));
      if (none(together)) break;
      const PacketFrustum frustum(ray_, heading, together);
      if (frustum.is_narrow())
        run_packet(frustum, together);
      else
        for (std::uint32_t left = to_bits(together); left != 0; left &= left - 1) run_one(__builtin_ctz(left));
      lanes = lanes & !together;
    }
  }

  // Follows one ray. Error: finds what run() finds.
  void run_one(int lane) {
    const auto of = [&](int k) SHOAL_LAMBDA { return ray_of_[k][lane]; };
    const Ray<WideF> one = {broadcast<WideF>(Vec3f{of(0), of(1), of(2)}), broadcast<WideF>(Vec3f{of(3), of(4), of(5)})};
    float reach = extract(query_.t, lane);
    if (bvh_.nodes.size() == 0) return;
    stack_size_ = 0;
    std::int32_t at = static_cast<std::int32_t>(bvh_.nodes.size() - 1);
    for (;;) {
      if (at < 0) {
        test_leaf_by_ray(static_cast<std::size_t>(~at), one, lane);
        reach = extract(query_.t, lane);
      } else {
        const Bvh16::Node& node = bvh_.nodes[static_cast<std::size_t>(at)];
        WideF enter;
        const WideM entered = boxes_entered(node.boxes, lane, WideF(reach), enter);
        push(static_cast<std::size_t>(at), to_bits(entered), enter);
      }
      do {
        if (stack_size_ == 0) return;
        --stack_size_;
      } while (enters_[stack_size_] > reach * kBoxSlack);
      at = bvh_.nodes[parents_[stack_size_] >> 4].child[parents_[stack_size_] & 15u];
    }
  }

 private:
  // Children on the stack: at most fifteen a level, and one.
  static constexpr int kStackSize = 15 * Bvh16::kMaxLevels + 1;
  // Widens the interval of a box by more than the rounding of its ends.
  static constexpr float kBoxSlack = 1.000001f;

  void run_packet(const PacketFrustum& frustum, WideM lanes) {
    lanes_ = lanes;
    find_reach(frustum);
    stack_size_ = 0;
    open(frustum, bvh_.nodes.size() - 1);
    while (stack_size_ > 0) {
      --stack_size_;
      if (enters_[stack_size_] > reach_) continue;
      const Bvh16::Node& node = bvh_.nodes[parents_[stack_size_] >> 4];
      const std::size_t place = parents_[stack_size_] & 15u;
      const WideM passing = lanes_ & rays_entering(node.boxes, place, query_.t);
      if (none(passing)) continue;
      const std::int32_t child = node.child[place];
      if (child < 0)
        test_leaf(frustum, static_cast<std::size_t>(~child), passing);
      else
        open(frustum, static_cast<std::size_t>(child));
    }
  }

  // The lanes that enter one box before `end`, in lengths of their directions.
  SHOAL_INLINE WideM rays_entering(const Bvh16::Boxes& boxes, std::size_t place, WideF end) const {
    WideF enter(0.0f), leave = end;
    const auto slab = [&](int a, WideF origin, WideF inv) SHOAL_LAMBDA {
      const WideF x = (WideF(boxes.lo[a][place]) - origin) * inv, y = (WideF(boxes.hi[a][place]) - origin) * inv;
      enter = max(enter, min(x, y)), leave = min(leave, max(x, y));
    };
    slab(0, ray_.origin_world.x, inverse_.x), slab(1, ray_.origin_world.y, inverse_.y),
        slab(2, ray_.origin_world.z, inverse_.z);
    return enter <= leave * WideF(kBoxSlack);
  }
  // The same for one ray and sixteen boxes, bit for bit.
  //   end    of each box
  //   enter  where each one is entered
  SHOAL_INLINE WideM boxes_entered(const Bvh16::Boxes& boxes, int lane, WideF end, WideF& enter) const {
    enter = WideF(0.0f);
    WideF leave = end;
    for (int a = 0; a < 3; ++a) {
      const bool down = ray_of_[a + 6][lane] < 0.0f;
      const WideF origin(ray_of_[a][lane]), inv(ray_of_[a + 6][lane]);
      enter = max(enter, (WideF::load((down ? boxes.hi : boxes.lo)[a]) - origin) * inv);
      leave = min(leave, (WideF::load((down ? boxes.lo : boxes.hi)[a]) - origin) * inv);
    }
    return enter <= leave * WideF(kBoxSlack);
  }
  void find_reach(const PacketFrustum& frustum) { reach_ = max_of(query_.t * frustum.per_t, lanes_) * 1.000003f; }

  // Pushes the children that the frustum enters, the nearest last.
  void open(const PacketFrustum& frustum, std::size_t at) {
    WideF enter;
    const std::uint32_t entered = to_bits(frustum.passes(bvh_.nodes[at].boxes, reach_, enter));
    push(at, entered, enter);
  }
  //   entered  a bit a child of the node
  //   enter    where each one is entered
  SHOAL_INLINE void push(std::size_t at, std::uint32_t entered, WideF enter) {
    if (entered == 0) return;
    alignas(64) float enter_of[Bvh16::kWidth];
    enter.store(enter_of);
    const int first = stack_size_;
    for (; entered != 0; entered &= entered - 1) {
      const std::uint32_t k = static_cast<std::uint32_t>(__builtin_ctz(entered));
      int place = stack_size_++;
      for (; place > first && enters_[place - 1] < enter_of[k]; --place)
        parents_[place] = parents_[place - 1], enters_[place] = enters_[place - 1];
      parents_[place] = static_cast<std::uint32_t>(at) << 4 | k, enters_[place] = enter_of[k];
    }
  }

  // Boxes of a leaf's triangles, grown as bvh16.cpp grows them.
  static void find_boxes(const Bvh16::Corners& leaf, Bvh16::Boxes& boxes) {
    for (int a = 0; a < 3; ++a) {
      const WideF p0 = WideF::load(leaf.p0[a]), e1 = WideF::load(leaf.e1[a]), e2 = WideF::load(leaf.e2[a]);
      const WideF lo = p0 + min(min(e1, e2), WideF(0.0f)), hi = p0 + max(max(e1, e2), WideF(0.0f));
      const WideF by =
          (hi - lo) * WideF(Bvh16::kGrowthOfSize) + max(abs(lo), abs(hi)) * WideF(Bvh16::kGrowthOfCoordinates);
      (lo - by).store(boxes.lo[a]), (hi + by).store(boxes.hi[a]);
    }
  }
  // The corners of a leaf's triangles.
  SHOAL_INLINE const Bvh16::Corners& corners_of(std::size_t leaf, Bvh16::Corners& read) const {
    if (bvh_.corners.size() != 0) return bvh_.corners[leaf];
    find_corners(geometry_.triangles, geometry_.vertices, bvh_.leaves[leaf], read);
    return read;
  }

  void test_leaf(const PacketFrustum& frustum, std::size_t at, WideM passing) {
    const Bvh16::Kinds kinds = bvh_.kinds[at];
    const LeafView leaf{bvh_.leaves[at], kinds};
    Bvh16::Corners read;
    const Bvh16::Corners& corners = corners_of(at, read);
    Bvh16::Boxes boxes;
    find_boxes(corners, boxes);
    WideF enter;
    const std::uint32_t in_frustum = to_bits(frustum.passes(boxes, reach_, enter)) & query_.wanted(kinds);
    if (in_frustum == 0) return;
    const std::uint32_t rays = to_bits(passing);
    if (__builtin_popcount(in_frustum) <= __builtin_popcount(rays)) {
      for (std::uint32_t left = in_frustum; left != 0; left &= left - 1)
        test_triangle_of(leaf, corners, boxes, __builtin_ctz(left));
    } else {
      for (std::uint32_t left = rays; left != 0; left &= left - 1) {
        const int lane = __builtin_ctz(left);
        const auto of = [&](int k) SHOAL_LAMBDA { return ray_of_[k][lane]; };
        test_ray(leaf, corners, &boxes, in_frustum,
                 {broadcast<WideF>(Vec3f{of(0), of(1), of(2)}), broadcast<WideF>(Vec3f{of(3), of(4), of(5)})}, lane);
      }
    }
    find_reach(frustum);
  }
  // One triangle against all rays.
  SHOAL_INLINE void test_triangle_of(const LeafView& leaf, const Bvh16::Corners& corners, const Bvh16::Boxes& boxes,
                                     int k) {
    const auto vector = [k](const float(*v)[Bvh16::kWidth]) SHOAL_LAMBDA { return Vec3f{v[0][k], v[1][k], v[2][k]}; };
    const Vec3f e1 = vector(corners.e1), e2 = vector(corners.e2);
    TriangleTest test =
        test_triangle(ray_, broadcast<WideF>(vector(corners.p0)), broadcast<WideF>(e1), broadcast<WideF>(e2), lanes_);
    test.inside = test.inside & (test.t <= query_.t);
    if (none(test.inside)) return;
    test.inside = test.inside & rays_entering(boxes, static_cast<std::size_t>(k), test.t);
    if (any(test.inside)) query_.hit_triangle(leaf, k, cross(e1, e2), test);
  }
  // One ray against a leaf's triangles.
  //   boxes  of the triangles; null: they are found where the ray hits any
  SHOAL_INLINE void test_ray(const LeafView& leaf, const Bvh16::Corners& corners, const Bvh16::Boxes* boxes,
                             std::uint32_t triangles, const Ray<WideF>& one, int lane) {
    const auto vector = [](const float(*v)[Bvh16::kWidth]) SHOAL_LAMBDA {
      return Vec3<WideF>{WideF::load(v[0]), WideF::load(v[1]), WideF::load(v[2])};
    };
    const Vec3<WideF> e1 = vector(corners.e1), e2 = vector(corners.e2);
    const TriangleTest test = test_triangle(one, vector(corners.p0), e1, e2, mask_from_bits(triangles));
    WideM inside = test.inside & (test.t <= WideF(extract(query_.t, lane)));
    if (none(inside)) return;
    Bvh16::Boxes found;
    if (boxes == nullptr) find_boxes(corners, found), boxes = &found;
    WideF enter;
    inside = inside & boxes_entered(*boxes, lane, test.t, enter);
    if (none(inside)) return;
    alignas(64) float t[Bvh16::kWidth];
    test.t.store(t);
    const std::uint32_t facing = to_bits(dot(one.direction_world, cross(e1, e2)) < WideF(0.0f));
    query_.hit_ray(lane, leaf, facing, t, to_bits(inside));
  }
  void test_leaf_by_ray(std::size_t at, const Ray<WideF>& one, int lane) {
    const Bvh16::Kinds kinds = bvh_.kinds[at];
    Bvh16::Corners read;
    test_ray({bvh_.leaves[at], kinds}, corners_of(at, read), nullptr, query_.wanted(kinds), one, lane);
  }

  const Bvh16& bvh_;
  const GeometryView& geometry_;
  const Ray<WideF>& ray_;
  Query& query_;
  WideM lanes_ = mask_from_bits(0);
  Vec3<WideF> inverse_;              // of the directions
  alignas(64) float ray_of_[9][16];  // origins, directions and their inverses, a row a coordinate
  float reach_ = 0;                  // along the frustum's axis: no ray goes beyond
  int stack_size_ = 0;
  std::uint32_t parents_[kStackSize];  // 16 times the node, plus the child's place in it
  float enters_[kStackSize];
};

}  // namespace shoal::inline SHOAL_ISA_NS
