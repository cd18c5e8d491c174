// The broad and the narrow phase's functions, sixteen points or pixels at a time, one copy an ISA.
#include "bench/kernels.h"
#include "bench/solvers/path_solvers.h"
#include "refraction/broad/broad_phase.h"
#include "refraction/narrow/confirm_hit.h"
#include "water/exact_ray.h"

namespace shoal::bench::inline SHOAL_ISA_NS {

namespace {

SHOAL_INLINE Vec3<WideF> load_point(const float* planes, std::size_t count, std::size_t at) {
  return {WideF::load(planes + at), WideF::load(planes + count + at), WideF::load(planes + 2 * count + at)};
}

void run_virtual_distance(const BroadPhase& bp, const float* far_m, const float* across_m, std::size_t count,
                          float* out) {
  for (std::size_t i = 0; i < count; i += 16)
    virtual_distance(bp.path, bp.eye_is_thin, WideF(bp.eye_distance_m), WideF::load(far_m + i),
                     WideF::load(across_m + i))
        .store(out + i);
}

SHOAL_INLINE PathSolution<WideF> solve_by(PathWay way, int steps, const PathConstants& c, const PathTable& table,
                                          WideF thin_m, WideF dense_m, WideF d_m) {
  switch (way) {
    case PathWay::kFixedPoint:
      return solve_fixed_point(c, thin_m, dense_m, d_m, steps);
    case PathWay::kNewton:
      return solve_newton(c, thin_m, dense_m, d_m, steps);
    case PathWay::kHalley:
      return solve_halley(c, thin_m, dense_m, d_m, steps);
    case PathWay::kQuartic:
      return solve_quartic(c, thin_m, dense_m, d_m);
    default:
      return solve_table(c, table, thin_m, dense_m, d_m);
  }
}

void run_solve(const BroadPhase& bp, PathWay way, int steps, const PathTable& table, const float* far_m,
               const float* across_m, std::size_t count, float* out) {
  const WideF eye_m(bp.eye_distance_m);
  for (std::size_t i = 0; i < count; i += 16) {
    const WideF there = WideF::load(far_m + i), d_m = WideF::load(across_m + i);
    const WideF thin_m = bp.eye_is_thin ? eye_m : there, dense_m = bp.eye_is_thin ? there : eye_m;
    apparent_distance(solve_by(way, steps, bp.path, table, thin_m, dense_m, d_m), bp.eye_is_thin, there).store(out + i);
  }
}

void run_virtual_position(const BroadPhase& bp, const float* points, std::size_t count, float* out) {
  for (std::size_t i = 0; i < count; i += 16) {
    const Vec3<WideF> v = virtual_position(bp, load_point(points, count, i));
    v.x.store(out + i), v.y.store(out + count + i), v.z.store(out + 2 * count + i);
  }
}

void run_edge_deviation(const BroadPhase& bp, const View& view, const float* a, const float* b, std::size_t count,
                        float* out) {
  for (std::size_t i = 0; i < count; i += 16)
    edge_deviation_px(bp, view, load_point(a, count, i), load_point(b, count, i)).store(out + i);
}

SHOAL_INLINE WideF sum_of(const RayDifferential<WideF>& d) {
  return (dot(d.origin_dx, d.origin_dy) + dot(d.direction_dx, d.direction_dy));
}

void run_exact_ray(const BroadPhase& bp, const View& view, const FrameGrid& grid, std::size_t region, float* out) {
  const RayDifferential<WideF> differential = pixel_ray_differential<WideF>(view);
  WideF sum(0.0f);
  for_each_block(grid, region, [&](const Block& block) SHOAL_LAMBDA {
    const Ray<WideF> ray = block_rays(view, block);
    const ExactRay<WideF> hit = exact_ray(bp, ray);
    const RayDifferential<WideF> crossing = at_crossing(ray, differential, hit);
    sum = sum + hit.reflectance + dot(hit.refracted, hit.reflected) + sum_of(refracted_differential(crossing, hit)) +
          sum_of(reflected_differential(crossing, hit));
  });
  sum.store(out);
}

void run_confirm(const VisibleIn& in, bool by_neighbours, std::size_t region, std::int32_t* out) {
  WideI last(0);
  for_each_block(in.direct.grid, region, [&](const Block& block) SHOAL_LAMBDA {
    const WideI shown = WideI::load(in.direct.id.data() + block.offset);
    const WideI own = by_neighbours ? WideI(kNoId) : shown;
    const WideI x = WideI(block.x_px) + block_x(), y = WideI(block.y_px) + block_y();
    const WideM lanes = is_triangle(shown) & block.in_frame;
    if (none(lanes)) return;
    last = last ^ confirm_hit(in.shading.geometry, in.direct, block_rays(in.view, block), own, x, y, lanes).id;
  });
  last.store(out);
}

}  // namespace

}  // namespace shoal::bench::inline SHOAL_ISA_NS

namespace shoal::bench {
const RefractionKernels& SHOAL_THIS_ISA(refraction_kernels)() {
  static constexpr RefractionKernels table{
      .virtual_distance = &run_virtual_distance,
      .solve = &run_solve,
      .virtual_position = &run_virtual_position,
      .edge_deviation = &run_edge_deviation,
      .exact_ray = &run_exact_ray,
      .confirm = &run_confirm,
  };
  return table;
}
}  // namespace shoal::bench
