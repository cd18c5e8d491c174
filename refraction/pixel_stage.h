// The pixel side of a frame: view rays, what they hit, and its light, sixteen pixels at a time.
#pragma once

#include "raster/resolve.h"
#include "shading/sky.h"
#include "shading/surface.h"
#include "refraction/frame_data.h"
#include "water/exact_ray.h"

namespace shoal::inline SHOAL_ISA_NS {

// One 4 x 4 block of the frame.
struct Block {
  int x_px, y_px;      // of its first pixel
  std::size_t offset;  // of its first slot in blocked buffers
  WideM in_frame;
};
SHOAL_INLINE Block make_block(const FrameGrid& grid, int x_px, int y_px) {
  const WideI x = WideI(x_px) + block_x(), y = WideI(y_px) + block_y();
  return {x_px, y_px, grid.block_offset(x_px >> 2, y_px >> 2),
          (x < WideI(grid.width_px)) & (y < WideI(grid.height_px))};
}

// Calls body(Block) for each block of a 64-pixel region that has pixels of the frame.
template <class Body>
SHOAL_INLINE void for_each_block(const FrameGrid& grid, std::size_t region, Body body) {
  const int x0 = static_cast<int>(region % static_cast<std::size_t>(grid.regions_x)) * kRegionSize;
  const int y0 = static_cast<int>(region / static_cast<std::size_t>(grid.regions_x)) * kRegionSize;
  const int x1 = min(x0 + kRegionSize, grid.width_px), y1 = min(y0 + kRegionSize, grid.height_px);
  for (int y = y0; y < y1; y += kBlockSize)
    for (int x = x0; x < x1; x += kBlockSize) body(make_block(grid, x, y));
}

// Slots of sixteen pixels, any place of the frame, in blocked buffers.
SHOAL_INLINE WideI pixel_slots(const FrameGrid& grid, WideI x_px, WideI y_px) {
  const WideI block = (y_px >> 2) * WideI(grid.blocks_x) + (x_px >> 2);
  return (block << 4) + ((y_px & WideI(3)) << 2) + (x_px & WideI(3));
}

// The lanes of a block that show a body's surface.
SHOAL_INLINE WideM water_lanes(const FrameData& f, const WaterPass& water, const Block& block) {
  return (WideI::load(f.direct.id.data() + block.offset) == WideI(kFirstWaterId + water.index)) & block.in_frame;
}

SHOAL_INLINE Ray<WideF> block_rays(const View& view, const Block& block) {
  return pixel_ray(view, to_float(WideI(block.x_px) + block_x()) + WideF(0.5f),
                   to_float(WideI(block.y_px) + block_y()) + WideF(0.5f));
}

// The eye's pixel, to filter the water's waves over; null where they are not filtered.
SHOAL_INLINE const RayDifferential<float>* filtering_pixel(const WaterPass& water) {
  return water.surface != nullptr && water.surface->filtered ? &water.pixel : nullptr;
}

// The water as the eye's rays meet it, waves and all.
SHOAL_INLINE WaterSide eye_side(const WaterPass& water) {
  WaterSide side = water_side(*water.body, water.surface, water.optics.eye_below);
  side.t_near = water.near_m;
  side.pixel = filtering_pixel(water);
  return side;
}

// What a method's rays are at water: its refracted ray and, for all methods alike, the reflected one.
template <class F>
struct WaterRays {
  ExactRay<F> at_surface;
  Ray<F> refracted, reflected;  // unit directions
  RayDifferential<F> refracted_differential, reflected_differential;
};

// Beer-Lambert over a length of a body's water.
template <class F>
SHOAL_INLINE Vec3<F> absorbed(const WaterBody& body, F path_m) {
  return transmittance(broadcast<F>(body.absorption_per_m), path_m);
}

// Surface points and their light for one ray a lane.
struct ShadedLanes {
  Vec3<WideF> radiance;
  SurfaceSample<WideF> surface;
  WideF t;  // along the ray
};

//   water  the body that the points may lie in (its water dims their light), or null
void shade_hits(const FrameData& f, const Ray<WideF>& ray, const RayDifferential<WideF>& differential, WideI id,
                WideM active, const WaterPass* water, ShadedLanes& out);

// The covered pixels that a alpha-tested triangle's material keeps where the rays meet it.
std::uint32_t alpha_bits(const FrameData& f, const Ray<WideF>& ray, const RayDifferential<WideF>& differential,
                         std::int32_t id, std::uint32_t cover);

SHOAL_INLINE WideM is_triangle(WideI id) { return (id >= WideI(0)) & (id != WideI(kNoId)); }

}  // namespace shoal::inline SHOAL_ISA_NS
