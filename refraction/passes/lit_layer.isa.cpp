// The lit layer of image-space methods (refraction/passes/lit_layer.h).
#include "refraction/passes/lit_layer.h"

#include "raster/geometry_lookup.h"
#include "refraction/data/capture.h"
#include "scene/water_absorption.h"
#include "shading/shade_hits.h"
#include "shading/sky.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

struct LayerRays {
  Ray<WideF> ray;
  RayDifferential<WideF> differential;
};

// The rays along which the layer's pixels are seen: bent by flat water, or straight where they do not cross it, and in
// a layer of the whole scene.
LayerRays layer_rays(const View& view, const WaterOptics& optics, const Block& block) {
  const Ray<WideF> straight = block_rays(view, block);
  const RayDifferential<WideF> own = pixel_ray_differential<WideF>(view);
  if (optics.whole_scene) return {straight, own};
  const ExactRay<WideF> hit = exact_ray(optics.exact, straight);
  const RayDifferential<WideF> bent = refracted_differential(at_crossing(straight, own, hit), hit);
  const WideM goes_in = hit.crosses & hit.transmitted;
  return {{select<WideF>(goes_in, hit.crossing_world, straight.origin_world),
           select<WideF>(goes_in, hit.refracted, straight.direction_world)},
          {select<WideF>(goes_in, bent.origin_dx, own.origin_dx), select<WideF>(goes_in, bent.origin_dy, own.origin_dy),
           select<WideF>(goes_in, bent.direction_dx, own.direction_dx),
           select<WideF>(goes_in, bent.direction_dy, own.direction_dy)}};
}

SHOAL_INLINE WideF height_over(const WaterBody& body, Vec3<WideF> p) {
  return dot(p - broadcast<WideF>(body.origin), broadcast<WideF>(body.normal));
}

void light_block(const LightLayerIn& in, LitLayer& out, const Block& block) {
  const WaterOptics& optics = in.optics;
  const std::size_t drawn_at = in.grids.layers.offset(block.x_px, block.y_px);
  const WideI id = WideI::load(in.refracted.id.data() + drawn_at);
  const LayerRays along = layer_rays(in.view.view, optics, block);
  const WideM drawn = is_triangle(id) & block.in_frame;
  const Vec3<WideF> zero = broadcast<WideF>(Vec3f{0, 0, 0});
  Vec3<WideF> radiance = zero, position = zero;
  if (any(block.in_frame & !drawn))
    radiance = background_radiance<WideF>(in.scene.background(), normalize(along.ray.direction_world));
  // In the water or out of it: a layer of the whole scene shows both sides.
  WideM wet = optics.exact.eye_below ? mask_from_bits(0) : drawn;
  if (optics.whole_scene && any(drawn)) {
    const WideF depth_m =
        view_depth_m(in.view.view, select(drawn, WideF::load(in.refracted.depth.data() + drawn_at), WideF(1.0f)));
    wet = drawn &
          (height_over(optics.body(), along.ray.origin_world + along.ray.direction_world * depth_m) < WideF(0.0f));
  }
  const LightMedium* medium = &in.scene.light_media[optics.water.index];
  for (const bool in_water : {true, false}) {
    const WideM lanes = in_water ? wet : drawn & !wet;
    if (none(lanes)) continue;
    ShadedLanes s;
    shade_hits(in.scene.shading, along.ray, along.differential, id, lanes, in_water ? medium : nullptr, s);
    radiance = select<WideF>(lanes, s.radiance, radiance);
    position = select<WideF>(lanes, s.surface.position_world, position);
  }
  const WideM every = mask_from_bits(0xFFFFu);
  store_plane(out.radiance, block.offset, radiance, every);
  store_plane(out.position_world, block.offset, position, every);
}

// One of the four texels of a fetch.
struct Tap {
  WideI slot, id;
  WideF weight;
  WideM hit;
  Vec3<WideF> position;
};

// Lanes all of whose texels are of one drawable.
WideM one_drawable(std::span<const Drawable> drawables, const Tap (&taps)[4], WideM lanes) {
  const WideM same_triangle =
      lanes & taps[0].hit & (taps[0].id == taps[1].id) & (taps[0].id == taps[2].id) & (taps[0].id == taps[3].id);
  std::uint32_t bits = to_bits(same_triangle);
  std::uint32_t open = to_bits(lanes & !same_triangle & taps[0].hit & taps[1].hit & taps[2].hit & taps[3].hit);
  for (; open != 0; open &= open - 1) {
    const int lane = __builtin_ctz(open);
    const std::size_t first = drawable_of(drawables, extract(taps[0].id, lane));
    bool same = true;
    for (int k = 1; k < 4; ++k) same = same && drawable_of(drawables, extract(taps[k].id, lane)) == first;
    if (same) bits |= 1u << lane;
  }
  return mask_from_bits(bits);
}

}  // namespace

void light_layer(const LightLayerIn& in, LitLayer& out, std::size_t region) {
  for_each_block(in.grids.frame, region, [&](const Block& block) SHOAL_LAMBDA { light_block(in, out, block); });
}

void require_layer(const LazyLayer& layer, const FrameGrid& frame, const LayerPlace<WideF>& place, WideM lanes) {
  // The texels around a place are those at it, rounded down, and the next ones.
  const auto texels = [&](WideF at, int size) SHOAL_LAMBDA {
    const WideF last(static_cast<float>(size - 1));
    const WideF first = floor(clamp(at - WideF(0.5f), WideF(0.0f), last));
    struct {
      int first, last;
    } range{static_cast<int>(reduce_min(select(lanes, first, last))),
            static_cast<int>(reduce_max(select(lanes, min(first + WideF(1.0f), last), WideF(0.0f))))};
    return range;
  };
  const auto x = texels(place.x_px, frame.width_px), y = texels(place.y_px, frame.height_px);
  for (int ry = y.first / kRegionSize; ry <= y.last / kRegionSize; ++ry)
    for (int rx = x.first / kRegionSize; rx <= x.last / kRegionSize; ++rx)
      layer.require(static_cast<std::size_t>(ry * frame.regions_x + rx), &light_layer);
}

void fetch_layer(const FetchIn& in, const ExactRay<WideF>& at, LayerPlace<WideF> place, WideM lanes, HitBlock& hits,
                 FetchedBlock& out) {
  const FrameGrid& grid = in.grids.frame;
  const WaterBody& body = in.optics.body();
  const WideF width(static_cast<float>(grid.width_px)), height(static_cast<float>(grid.height_px));
  const WideF x = clamp(place.x_px - WideF(0.5f), WideF(0.0f), width - WideF(1.0f)),
              y = clamp(place.y_px - WideF(0.5f), WideF(0.0f), height - WideF(1.0f));
  const WideF x_floor = floor(x), y_floor = floor(y), fx = x - x_floor, fy = y - y_floor;
  const WideI x0 = to_int_trunc(x_floor), y0 = to_int_trunc(y_floor);
  const WideI x1 = min(x0 + WideI(1), WideI(grid.width_px - 1)), y1 = min(y0 + WideI(1), WideI(grid.height_px - 1));
  const WideF one(1.0f), zero(0.0f);

  // The texels' light, those that show a surface apart from those that do not: they are absorbed over other lengths.
  Vec3<WideF> lit{zero, zero, zero}, open{zero, zero, zero}, mixed{zero, zero, zero}, nearest{zero, zero, zero};
  WideF covered(0.0f), path_m(0.0f), best(-1.0f);
  WideI nearest_id(kNoId);
  Tap taps[4];
  for (int k = 0; k < 4; ++k) {
    Tap& tap = taps[k];
    tap.weight = ((k & 1) != 0 ? fx : one - fx) * ((k & 2) != 0 ? fy : one - fy);
    const WideI tap_x = (k & 1) != 0 ? x1 : x0, tap_y = (k & 2) != 0 ? y1 : y0, margin(in.grids.layers.margin_px);
    tap.slot = pixel_slots(grid, tap_x, tap_y);
    const WideI drawn_at = pixel_slots(in.grids.layers.grid, tap_x + margin, tap_y + margin);
    tap.id = gather(in.layer.id(), drawn_at, lanes, WideI(kNoId));
    tap.hit = lanes & is_triangle(tap.id);
    const auto texel = [&](const PlaneXyz& planes) SHOAL_LAMBDA {
      return Vec3<WideF>{gather(planes.x.data(), tap.slot, lanes, zero), gather(planes.y.data(), tap.slot, lanes, zero),
                         gather(planes.z.data(), tap.slot, lanes, zero)};
    };
    const Vec3<WideF> light = texel(in.lit.radiance) * tap.weight;
    tap.position = texel(in.lit.position_world);
    const WideF share = select(tap.hit, tap.weight, zero);
    lit = lit + select<WideF>(tap.hit, light, broadcast<WideF>(Vec3f{0, 0, 0}));
    open = open + select<WideF>(tap.hit, broadcast<WideF>(Vec3f{0, 0, 0}), light);
    mixed = mixed + tap.position * share;
    covered = covered + share;
    // On the water's side of the plane alone: in front of it (of a whole scene) nothing is absorbed.
    const WideM wet = height_over(body, tap.position) < WideF(0.05f);
    path_m = path_m + select(wet, length(tap.position - at.crossing_world) * share, zero);
    const WideM nearer = tap.weight > best;
    best = select(nearer, tap.weight, best);
    nearest_id = select(nearer, tap.id, nearest_id);
    nearest = select<WideF>(nearer, tap.position, nearest);
  }
  if (!in.optics.exact.eye_below) {
    lit = lit * absorbed(body, path_m / max(covered, WideF(1e-6f)));
    if (any(lanes & (covered < one))) {
      // Out of the scene through the water's bottom (passes/shade_water.isa.cpp).
      const WideF descent = abs(dot(at.refracted, broadcast<WideF>(body.normal)));
      open = open * absorbed(body, WideF(body.depth_m) / max(descent, WideF(1e-3f)));
    }
  }
  store3(out.radiance, lit + open, lanes);
  store_masked(hits.refracted_id, nearest_id, lanes);
  if (!in.view.capture) return;
  const WideM inside = (place.x_px >= zero) & (place.y_px >= zero) & (place.x_px <= width) & (place.y_px <= height);
  store_masked(out.approximate, select(inside, WideI(0), WideI(1)), lanes);
  const Vec3<WideF> shown = select<WideF>(one_drawable(in.scene.drawables, taps, lanes), mixed, nearest);
  store3(out.position_world, shown, lanes);
}

}  // namespace shoal::inline SHOAL_ISA_NS
