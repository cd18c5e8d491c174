// The lit layer of methods that shade before (refraction/methods/image_space.h): lighting it, and looking into it.
#include "refraction/methods/image_space.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

struct LayerRays {
  Ray<WideF> ray;
  RayDifferential<WideF> differential;
};

// The rays that the layer's pixels are seen along: bent by flat water, or straight where it is not met, or bends none.
LayerRays layer_rays(const FrameData& f, const WaterPass& water, const Block& block, bool whole_scene) {
  const Ray<WideF> straight = block_rays(f.view, block);
  const RayDifferential<WideF> own = pixel_ray_differential<WideF>(f.view);
  if (whole_scene) return {straight, own};
  const ExactRay<WideF> hit = exact_ray(eye_side(water.optics), straight);
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

void light_block(FrameData& f, const WaterPass& water, const Block& block, bool whole_scene) {
  const std::size_t drawn_at = f.layers.offset(block.x_px, block.y_px);
  const WideI id = WideI::load(f.refracted.id.data() + drawn_at);
  const LayerRays along = layer_rays(f, water, block, whole_scene);
  const WideM drawn = is_triangle(id) & block.in_frame;
  const Vec3<WideF> zero = broadcast<WideF>(Vec3f{0, 0, 0});
  Vec3<WideF> radiance = zero, position = zero;
  if (any(block.in_frame & !drawn))
    radiance = background_radiance<WideF>(f.scene->lighting.background, normalize(along.ray.direction_world));
  // In the water or out of it: of a whole scene both sides show.
  WideM wet = water.optics.eye_below ? mask_from_bits(0) : drawn;
  if (whole_scene && any(drawn)) {
    const WideF depth_m =
        view_depth_m(f.view, select(drawn, WideF::load(f.refracted.depth.data() + drawn_at), WideF(1.0f)));
    wet =
        drawn & (height_over(*water.body, along.ray.origin_world + along.ray.direction_world * depth_m) < WideF(0.0f));
  }
  for (const bool in_water : {true, false}) {
    const WideM lanes = in_water ? wet : drawn & !wet;
    if (none(lanes)) continue;
    ShadedLanes s;
    shade_hits(f, along.ray, along.differential, id, lanes, in_water ? &water : nullptr, s);
    radiance = select<WideF>(lanes, s.radiance, radiance);
    position = select<WideF>(lanes, s.surface.position_world, position);
  }
  LitPoints& out = f.layer;
  const WideM every = mask_from_bits(0xFFFFu);
  shade_detail::put3(out.red, out.green, out.blue, block.offset, radiance, every);
  shade_detail::put3(out.x_world, out.y_world, out.z_world, block.offset, position, every);
}

// One of the four texels of a look-up.
struct Tap {
  WideI slot, id;
  WideF weight;
  WideM hit;
  Vec3<WideF> position;
};

std::size_t drawable_of(const Geometry& g, std::int32_t id) {
  std::size_t lo = 0, hi = g.drawables.size();
  while (hi - lo > 1) {
    const std::size_t mid = (lo + hi) / 2;
    (g.drawables[mid].first_triangle <= static_cast<std::uint32_t>(id) ? lo : hi) = mid;
  }
  return lo;
}

// Lanes all of whose texels are of one drawable.
WideM one_drawable(const Geometry& g, const Tap (&taps)[4], WideM lanes) {
  const WideM same_triangle =
      lanes & taps[0].hit & (taps[0].id == taps[1].id) & (taps[0].id == taps[2].id) & (taps[0].id == taps[3].id);
  std::uint32_t bits = to_bits(same_triangle);
  std::uint32_t open = to_bits(lanes & !same_triangle & taps[0].hit & taps[1].hit & taps[2].hit & taps[3].hit);
  for (; open != 0; open &= open - 1) {
    const int lane = __builtin_ctz(open);
    const std::size_t first = drawable_of(g, extract(taps[0].id, lane));
    bool same = true;
    for (int k = 1; k < 4; ++k) same = same && drawable_of(g, extract(taps[k].id, lane)) == first;
    if (same) bits |= 1u << lane;
  }
  return mask_from_bits(bits);
}

}  // namespace

void light_layer(FrameData& f, const WaterPass& water, std::size_t region, bool whole_scene) {
  for_each_block(f.grid, region, [&](const Block& block) SHOAL_LAMBDA { light_block(f, water, block, whole_scene); });
}

void fetch_layer(FrameData& f, const WaterPass& water, const Block& block, const ExactRay<WideF>& at, LayerPlace place,
                 WideM lanes) {
  const FrameGrid& grid = f.grid;
  const WideF width(static_cast<float>(grid.width_px)), height(static_cast<float>(grid.height_px));
  const WideF x = clamp(place.x_px - WideF(0.5f), WideF(0.0f), width - WideF(1.0f)),
              y = clamp(place.y_px - WideF(0.5f), WideF(0.0f), height - WideF(1.0f));
  const WideF x_floor = floor(x), y_floor = floor(y), fx = x - x_floor, fy = y - y_floor;
  const WideI x0 = to_int_trunc(x_floor), y0 = to_int_trunc(y_floor);
  const WideI x1 = min(x0 + WideI(1), WideI(grid.width_px - 1)), y1 = min(y0 + WideI(1), WideI(grid.height_px - 1));
  const WideF one(1.0f), zero(0.0f);

  // The texels' light, those that show a surface apart from those that do not: they are absorbed over other lengths.
  const LitPoints& layer = f.layer;
  Vec3<WideF> lit{zero, zero, zero}, open{zero, zero, zero}, mixed{zero, zero, zero}, nearest{zero, zero, zero};
  WideF covered(0.0f), path_m(0.0f), best(-1.0f);
  WideI nearest_id(kNoId);
  Tap taps[4];
  for (int k = 0; k < 4; ++k) {
    Tap& tap = taps[k];
    tap.weight = ((k & 1) != 0 ? fx : one - fx) * ((k & 2) != 0 ? fy : one - fy);
    const WideI tap_x = (k & 1) != 0 ? x1 : x0, tap_y = (k & 2) != 0 ? y1 : y0, margin(f.layers.margin_px);
    tap.slot = pixel_slots(grid, tap_x, tap_y);
    const WideI drawn_at = pixel_slots(f.layers.grid, tap_x + margin, tap_y + margin);
    tap.id = gather(f.refracted.id.data(), drawn_at, lanes, WideI(kNoId));
    tap.hit = lanes & is_triangle(tap.id);
    const auto texel = [&](const AlignedArray<float>& p, const AlignedArray<float>& q, const AlignedArray<float>& r) {
      return Vec3<WideF>{gather(p.data(), tap.slot, lanes, zero), gather(q.data(), tap.slot, lanes, zero),
                         gather(r.data(), tap.slot, lanes, zero)};
    };
    const Vec3<WideF> light = texel(layer.red, layer.green, layer.blue) * tap.weight;
    tap.position = texel(layer.x_world, layer.y_world, layer.z_world);
    const WideF share = select(tap.hit, tap.weight, zero);
    lit = lit + select<WideF>(tap.hit, light, broadcast<WideF>(Vec3f{0, 0, 0}));
    open = open + select<WideF>(tap.hit, broadcast<WideF>(Vec3f{0, 0, 0}), light);
    mixed = mixed + tap.position * share;
    covered = covered + share;
    // On the water's side of the plane alone: in front of it (of a whole scene) nothing is absorbed.
    const WideM wet = height_over(*water.body, tap.position) < WideF(0.05f);
    path_m = path_m + select(wet, length(tap.position - at.crossing_world) * share, zero);
    const WideM nearer = tap.weight > best;
    best = select(nearer, tap.weight, best);
    nearest_id = select(nearer, tap.id, nearest_id);
    nearest = select<WideF>(nearer, tap.position, nearest);
  }
  if (!water.optics.eye_below) {
    const WaterBody& body = *water.body;
    lit = lit * absorbed(body, path_m / max(covered, WideF(1e-6f)));
    if (any(lanes & (covered < one))) {
      // Out of the scene through the water's bottom (shade_block.h).
      const WideF descent = abs(dot(at.refracted, broadcast<WideF>(body.normal)));
      open = open * absorbed(body, WideF(body.depth_m) / max(descent, WideF(1e-3f)));
    }
  }
  LitPoints& out = f.fetched;
  shade_detail::put3(out.red, out.green, out.blue, block.offset, lit + open, lanes);
  store_masked(f.hits.refracted_id.data() + block.offset, nearest_id, lanes);
  if (!f.capture) return;
  const WideM inside = (place.x_px >= zero) & (place.y_px >= zero) & (place.x_px <= width) & (place.y_px <= height);
  store_masked(out.outside.data() + block.offset, select(inside, WideI(0), WideI(1)), lanes);
  const Vec3<WideF> shown = select<WideF>(one_drawable(f.scene->geometry, taps, lanes), mixed, nearest);
  shade_detail::put3(out.x_world, out.y_world, out.z_world, block.offset, shown, lanes);
}

}  // namespace shoal::inline SHOAL_ISA_NS
