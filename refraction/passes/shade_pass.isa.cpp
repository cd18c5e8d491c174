// Resolve, light and post (refraction/passes/shade_pass.h).
#include "refraction/passes/shade_pass.h"

#include "raster/ray_triangle.h"
#include "refraction/data/capture.h"
#include "refraction/passes/finish_block.h"
#include "refraction/passes/prefetch.h"
#include "scene/water_absorption.h"
#include "shading/shade_hits.h"
#include "shading/sky.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

// Everything that one block shows, without post.
SHOAL_INLINE void shade_block(const ShadeIn& in, GBuffer& gbuffer, const Block& block, BlockColor& out) {
  const WideI id = WideI::load(in.direct.id.data() + block.offset);
  const Ray<WideF> ray = block_rays(in.view.view, block);
  const std::int32_t medium = in.view.eye_in_water;  // that the eye is in
  const WideM surface = is_triangle(id) & block.in_frame;
  const WideM water = (id < WideI(0)) & block.in_frame;

  WideF eye_path_m(kFarAway_m);  // from the eye to the surface that it sees
  if (any((id == WideI(kNoId)) & block.in_frame))
    out.radiance = background_radiance<WideF>(in.scene.background(), normalize(ray.direction_world));
  if (any(surface)) {
    ShadedLanes s;
    shade_hits(in.scene.shading, ray, pixel_ray_differential<WideF>(in.view.view), id, surface,
               medium >= 0 ? &in.scene.light_media[medium] : nullptr, s);
    out.radiance = select<WideF>(surface, s.radiance, out.radiance);
    out.covered = select(surface, WideF(1.0f), out.covered);
    if (medium >= 0) eye_path_m = select(surface, s.t * length(ray.direction_world), eye_path_m);
    if (in.view.capture) store_surface(gbuffer, block.offset, s.surface, surface);
  }
  if (medium >= 0) {
    const WaterBody& around_eye = *in.scene.water[static_cast<std::size_t>(medium)].body;
    out.radiance = out.radiance * absorbed(around_eye, max(eye_path_m, WideF(0.0f)));
  }
  if (any(water)) {
    out.radiance = select<WideF>(water, load_plane(in.water.radiance, block.offset), out.radiance);
    out.covered = select(water, WideF(1.0f), out.covered);
  }
  if (in.blended_direct != nullptr) lay_over(*in.blended_direct, block, block.in_frame, out.radiance, &out.covered);
}

// Prefetches a block's ids one row of blocks ahead: rows lie pages apart, where the processor does not by itself.
SHOAL_INLINE void prefetch_ids(const ShadeIn& in, std::size_t offset) {
  const std::size_t below = offset + static_cast<std::size_t>(in.grids.frame.blocks_x) * kBlockPixels;
  if (below < in.direct.id.size()) __builtin_prefetch(in.direct.id.data() + below);
}

}  // namespace

void shade(const ShadeIn& in, const ShadeOut& out, std::size_t region) {
  const float exposure = exposure_scale(in.post);
  for_each_block(in.grids.frame, region, [&](const Block& block) SHOAL_LAMBDA {
    BlockColor color;
    prefetch_ids(in, block.offset);
    prefetch_triangles(in.scene, in.direct.id.data(), in.direct.id.size(), block.offset);
    shade_block(in, out.gbuffer, block, color);
    if (in.view.accumulate) finish_block(in.view, in.grids.frame, block, in.post, exposure, color, out.lit, out.srgb8);
  });
}

}  // namespace shoal::inline SHOAL_ISA_NS
