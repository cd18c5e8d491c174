// The rays that continue from the water pixels of a block, in plain memory, so that a method's function can hand them
// to stages that are compiled once for all methods.
#pragma once

#include "core/ray.h"
#include "raster/ray_triangle.h"
#include "refraction/data/region_hits.h"
#include "refraction/data/view_state.h"
#include "refraction/data/water_pass.h"
#include "water/nearest_water.h"

namespace shoal {

// A ray and how it changes from pixel to pixel.
template <class F>
struct PixelRays {
  Ray<F> ray;  // world, unit direction
  RayDifferential<F> differential;
};

// Sixteen of them: origin, direction, then the differential's origin_dx, origin_dy, direction_dx, direction_dy.
struct alignas(64) RaysBlock {
  float channel[18][16];
};

// What a method's rays may depend on.
struct PixelRaysIn {
  const View& view;
  const FrameGrid& frame;
  const WaterOptics& optics;
  int x_px, y_px;                   // of the block's first pixel
  const InterfaceBlock& interface;  // of the block
  const HitBlock& hits;             // of the block, as far as they are found
  const void* options;              // of the method
};
using PixelRaysFunction = void (*)(const PixelRaysIn&, RaysBlock& out);

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

SHOAL_INLINE void store_rays(const PixelRays<WideF>& r, RaysBlock& to) {
  const Vec3<WideF> all[6] = {r.ray.origin_world,       r.ray.direction_world,       r.differential.origin_dx,
                              r.differential.origin_dy, r.differential.direction_dx, r.differential.direction_dy};
  for (int i = 0; i < 6; ++i)
    all[i].x.store(to.channel[3 * i]), all[i].y.store(to.channel[3 * i + 1]), all[i].z.store(to.channel[3 * i + 2]);
}

SHOAL_INLINE PixelRays<WideF> load_rays(const RaysBlock& from) {
  const auto vector = [&](int i) SHOAL_LAMBDA {
    return Vec3<WideF>{WideF::load(from.channel[i]), WideF::load(from.channel[i + 1]),
                       WideF::load(from.channel[i + 2])};
  };
  return {{vector(0), vector(3)}, {vector(6), vector(9), vector(12), vector(15)}};
}

// Differentials of the unit direction and of the crossing of a block's view rays.
SHOAL_INLINE RayDifferential<WideF> crossing_differential(const PixelRaysIn& in, const ExactRay<WideF>& at) {
  return at_crossing(block_rays(in.view, make_block(in.frame, in.x_px, in.y_px)),
                     pixel_ray_differential<WideF>(in.view), at);
}

// The reflected rays of the surface itself.
SHOAL_INLINE PixelRays<WideF> reflected_rays(const PixelRaysIn& in, const ExactRay<WideF>& at) {
  return {{at.crossing_world, at.reflected}, reflected_differential(crossing_differential(in, at), at)};
}
// Those, or a method's own.
SHOAL_INLINE PixelRays<WideF> reflected_rays(PixelRaysFunction own, const PixelRaysIn& in, const ExactRay<WideF>& at) {
  if (own == nullptr) return reflected_rays(in, at);
  RaysBlock rays;
  own(in, rays);
  return load_rays(rays);
}
SHOAL_INLINE PixelRays<WideF> refracted_rays(PixelRaysFunction of_method, const PixelRaysIn& in) {
  RaysBlock rays;
  of_method(in, rays);
  return load_rays(rays);
}

// Rays that continue from the surface of a body, as a query for the next water that they cross.
SHOAL_INLINE WaterQuery onward_query(const WaterOptics& optics, const ExactRay<WideF>& at, const Ray<WideF>& ray,
                                     bool reflected, WideM lanes) {
  WaterQuery query{ray, lanes};
  query.from = optics.water.index;
  if (!is_displaced(optics)) return query;
  const Vec3<WideF> lift = at.normal * surface_lift(optics.body(), *optics.surface(), at.crossing_world);
  query.lift = reflected ? lift : -lift;
  return query;
}

}  // namespace shoal::inline SHOAL_ISA_NS
