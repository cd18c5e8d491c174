// Shadow rays (trace/blocked_rays.h).
#include "trace/blocked_rays.h"

#include "shading/shade_hits.h"
#include "trace/traversal.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

// Any hit ends a ray.
struct BlockedQuery {
  const ShadingView& view;
  const Ray<WideF>& ray;
  const RayDifferential<WideF>& differential;
  WideF t;
  std::uint32_t blocked = 0;

  static std::uint32_t wanted(const Bvh16::Kinds& kinds) { return kinds.casts_shadow; }

  void end(std::uint32_t lanes) {
    blocked |= lanes;
    t = select(mask_from_bits(lanes), WideF(-1.0f), t);
  }
  void hit_triangle(const LeafView& leaf, int k, Vec3f, const TriangleTest& test) {
    std::uint32_t hit = to_bits(test.inside & (test.t <= t));
    if ((leaf.kinds.alpha_tested >> k & 1u) != 0) hit = alpha_bits(view, ray, differential, leaf.leaf.id[k], hit);
    end(hit);
  }
  void hit_ray(int lane, const LeafView& leaf, std::uint32_t, const float (&)[16], std::uint32_t triangles) {
    const std::uint32_t bit = 1u << lane;
    bool hit = (triangles & ~std::uint32_t{leaf.kinds.alpha_tested}) != 0;
    for (std::uint32_t left = hit ? 0 : triangles; left != 0 && !hit; left &= left - 1)
      hit = alpha_bits(view, ray, differential, leaf.leaf.id[__builtin_ctz(left)], bit) != 0;
    if (hit) end(bit);
  }
};

}  // namespace

std::uint32_t blocked_rays(const Bvh16& bvh, const ShadingView& view, const Ray<WideF>& ray, WideF t_far,
                           std::uint32_t lanes) {
  const Vec3<WideF> zero = broadcast<WideF>(Vec3f{0, 0, 0});
  const RayDifferential<WideF> differential{zero, zero, zero, zero};
  BlockedQuery query{view, ray, differential, t_far};
  Traversal<BlockedQuery>(bvh, view.geometry, ray, query).run(mask_from_bits(lanes));
  return query.blocked;
}

}  // namespace shoal::inline SHOAL_ISA_NS
