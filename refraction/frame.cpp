// One frame, start to end: the page to read first.
//
// Every stage is a call, every buffer a member of FrameData (refraction/frame_data.h). Stages run one after the other,
// each on all threads; the kernels behind them are in raster/ (front end, bins, visibility, resolve, light, post) and
// refraction/ (broad and narrow phase).
#include "refraction/frame.h"

#include "refraction/passes/blend.h"
#include "refraction/stage_digests.h"
#include "refraction/passes/water_region.h"

namespace shoal {

// A method that traces rays: every pixel for itself, no stage but this one.
static void trace_sample(FrameData& f, const MethodKernels& method, ThreadPool& pool, StageClock& clock,
                         StageDigests* digests) {
  pool.for_each(f.grid.region_count(), [&](std::size_t region, int) { method.trace(f, region); });
  clock.lap("trace");
  if (digests != nullptr) digests->direct(f), digests->shaded(f), clock.skip();
}

void render_sample(FrameData& f, const FrameKernels& kernels, const MethodKernels& method, ThreadPool& pool,
                   StageClock& clock, StageDigests* digests) {
  const std::size_t work_items = f.bins.work_items.size();
  const std::size_t tiles = static_cast<std::size_t>(f.bin_grid.tiles_x) * static_cast<std::size_t>(f.bin_grid.tiles_y);
  const std::size_t layer_tiles = f.tile_active.size();
  const std::size_t regions = f.grid.region_count();

  // 0 Sun: its shadow maps hold the whole scene and are there already (shading/shadow/shadow_map.h); they are drawn by
  // Renderer, once for a still scene, each frame for an animated one.

  // 1 Water: where the planes are, seen from this eye. (Flat surfaces have no heights to compute.)
  place_water(f, method);
  clear_blended(f);
  clock.lap("water");
  if (method.trace != nullptr) return trace_sample(f, method, pool, clock, digests);

  // 2 Direct: vertex -> clip -> setup -> bin -> visibility, the water's surface first.
  kernels.water_front_end(f);
  pool.for_each(work_items, [&](std::size_t work_item, int) { kernels.direct_front_end(f, work_item); });
  clock.lap("direct.front_end");
  pool.for_each(tiles, [&](std::size_t tile, int) {
    kernels.draw_tile(f, f.direct, kernels.direct_alpha, nullptr, &f.water_bins, tile);
  });
  clock.lap("direct.visibility");
  if (any_displaced(f)) {
    pool.for_each(regions, [&](std::size_t region, int) { kernels.displaced_water(f, region); });
    clock.lap("water.surface");
  }
  if (digests != nullptr) digests->direct(f), clock.skip();

  // 3 For each body of water that shows: what lies behind its surface, and which of it each pixel sees.
  for (WaterPass& water : f.water) {
    const bool shows = find_region(f, kernels, water, pool);
    clock.lap("water.region");
    if (!shows) continue;
    if (draws_refracted(method, water)) {
      const auto front_end =
          method.refracted_front_end != nullptr ? method.refracted_front_end : kernels.refracted_front_end;
      pool.for_each(work_items, [&](std::size_t work_item, int) { front_end(f, water, work_item); });
      count_capped(f);
      clock.lap("refracted.front_end");
      pool.for_each(layer_tiles, [&](std::size_t tile, int) {
        if (f.tile_active[tile] != 0) kernels.draw_tile(f, f.refracted, method.refracted_alpha, &water, nullptr, tile);
      });
      clock.lap("refracted.visibility");
      if (digests != nullptr) digests->refracted(f), clock.skip();
    }

    if (draws_mirrored(water)) {
      const WaterPass mirrored = mirrored_pass(water);
      pool.for_each(work_items, [&](std::size_t work_item, int) { kernels.mirrored_front_end(f, mirrored, work_item); });
      clock.lap("reflected.front_end");
      pool.for_each(layer_tiles, [&](std::size_t tile, int) {
        if (f.tile_active[tile] != 0)
          kernels.draw_tile(f, f.mirrored, kernels.mirrored_alpha, &mirrored, nullptr, tile);
      });
      clock.lap("reflected.visibility");
      if (digests != nullptr) digests->reflected(f), clock.skip();
    }

    // A method that shades before lights that layer; its narrow phase then looks into the picture.
    if (method.light_layer != nullptr) {
      pool.for_each(regions, [&](std::size_t region, int) { method.light_layer(f, water, region); });
      clock.lap("layer");
      if (digests != nullptr) digests->layer(f), clock.skip();
    }
    pool.for_each(regions, [&](std::size_t region, int) {
      if (f.region_of_body[region] != 0) method.narrow(f, water, region);
    });
    clock.lap("narrow");
    blend_water(f, kernels, method, water, pool, clock);
  }

  // 5 Blended, worked out before 4 lays it over what is behind it: glass and the like, by (depth, id) at each sample.
  blend_direct(f, kernels, pool, clock);
  if (digests != nullptr) digests->blended(f), clock.skip();

  // 4 Resolve, light, post: visible ids to 8-bit pixels, region by region while it is in cache.
  pool.for_each(regions, [&](std::size_t region, int) { method.shade(f, region); });
  clock.lap("shade");
  if (digests != nullptr) digests->shaded(f), clock.skip();
}

}  // namespace shoal
