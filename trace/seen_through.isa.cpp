// Blended triangles on the way of rays (trace/seen_through.h), composited in exact order.
#include "trace/seen_through.h"

#include "raster/blocks.h"
#include "scene/water_absorption.h"
#include "shading/shade_hits.h"
#include "trace/traversal.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

// Layers a ray keeps a round.
constexpr int kLayers = 8;

// Which of two hits along a ray is in front: the nearer one, at the same distance the smaller id.
SHOAL_INLINE WideM nearer(WideF t, WideI id, WideF other_t, WideI other_id) {
  return (t < other_t) | ((t == other_t) & (id < other_id));
}

// The nearest blended triangles of sixteen rays that are beyond `taken` and in front of `end`, sorted: the query of a
// traversal. What does not fit is found again by a further round, as raster/fragments.h has it.
struct BlendedQuery {
  BlendedQuery(const Ray<WideF>& along, const PathSegment& segment)
      : ray(along), t(segment.end_t), t_near(segment.t_near), end_t(segment.end_t), end_id(segment.end_id) {}

  const Ray<WideF>& ray;
  WideF t;  // how far the traversal goes
  float t_near;
  WideF end_t;
  WideI end_id;
  WideF taken_t{-1.0f};
  WideI taken_id{kNoId};
  WideF layer_t[kLayers];
  WideI layer_id[kLayers];
  int count = 0;
  WideM dropped = mask_from_bits(0);

  static std::uint32_t wanted(const Bvh16::Kinds& kinds) { return kinds.present; }

  void hit_triangle(const LeafView& leaf, int k, Vec3f normal, const TriangleTest& test) {
    WideM hit = test.inside;
    if ((leaf.kinds.one_sided >> k & 1u) != 0)
      hit = hit & !(dot(broadcast<WideF>(normal), ray.direction_world) > WideF(0.0f));
    insert(test.t, WideI(leaf.leaf.id[k]), hit);
  }
  void hit_ray(int lane, const LeafView& leaf, std::uint32_t facing, const float (&at)[16], std::uint32_t triangles) {
    for (std::uint32_t left = triangles & (facing | ~std::uint32_t{leaf.kinds.one_sided}); left != 0;
         left &= left - 1) {
      const int k = __builtin_ctz(left);
      insert(WideF(at[k]), WideI(leaf.leaf.id[k]), lane_index() == WideI(lane));
    }
  }

 private:
  __attribute__((noinline)) void insert(WideF at, WideI which, WideM lanes) {
    const WideM wanted_lanes =
        lanes & (at >= WideF(t_near)) & nearer(at, which, end_t, end_id) & nearer(taken_t, taken_id, at, which);
    if (none(wanted_lanes)) return;
    // Each lane into its own list: what is displaced moves on to the next layer.
    at = select(wanted_lanes, at, WideF(kNowhere));
    which = select(wanted_lanes, which, WideI(kNoId));
    for (int n = 0; n < count; ++n) {
      const WideM here = nearer(at, which, layer_t[n], layer_id[n]);
      const WideF next_t = select(here, layer_t[n], at);
      const WideI next_id = select(here, layer_id[n], which);
      layer_t[n] = select(here, at, layer_t[n]);
      layer_id[n] = select(here, which, layer_id[n]);
      at = next_t, which = next_id;
    }
    const WideM left = which != WideI(kNoId);
    if (none(left)) return;
    if (count == kLayers) {
      dropped = dropped | left;
      return;
    }
    layer_t[count] = at, layer_id[count] = which;
    ++count;
  }

  static constexpr float kNowhere = 3.402823466e38f;
};

}  // namespace

SeenThrough seen_through(const Bvh16& blended, const SceneView& scene, const Ray<WideF>& ray,
                         const RayDifferential<WideF>& differential, const PathSegment& segment, WideM lanes) {
  SeenThrough sum;
  const PlacedWater* water = segment.body < 0 ? nullptr : &scene.water[static_cast<std::size_t>(segment.body)];
  const LightMedium* medium = segment.body < 0 ? nullptr : &scene.light_media[segment.body];
  const GeometryView& geometry = scene.geometry();
  BlendedQuery lists(ray, segment);
  Traversal<BlendedQuery> traversal(blended, geometry, ray, lists);
  for (WideM open = lanes; any(open);) {
    lists.count = 0, lists.dropped = mask_from_bits(0);
    traversal.run(open);
    for (int n = 0; n < lists.count; ++n) {
      const WideM here = open & is_triangle(lists.layer_id[n]) & (sum.transmittance > WideF(0.0f));
      if (none(here)) continue;
      ShadedLanes s;
      shade_hits(scene.shading, ray, differential, lists.layer_id[n], here, medium, s);
      Vec3<WideF> light = s.radiance;
      if (water != nullptr) light = light * absorbed(*water->body, max(s.t * length(ray.direction_world), WideF(0.0f)));
      const WideF alpha = clamp(s.surface.alpha, WideF(0.0f), WideF(1.0f));
      sum.light = select<WideF>(here, sum.light + light * (sum.transmittance * alpha), sum.light);
      sum.transmittance = select(here, sum.transmittance * (WideF(1.0f) - alpha), sum.transmittance);
    }
    open = open & lists.dropped & (sum.transmittance > WideF(0.0f));
    if (none(open)) break;
    lists.taken_t = lists.layer_t[kLayers - 1], lists.taken_id = lists.layer_id[kLayers - 1];
  }
  return sum;
}

}  // namespace shoal::inline SHOAL_ISA_NS
