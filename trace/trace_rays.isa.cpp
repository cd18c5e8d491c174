// Ray queries of sixteen lanes (trace/trace_rays.h).
#include <atomic>

#include "trace/trace_rays.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

// What the alpha test of a packet needs beside its rays.
struct PacketContext {
  const FrameData* frame;
  const RayDifferential<WideF>* differential;
};

std::uint32_t keep_hits(const void* context, const RayPacket& packet, const std::int32_t* id, std::uint32_t lanes) {
  const PacketContext& c = *static_cast<const PacketContext*>(context);
  const Ray<WideF> ray = {
      {WideF::load(packet.origin_x), WideF::load(packet.origin_y), WideF::load(packet.origin_z)},
      {WideF::load(packet.direction_x), WideF::load(packet.direction_y), WideF::load(packet.direction_z)}};
  alignas(64) std::int32_t aligned_id[16];
  for (int i = 0; i < 16; ++i) aligned_id[i] = id[i];
  std::uint32_t kept = 0;
  for_each_distinct(WideI::load(aligned_id), mask_from_bits(lanes), [&](std::int32_t one, WideM same) SHOAL_LAMBDA {
    kept |= alpha_bits(*c.frame, ray, *c.differential, one, to_bits(same));
  });
  return kept;
}

RayDifferential<WideF> no_differential() {
  const Vec3<WideF> zero = broadcast<WideF>(Vec3f{0, 0, 0});
  return {zero, zero, zero, zero};
}

std::uint32_t blocked(const FrameData& f, const Ray<WideF>& ray, WideF t_far, WideM lanes) {
  const RayDifferential<WideF> differential = no_differential();
  const PacketContext context{&f, &differential};
  RayPacket packet;
  fill_packet(packet, ray, 0.0f, t_far);
  packet.keep = &keep_hits, packet.context = &context;
  const std::uint32_t bits = to_bits(lanes);
  count_rays(f, RayCounts::kShadow, static_cast<std::uint64_t>(__builtin_popcount(bits)));
  return f.rays->blocked(packet, bits);
}

constexpr float kEndless = 3e38f;

}  // namespace

void count_rays(const FrameData& f, RayCounts::Kind kind, std::uint64_t rays) {
  std::atomic_ref<std::uint64_t>(f.ray_counts.of[kind]).fetch_add(rays, std::memory_order_relaxed);
}

WideI first_hits(const FrameData& f, const Ray<WideF>& ray, const RayDifferential<WideF>& differential, float t_near,
                 WideF t_far, WideM lanes) {
  const PacketContext context{&f, &differential};
  RayPacket packet;
  fill_packet(packet, ray, t_near, t_far);
  packet.keep = &keep_hits, packet.context = &context;
  f.rays->first_hits(packet, to_bits(lanes));
  return WideI::load(packet.id);
}

WideM sun_blocked(const FrameData& f, const WaterPass* water, Vec3<WideF> position, Vec3<WideF> facet, WideM lanes) {
  const Vec3f direction = f.scene->lighting.directional[0].direction_world;
  const Vec3<WideF> normal = select<WideF>(dot(facet, broadcast<WideF>(direction)) > WideF(0.0f), -facet, facet);
  // Off the surface by more than its own rounding.
  const WideF size = abs(position.x) + abs(position.y) + abs(position.z);
  Vec3<WideF> from = position + normal * (WideF(1e-4f) + size * WideF(4e-6f));
  WideM shadowed = mask_from_bits(0);
  if (water != nullptr) {
    const SunBend bend = bend_of(*water->body, direction);
    const Vec3<WideF> plane_normal = broadcast<WideF>(bend.normal);
    const WideF depth_m = bend.bent ? -dot(from - broadcast<WideF>(bend.origin), plane_normal) : WideF(0.0f);
    const WideM under = lanes & (depth_m > WideF(0.0f));
    if (any(under)) {
      const Vec3<WideF> up = -broadcast<WideF>(bend.refracted_world);
      const WideF t = depth_m / dot(up, plane_normal);
      shadowed = mask_from_bits(blocked(f, {from, up}, t, under));
      from = select<WideF>(under, from + up * t, from);
    }
  }
  const WideM open = lanes & !shadowed;
  if (none(open)) return shadowed;
  return shadowed | mask_from_bits(blocked(f, {from, -broadcast<WideF>(direction)}, WideF(kEndless), open));
}

}  // namespace shoal::inline SHOAL_ISA_NS
