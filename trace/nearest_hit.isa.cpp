// The nearest triangle of sixteen rays (trace/nearest_hit.h).
#include "trace/nearest_hit.h"

#include "trace/traversal.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

// A hit replaces the one before where it is nearer, or as far and of smaller id: the order of tests changes nothing.
struct NearestQuery {
  const ShadingView& view;
  const Ray<WideF>& ray;
  const RayDifferential<WideF>& differential;
  float t_near;
  WideF t;
  WideI id;

  static std::uint32_t wanted(const Bvh16::Kinds& kinds) { return kinds.present; }

  void hit_triangle(const LeafView& leaf, int k, Vec3f normal, const TriangleTest& test) {
    const WideI candidate(leaf.leaf.id[k]);
    WideM hit = test.inside & (test.t >= WideF(t_near)) & ((test.t < t) | ((test.t == t) & (candidate < id)));
    const std::uint32_t bit = 1u << k;
    if ((leaf.kinds.one_sided & bit) != 0)
      hit = hit & (dot(ray.direction_world, broadcast<WideF>(normal)) < WideF(0.0f));
    if ((leaf.kinds.alpha_tested & bit) != 0)
      hit = hit & mask_from_bits(alpha_bits(view, ray, differential, leaf.leaf.id[k], to_bits(hit)));
    t = select(hit, test.t, t);
    id = select(hit, candidate, id);
  }

  void hit_ray(int lane, const LeafView& leaf, std::uint32_t facing, const float (&at)[16], std::uint32_t triangles) {
    float nearest_t = extract(t, lane);
    std::int32_t nearest_id = extract(id, lane);
    bool found = false;
    for (std::uint32_t left = triangles & (facing | ~std::uint32_t{leaf.kinds.one_sided}); left != 0;
         left &= left - 1) {
      const int k = __builtin_ctz(left);
      if (at[k] < t_near || at[k] > nearest_t || (at[k] == nearest_t && leaf.leaf.id[k] > nearest_id)) continue;
      if ((leaf.kinds.alpha_tested >> k & 1u) != 0 &&
          alpha_bits(view, ray, differential, leaf.leaf.id[k], 1u << lane) == 0)
        continue;
      nearest_t = at[k], nearest_id = leaf.leaf.id[k], found = true;
    }
    if (!found) return;
    const WideM here = lane_index() == WideI(lane);
    t = select(here, WideF(nearest_t), t);
    id = select(here, WideI(nearest_id), id);
  }
};

}  // namespace

NearestHit nearest_hits(const Bvh16& bvh, const ShadingView& view, const Ray<WideF>& ray,
                        const RayDifferential<WideF>& differential, const NearestHit& known, WideM lanes,
                        float t_near) {
  NearestQuery query{view, ray, differential, t_near, known.t, known.id};
  Traversal<NearestQuery>(bvh, view.geometry, ray, query).run(lanes);
  return {query.id, query.t};
}

NearestHit nearest_hit_of_each(const Bvh16& bvh, const ShadingView& view, const Ray<WideF>& ray,
                               const RayDifferential<WideF>& differential, const NearestHit& known, WideM lanes,
                               float t_near) {
  NearestQuery query{view, ray, differential, t_near, known.t, known.id};
  Traversal<NearestQuery> traversal(bvh, view.geometry, ray, query);
  for (std::uint32_t left = to_bits(lanes); left != 0; left &= left - 1) traversal.run_one(__builtin_ctz(left));
  return {query.id, query.t};
}

}  // namespace shoal::inline SHOAL_ISA_NS
