// Rays towards the sun (trace/sun_blocked.h).
#include "trace/sun_blocked.h"

#include "core/vec_lanes.h"
#include "trace/blocked_rays.h"
#include "water/nearest_water.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

std::uint32_t count_and_trace(const TracedShadows& shadows, const Ray<WideF>& ray, WideF t_far, WideM lanes) {
  const std::uint32_t bits = to_bits(lanes);
  count_rays(*shadows.counts, RayCounts::kShadow, static_cast<std::uint64_t>(__builtin_popcount(bits)));
  return blocked_rays(*shadows.bvh, *shadows.view, ray, t_far, bits);
}

}  // namespace

std::uint32_t sun_blocked(const void* context, const ShadowQuery& query, const SunBend* bend, std::uint32_t of_lanes) {
  const TracedShadows& shadows = *static_cast<const TracedShadows*>(context);
  const WideM lanes = mask_from_bits(of_lanes);
  const Vec3<WideF> position = load3(query.position_world), facet = load3(query.facet_world);
  const Vec3f direction = shadows.view->lighting->directional[0].direction_world;
  const Vec3<WideF> normal = select<WideF>(dot(facet, broadcast<WideF>(direction)) > WideF(0.0f), -facet, facet);
  // The ray starts off the surface by more than its own rounding.
  const WideF size = abs(position.x) + abs(position.y) + abs(position.z);
  Vec3<WideF> from = position + normal * (WideF(1e-4f) + size * WideF(4e-6f));
  WideM shadowed = mask_from_bits(0);
  if (bend != nullptr) {
    const Vec3<WideF> plane_normal = broadcast<WideF>(bend->normal);
    const WideF depth_m = bend->bent ? -dot(from - broadcast<WideF>(bend->origin), plane_normal) : WideF(0.0f);
    const WideM under = lanes & (depth_m > WideF(0.0f));
    if (any(under)) {
      const Vec3<WideF> up = -broadcast<WideF>(bend->refracted_world);
      const WideF t = depth_m / dot(up, plane_normal);
      shadowed = mask_from_bits(count_and_trace(shadows, {from, up}, t, under));
      from = select<WideF>(under, from + up * t, from);
    }
  }
  const WideM open = lanes & !shadowed;
  if (none(open)) return to_bits(shadowed);
  return to_bits(shadowed) | count_and_trace(shadows, {from, -broadcast<WideF>(direction)}, WideF(kEndless), open);
}

}  // namespace shoal::inline SHOAL_ISA_NS
