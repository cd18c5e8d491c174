// Ray queries by the BVH, sixteen rays at a time, one copy an ISA.
#include "bench/kernels.h"
#include "core/vec_lanes.h"
#include "trace/blocked_rays.h"
#include "trace/nearest_hit.h"

namespace shoal::bench::inline SHOAL_ISA_NS {

namespace {

void run_nearest(const Bvh16& bvh, const ShadingView& view, const RayBlock& rays, HitsOfBlock& out) {
  const NearestHit hit = nearest_hits(bvh, view, {load3(rays.origin_world), load3(rays.direction_world)}, {},
                                      {WideI(kNoId), WideF::load(rays.t_far)}, mask_from_bits(0xFFFFu));
  hit.id.store(out.id), hit.t.store(out.t);
}

void run_each(const Bvh16& bvh, const ShadingView& view, const RayBlock& rays, HitsOfBlock& out) {
  const NearestHit hit = nearest_hit_of_each(bvh, view, {load3(rays.origin_world), load3(rays.direction_world)}, {},
                                             {WideI(kNoId), WideF::load(rays.t_far)}, mask_from_bits(0xFFFFu));
  hit.id.store(out.id), hit.t.store(out.t);
}

std::uint32_t run_blocked(const Bvh16& bvh, const ShadingView& view, const RayBlock& rays) {
  return blocked_rays(bvh, view, {load3(rays.origin_world), load3(rays.direction_world)}, WideF::load(rays.t_far),
                      0xFFFFu);
}

}  // namespace

}  // namespace shoal::bench::inline SHOAL_ISA_NS

namespace shoal::bench {
const TraceKernels& SHOAL_THIS_ISA(trace_kernels)() {
  static constexpr TraceKernels table{.nearest = &run_nearest, .each = &run_each, .blocked = &run_blocked};
  return table;
}
}  // namespace shoal::bench
