// Ray queries of sixteen lanes (trace/trace_rays.h).
#include "trace/trace_rays.h"

#include "raster/resolve.h"
#include "shading/shade_hits.h"
#include "water/nearest_water.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

// What the alpha test of a packet needs beside its rays.
struct PacketContext {
  const ShadingView* view;
  const RayDifferential<WideF>* differential;
};

std::uint32_t alpha_test_hits(const void* context, const RayPacket& packet, const std::int32_t* id,
                              std::uint32_t lanes) {
  const PacketContext& c = *static_cast<const PacketContext*>(context);
  const Ray<WideF> ray = {
      {WideF::load(packet.origin_x), WideF::load(packet.origin_y), WideF::load(packet.origin_z)},
      {WideF::load(packet.direction_x), WideF::load(packet.direction_y), WideF::load(packet.direction_z)}};
  alignas(64) std::int32_t aligned_id[16];
  for (int i = 0; i < 16; ++i) aligned_id[i] = id[i];
  std::uint32_t kept = 0;
  for_each_distinct(WideI::load(aligned_id), mask_from_bits(lanes), [&](std::int32_t one, WideM same) SHOAL_LAMBDA {
    kept |= alpha_bits(*c.view, ray, *c.differential, one, to_bits(same));
  });
  return kept;
}

RayDifferential<WideF> no_differential() {
  const Vec3<WideF> zero = broadcast<WideF>(Vec3f{0, 0, 0});
  return {zero, zero, zero, zero};
}

std::uint32_t blocked(const TracedShadows& shadows, const Ray<WideF>& ray, WideF t_far, WideM lanes) {
  const RayDifferential<WideF> differential = no_differential();
  const PacketContext context{shadows.view, &differential};
  RayPacket packet;
  fill_packet(packet, ray, 0.0f, t_far);
  packet.alpha_test = &alpha_test_hits, packet.context = &context;
  const std::uint32_t bits = to_bits(lanes);
  count_rays(*shadows.counts, RayCounts::kShadow, static_cast<std::uint64_t>(__builtin_popcount(bits)));
  return shadows.rays->blocked(packet, bits);
}

SHOAL_INLINE Vec3<WideF> load3(const float (&from)[3][16]) {
  return {WideF::load(from[0]), WideF::load(from[1]), WideF::load(from[2])};
}

}  // namespace

WideI first_hits(const RayQueries& rays, const ShadingView& view, const Ray<WideF>& ray,
                 const RayDifferential<WideF>& differential, float t_near, WideF t_far, WideM lanes) {
  const PacketContext context{&view, &differential};
  RayPacket packet;
  fill_packet(packet, ray, t_near, t_far);
  packet.alpha_test = &alpha_test_hits, packet.context = &context;
  rays.first_hits(packet, to_bits(lanes));
  return WideI::load(packet.id);
}

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
      shadowed = mask_from_bits(blocked(shadows, {from, up}, t, under));
      from = select<WideF>(under, from + up * t, from);
    }
  }
  const WideM open = lanes & !shadowed;
  if (none(open)) return to_bits(shadowed);
  return to_bits(shadowed) | blocked(shadows, {from, -broadcast<WideF>(direction)}, WideF(kEndless), open);
}

}  // namespace shoal::inline SHOAL_ISA_NS
