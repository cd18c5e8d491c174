// Traversal of the BVH by packets of sixteen rays (trace/nearest_hit.h).
#include "trace/nearest_hit.h"

#include "raster/triangle_test.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

// Children on the stack: at most fifteen a level, and one.
constexpr int kStackSize = 15 * Bvh16::kMaxLevels + 1;

// Rays form one packet frustum where all their directions have, along some axis, the same sign and at least this size.
constexpr float kMinAlong = 0.2f;

SHOAL_INLINE float min_of(WideF v, WideM lanes) { return reduce_min(select(lanes, v, WideF(3e38f))); }
SHOAL_INLINE float max_of(WideF v, WideM lanes) { return reduce_max(select(lanes, v, WideF(-3e38f))); }
SHOAL_INLINE WideF along(const Vec3<WideF>& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

// The axis along which all rays of a packet advance, and its sign.
struct Heading {
  int axis = 0;
  float sense = 0;  // 1 or -1; 0: none
};

// The frustum of a packet of rays: at a depth along its axis all rays lie in an interval on either of the other axes,
// and the ends of the intervals move in proportion to the depth.
struct PacketFrustum {
  int axis[3];
  float sense;
  float base_lo, base_hi;  // where they start, along the axis
  float lo[2], hi[2];      // where they start, along the others
  float slope_lo[2], slope_hi[2];
  WideF per_t;  // depth by length

  // Intervals are wider than their rounding.
  PacketFrustum(const Ray<WideF>& ray, const Heading& heading, WideM lanes) : sense(heading.sense) {
    axis[0] = heading.axis, axis[1] = (heading.axis + 1) % 3, axis[2] = (heading.axis + 2) % 3;
    const WideF main = along(ray.direction_world, axis[0]);
    per_t = abs(main);
    const WideF inverse = WideF(1.0f) / select(lanes, per_t, WideF(1.0f));
    const auto starts = [&](int a, float& from, float& to) SHOAL_LAMBDA {
      const WideF o = along(ray.origin_world, a);
      from = min_of(o, lanes), to = max_of(o, lanes);
      const float by = 1e-6f * max(abs(from), abs(to));
      from -= by, to += by;
    };
    starts(axis[0], base_lo, base_hi);
    for (int k = 0; k < 2; ++k) {
      starts(axis[k + 1], lo[k], hi[k]);
      const WideF slope = along(ray.direction_world, axis[k + 1]) * inverse;
      slope_lo[k] = min_of(slope, lanes), slope_hi[k] = max_of(slope, lanes);
      slope_lo[k] -= 2e-6f * (1.0f + abs(slope_lo[k])), slope_hi[k] += 2e-6f * (1.0f + abs(slope_hi[k]));
    }
  }

  // The boxes that any of the rays may enter before `reach`.
  //   enter  the least depth at which a ray may enter each box
  SHOAL_INLINE WideM passes(const Bvh16::Boxes& boxes, float reach, WideF& enter) const {
    const bool up = sense > 0.0f;
    const WideF first = WideF::load((up ? boxes.lo : boxes.hi)[axis[0]]),
                last = WideF::load((up ? boxes.hi : boxes.lo)[axis[0]]);
    enter = max((first - WideF(up ? base_hi : base_lo)) * WideF(sense), WideF(0.0f));
    const WideF leave = min((last - WideF(up ? base_lo : base_hi)) * WideF(sense), WideF(reach));
    WideM in = enter <= leave;
    for (int k = 0; k < 2; ++k) {
      const WideF from = WideF(lo[k]) + (slope_lo[k] < 0.0f ? leave : enter) * WideF(slope_lo[k]);
      const WideF to = WideF(hi[k]) + (slope_hi[k] < 0.0f ? enter : leave) * WideF(slope_hi[k]);
      in = in & (from <= WideF::load(boxes.hi[axis[k + 1]])) & (to >= WideF::load(boxes.lo[axis[k + 1]]));
    }
    return in;
  }
};

class Search {
 public:
  Search(const Bvh16& tree, const ShadingView& shading, const Ray<WideF>& rays,
         const RayDifferential<WideF>& differential_of, const NearestHit& known)
      : t(known.t), id(known.id), bvh(tree), view(shading), ray(rays), differential(differential_of) {
    const auto inverted = [](WideF d) SHOAL_LAMBDA {
      const WideF least_d = select(d < WideF(0.0f), WideF(-1e-20f), WideF(1e-20f));
      return WideF(1.0f) / select(abs(d) < WideF(1e-20f), least_d, d);
    };
    inverse = {inverted(ray.direction_world.x), inverted(ray.direction_world.y), inverted(ray.direction_world.z)};
    for (int a = 0; a < 3; ++a)
      along(ray.origin_world, a).store(ray_of[a]), along(ray.direction_world, a).store(ray_of[a + 3]);
  }

  void run(const Heading& heading, WideM of_lanes) {
    lanes = of_lanes;
    const PacketFrustum frustum(ray, heading, lanes);
    find_reach(frustum);
    stack_size_ = 0;
    open(frustum, bvh.nodes.size() - 1);
    while (stack_size_ > 0) {
      --stack_size_;
      if (enters[stack_size_] > reach) continue;
      const Bvh16::Node& node = bvh.nodes[parents[stack_size_] >> 4];
      const std::size_t place = parents[stack_size_] & 15u;
      const WideM passing = rays_through(node.boxes, place);
      if (none(passing)) continue;
      const std::int32_t child = node.child[place];
      if (child < 0)
        test_leaf(frustum, static_cast<std::size_t>(~child), passing);
      else
        open(frustum, static_cast<std::size_t>(child));
    }
  }

  WideF t;
  WideI id;

 private:
  // The lanes that enter one box before their nearest hit.
  WideM rays_through(const Bvh16::Boxes& boxes, std::size_t place) const {
    WideF enter(0.0f), leave = t;
    const auto slab = [&](int a, WideF origin, WideF inv) SHOAL_LAMBDA {
      const WideF x = (WideF(boxes.lo[a][place]) - origin) * inv, y = (WideF(boxes.hi[a][place]) - origin) * inv;
      enter = max(enter, min(x, y)), leave = min(leave, max(x, y));
    };
    slab(0, ray.origin_world.x, inverse.x), slab(1, ray.origin_world.y, inverse.y),
        slab(2, ray.origin_world.z, inverse.z);
    return lanes & (enter <= leave);
  }
  void find_reach(const PacketFrustum& frustum) { reach = max_of(t * frustum.per_t, lanes) * 1.000001f; }

  // Pushes the children that the frustum enters, the nearest last.
  void open(const PacketFrustum& frustum, std::size_t at) {
    WideF enter;
    std::uint32_t left = to_bits(frustum.passes(bvh.nodes[at].boxes, reach, enter));
    if (left == 0) return;
    alignas(64) float enter_of[Bvh16::kWidth];
    enter.store(enter_of);
    const int first = stack_size_;
    for (; left != 0; left &= left - 1) {
      const std::uint32_t k = static_cast<std::uint32_t>(__builtin_ctz(left));
      int place = stack_size_++;
      for (; place > first && enters[place - 1] < enter_of[k]; --place)
        parents[place] = parents[place - 1], enters[place] = enters[place - 1];
      parents[place] = static_cast<std::uint32_t>(at) << 4 | k, enters[place] = enter_of[k];
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

  void test_leaf(const PacketFrustum& frustum, std::size_t at, WideM passing) {
    const Bvh16::Leaf& leaf = bvh.leaves[at];
    const Bvh16::Kinds kinds = bvh.kinds[at];
    Bvh16::Corners read;
    const bool kept = bvh.corners.size() != 0;
    if (!kept) find_corners(view.geometry.triangles, view.geometry.vertices, leaf, read);
    const Bvh16::Corners& corners = kept ? bvh.corners[at] : read;
    Bvh16::Boxes boxes;
    find_boxes(corners, boxes);
    WideF enter;
    const std::uint32_t in_frustum = to_bits(frustum.passes(boxes, reach, enter)) & kinds.present;
    if (in_frustum == 0) return;
    if (__builtin_popcount(in_frustum) <= __builtin_popcount(to_bits(passing)))
      test_by_triangles(leaf, corners, kinds, in_frustum);
    else
      test_by_rays(leaf, corners, kinds, in_frustum, to_bits(passing));
    find_reach(frustum);
  }
  // Each triangle against all rays.
  void test_by_triangles(const Bvh16::Leaf& leaf, const Bvh16::Corners& corners, Bvh16::Kinds kinds,
                         std::uint32_t triangles) {
    for (std::uint32_t left = triangles; left != 0; left &= left - 1) {
      const int k = __builtin_ctz(left);
      const auto vector = [k](const float(*v)[Bvh16::kWidth]) SHOAL_LAMBDA { return Vec3f{v[0][k], v[1][k], v[2][k]}; };
      const Vec3f e1 = vector(corners.e1), e2 = vector(corners.e2);
      const TriangleTest test =
          test_triangle(ray, broadcast<WideF>(vector(corners.p0)), broadcast<WideF>(e1), broadcast<WideF>(e2), lanes);
      const WideI candidate(leaf.id[k]);
      WideM hit = test.inside & ((test.t < t) | ((test.t == t) & (candidate < id)));
      if (none(hit)) continue;
      const std::uint32_t bit = 1u << k;
      if ((kinds.one_sided & bit) != 0)
        hit = hit & (dot(ray.direction_world, broadcast<WideF>(cross(e1, e2))) < WideF(0.0f));
      if ((kinds.alpha_tested & bit) != 0)
        hit = hit & mask_from_bits(alpha_bits(view, ray, differential, leaf.id[k], to_bits(hit)));
      t = select(hit, test.t, t);
      id = select(hit, candidate, id);
    }
  }
  // Each ray against all triangles.
  void test_by_rays(const Bvh16::Leaf& leaf, const Bvh16::Corners& corners, Bvh16::Kinds kinds, std::uint32_t triangles,
                    std::uint32_t passing) {
    const auto vector = [](const float(*v)[Bvh16::kWidth]) SHOAL_LAMBDA {
      return Vec3<WideF>{WideF::load(v[0]), WideF::load(v[1]), WideF::load(v[2])};
    };
    const Vec3<WideF> p0 = vector(corners.p0), e1 = vector(corners.e1), e2 = vector(corners.e2);
    alignas(64) float t_of[16];
    alignas(64) std::int32_t id_of[16];
    t.store(t_of), id.store(id_of);
    for (; passing != 0; passing &= passing - 1) {
      const int lane = __builtin_ctz(passing);
      const Ray<WideF> one = {broadcast<WideF>(Vec3f{ray_of[0][lane], ray_of[1][lane], ray_of[2][lane]}),
                              broadcast<WideF>(Vec3f{ray_of[3][lane], ray_of[4][lane], ray_of[5][lane]})};
      const TriangleTest test = test_triangle(one, p0, e1, e2, mask_from_bits(triangles));
      const WideM front = (dot(one.direction_world, cross(e1, e2)) < WideF(0.0f)) |
                          mask_from_bits(~static_cast<std::uint32_t>(kinds.one_sided) & 0xFFFFu);
      std::uint32_t left = to_bits(test.inside & (test.t <= WideF(t_of[lane])) & front);
      if (left == 0) continue;
      alignas(64) float at[16];
      test.t.store(at);
      for (; left != 0; left &= left - 1) {
        const int k = __builtin_ctz(left);
        if (at[k] > t_of[lane] || (at[k] == t_of[lane] && leaf.id[k] > id_of[lane])) continue;
        if ((kinds.alpha_tested >> k & 1u) != 0 && alpha_bits(view, ray, differential, leaf.id[k], 1u << lane) == 0)
          continue;
        t_of[lane] = at[k], id_of[lane] = leaf.id[k];
      }
    }
    t = WideF::load(t_of), id = WideI::load(id_of);
  }

  const Bvh16& bvh;
  const ShadingView& view;
  const Ray<WideF>& ray;
  const RayDifferential<WideF>& differential;
  WideM lanes;
  Vec3<WideF> inverse;  // of the directions
  alignas(64) float ray_of[6][16];
  float reach = 0;  // along the frustum's axis: nothing beyond is nearer than the hits found so far
  int stack_size_ = 0;
  std::uint32_t parents[kStackSize];  // 16 times the node, plus the child's place in it
  float enters[kStackSize];
};

// The common heading of all lanes, or, where there is none, that of the first lane.
Heading find_heading(const Ray<WideF>& ray, WideM lanes) {
  Heading best;
  float most = kMinAlong;
  for (int a = 0; a < 3; ++a) {
    const WideF d = along(ray.direction_world, a);
    const float up = min_of(d, lanes), down = -max_of(d, lanes);
    if (up > most) best = {a, 1.0f}, most = up;
    if (down > most) best = {a, -1.0f}, most = down;
  }
  if (best.sense != 0.0f) return best;
  const int lane = __builtin_ctz(to_bits(lanes));
  most = 0;
  for (int a = 0; a < 3; ++a) {
    const float d = extract(along(ray.direction_world, a), lane);
    if (abs(d) > most) best = {a, d > 0.0f ? 1.0f : -1.0f}, most = abs(d);
  }
  return best;
}

}  // namespace

NearestHit nearest_hits(const Bvh16& bvh, const ShadingView& view, const Ray<WideF>& ray,
                        const RayDifferential<WideF>& differential, const NearestHit& known, WideM lanes) {
  if (bvh.nodes.size() == 0) return known;
  Search search(bvh, view, ray, differential, known);
  while (any(lanes)) {
    const Heading heading = find_heading(ray, lanes);
    const WideM together = lanes & (along(ray.direction_world, heading.axis) * WideF(heading.sense) > WideF(kMinAlong));
    if (none(together)) break;
    search.run(heading, together);
    lanes = lanes & !together;
  }
  return {search.id, search.t};
}

}  // namespace shoal::inline SHOAL_ISA_NS
