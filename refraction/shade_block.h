// Resolve, light and post, fused: a region of the frame from visible ids to 8-bit pixels while it is in cache.
#pragma once

#include "shading/post.h"
#include "refraction/passes/blend_region.h"
#include "water/rough_mirror.h"
#include "refraction/pixel_stage.h"
#include "trace/path.h"

namespace shoal::inline SHOAL_ISA_NS {

// What a block shows so far; lanes are filled by what they show: surface, water, background.
struct BlockColor {
  Vec3<WideF> radiance{WideF(0.0f), WideF(0.0f), WideF(0.0f)};
  WideF covered{0.0f};
};

namespace shade_detail {
constexpr float kFarAway_m = 1e6f;

SHOAL_INLINE void put(AlignedArray<float>& plane, std::size_t at, WideF v, WideM lanes) {
  store_masked(plane.data() + at, v, lanes);
}
SHOAL_INLINE void put3(AlignedArray<float>& x, AlignedArray<float>& y, AlignedArray<float>& z, std::size_t at,
                       Vec3<WideF> v, WideM lanes) {
  put(x, at, v.x, lanes), put(y, at, v.y, lanes), put(z, at, v.z, lanes);
}

SHOAL_INLINE void capture_surface(FrameData& f, const Block& block, const SurfaceSample<WideF>& s, WideM lanes) {
  AlignedArray<float>* g = f.gbuffer.plane;
  put3(g[GBuffer::kPositionX], g[GBuffer::kPositionY], g[GBuffer::kPositionZ], block.offset, s.position_world, lanes);
  put3(g[GBuffer::kNormalX], g[GBuffer::kNormalY], g[GBuffer::kNormalZ], block.offset, s.normal_world, lanes);
  put3(g[GBuffer::kColorR], g[GBuffer::kColorG], g[GBuffer::kColorB], block.offset, s.base_color, lanes);
  put(g[GBuffer::kMetallic], block.offset, s.metallic, lanes);
  put(g[GBuffer::kRoughness], block.offset, s.roughness, lanes);
}

SHOAL_INLINE void capture_hits(FrameData& f, const Block& block, const Vec3<WideF>& position, const Vec3<WideF>& image,
                               WideI id, HitKind kind, WideM lanes) {
  HitPoints& h = f.hit_points;
  put3(h.x_world, h.y_world, h.z_world, block.offset, position, lanes);
  put3(h.virtual_x, h.virtual_y, h.virtual_z, block.offset, image, lanes);
  store_masked(h.kind.data() + block.offset, WideI(static_cast<std::int32_t>(kind)), lanes);
  store_masked(h.id.data() + block.offset, id, lanes);
}
// Empty where nothing was captured.
SHOAL_INLINE void capture_clear(FrameData& f, const Block& block) {
  const WideM every = mask_from_bits(0xFFFFu);
  const Vec3<WideF> zero = broadcast<WideF>(Vec3f{0, 0, 0});
  capture_surface(f, block, {zero, zero, zero, WideF(0.0f), WideF(0.0f), WideF(0.0f), zero}, every);
  capture_hits(f, block, zero, zero, WideI(kNoId), HitKind::kNoWater, every);
  WideI(0).store(f.hit_points.outside.data() + block.offset);
}
}  // namespace shade_detail

// Radiance along rays into (or, for an eye in the water, back down from) the surface; what the rays show is captured.
//   lanes  that look; shown: the triangle each meets, kNoId none
template <class Capture>
SHOAL_INLINE Vec3<WideF> look(const FrameData& f, const WaterPass& water, const Ray<WideF>& ray,
                              const RayDifferential<WideF>& differential, WideI shown, WideM lanes, bool in_water,
                              Capture capture) {
  const WaterBody& body = *water.body;
  const WideM hit = lanes & is_triangle(shown);
  Vec3<WideF> radiance = broadcast<WideF>(Vec3f{0, 0, 0});
  WideF path_m(shade_detail::kFarAway_m);
  if (any(lanes & !hit)) {
    radiance = background_radiance<WideF>(f.scene->lighting.background, ray.direction_world);
    // Out of the scene through the water's bottom.
    const WideF descent = abs(dot(ray.direction_world, broadcast<WideF>(body.normal)));
    path_m = WideF(body.depth_m) / max(descent, WideF(1e-3f));
  }
  if (any(hit)) {
    ShadedLanes s;
    shade_hits(f, ray, differential, shown, hit, in_water ? &water : nullptr, s);
    radiance = select<WideF>(hit, s.radiance, radiance);
    path_m = select(hit, max(s.t, WideF(0.0f)), path_m);
    capture(s, hit);
  }
  if (in_water) radiance = radiance * absorbed(body, path_m);
  return radiance;
}

// A method that looks into the lit layer (refraction/methods/image_space.h) says so.
template <class M>
concept ShadesBefore = M::kShadesBefore;
// And one that mirrors other rays than the true ones.
template <class M>
concept MirrorsItsWay = requires {
  &M::mirror;
};

// What the narrow phase took from the lit layer.
SHOAL_INLINE Vec3<WideF> show_fetched(FrameData& f, const Block& block, const WaterPass& water, WideM through) {
  const LitPoints& at = f.fetched;
  const auto load3 = [&](const AlignedArray<float>& x, const AlignedArray<float>& y, const AlignedArray<float>& z) {
    return Vec3<WideF>{WideF::load(x.data() + block.offset), WideF::load(y.data() + block.offset),
                       WideF::load(z.data() + block.offset)};
  };
  if (f.capture) {
    const WideI shown = WideI::load(f.hits.refracted_id.data() + block.offset);
    const Vec3<WideF> p = load3(at.x_world, at.y_world, at.z_world);
    shade_detail::capture_hits(f, block, p, virtual_position(water.optics, p), shown, HitKind::kSurface,
                               through & is_triangle(shown));
    store_masked(f.hit_points.outside.data() + block.offset, WideI::load(at.outside.data() + block.offset), through);
  }
  // The other lanes' slots hold anything.
  return select<WideF>(through, load3(at.red, at.green, at.blue), broadcast<WideF>(Vec3f{0, 0, 0}));
}
// Of a method whose rays depend on the pixel: it has pixel_rays(frame, block, water, view ray, differential).
template <class M>
concept PixelRays = requires(const FrameData& f, const Block& block, const WaterPass& water, const Ray<WideF>& ray,
                             const RayDifferential<WideF>& differential) {
  M::pixel_rays(f, block, water, ray, differential);
};
template <class M>
SHOAL_INLINE WaterRays<WideF> water_rays(const FrameData& f, const Block& block, const WaterPass& water,
                                         const Ray<WideF>& ray, const RayDifferential<WideF>& differential) {
  if constexpr (PixelRays<M>)
    return M::pixel_rays(f, block, water, ray, differential);
  else
    return M::template rays<WideF>(water, ray, differential);
}
// Of a method that may find nothing where there is something: kMisses.
template <class M>
concept Misses = M::kMisses;

// What a block's refracted or mirrored rays bring that meet water again.
inline Vec3<WideF> look_again(FrameData& f, const Block& block, const WaterPass& water, const WaterRays<WideF>& rays,
                              bool mirrored, WideM lanes) {
  const ExactRay<WideF>& at = rays.at_surface;
  const bool eye_below = water.optics.eye_below;
  Path path;
  static_cast<WaterQuery&>(path) = onward(water, rays, mirrored, lanes);
  path.differential = mirrored ? rays.reflected_differential : rays.refracted_differential;
  path.weight = broadcast<WideF>(Vec3f{1, 1, 1}) * (mirrored ? at.reflectance : WideF(1.0f) - at.reflectance);
  path.level = 2;
  path.medium = mirrored ? f.eye_in_water : eye_below ? kAir : water.index;
  path.shows = mirrored ? lanes & !at.transmitted : lanes;
  path.shown_as = mirrored ? HitKind::kMirror : HitKind::kSurface;
  path.first_body = water.index;
  return follow_again(f, block, path);
}

// The lanes of a block that show one body's surface.
template <class M>
__attribute__((noinline)) void shade_water(FrameData& f, const Block& block, const WaterPass& water,
                                           const Ray<WideF>& ray, WideM lanes, BlockColor& out) {
  const RayDifferential<WideF> differential = pixel_ray_differential<WideF>(f.view);
  WaterRays<WideF> r = water_rays<M>(f, block, water, ray, differential);
  if constexpr (MirrorsItsWay<M>) M::mirror(f, water, block, r);
  const ExactRay<WideF>& at = r.at_surface;
  const bool eye_below = water.optics.eye_below;
  const bool filtered = filtering_pixel(water) != nullptr;
  Vec3<WideF> mirrored_background;
  if (filtered)
    mirrored_background =
        mirror_roughly<WideF>(f.scene->lighting.background, *water.body, is_displaced(*water.body, water.surface),
                              r.reflected.direction_world, r.at_surface);
  const WideM through = lanes & at.transmitted;
  const Vec3<WideF> zero = broadcast<WideF>(Vec3f{0, 0, 0});

  if (f.capture) {
    // At water pixels the G-buffer holds the surface itself.
    shade_detail::capture_surface(
        f, block,
        {at.crossing_world, at.normal, zero, WideF(0.0f), WideF(0.0f), roughness_of_waves(at.slope_variance), zero},
        lanes);
    shade_detail::capture_hits(f, block, zero, zero, WideI(kNoId), HitKind::kSky, lanes);
  }
  Vec3<WideF> refracted = zero, reflected = zero, from_water = zero;
  if constexpr (ShadesBefore<M>) {
    if (any(through)) refracted = show_fetched(f, block, water, through);
  } else if (any(through)) {
    const WideI shown = WideI::load(f.hits.refracted_id.data() + block.offset);
    if (Misses<M> && f.capture)
      shade_detail::capture_hits(f, block, zero, zero, WideI(kNoId), HitKind::kMiss, through & !is_triangle(shown));
    const WideM again = through & (shown < WideI(0));
    if (any(again)) from_water = look_again(f, block, water, r, false, again);
    refracted = look(f, water, r.refracted, r.refracted_differential, shown, through & !again, !eye_below,
                     [&](const ShadedLanes& s, WideM hit) SHOAL_LAMBDA {
                       if (!f.capture) return;
                       const Vec3<WideF> p = s.surface.position_world;
                       shade_detail::capture_hits(f, block, p, virtual_position(water.optics, p), shown,
                                                  HitKind::kSurface, hit);
                     });
    refracted = select<WideF>(again, zero, refracted);
  }
  if (water.mirrors) {
    const WideI shown = WideI::load(f.hits.mirrored_id.data() + block.offset);
    const WideM again = lanes & (shown < WideI(0));
    if (any(again)) from_water = from_water + look_again(f, block, water, r, true, again);
    reflected = look(f, water, r.reflected, r.reflected_differential, shown, lanes & !again, eye_below,
                     [&](const ShadedLanes& s, WideM hit) SHOAL_LAMBDA {
                       if (!f.capture) return;
                       const WideM total = hit & !at.transmitted;
                       const Vec3<WideF> p = s.surface.position_world;
                       shade_detail::capture_hits(f, block, p, p, shown, HitKind::kMirror, total);
                     });
    if (filtered && !MirrorsItsWay<M> && !eye_below)
      reflected = select<WideF>(lanes & !is_triangle(shown), mirrored_background, reflected);
    reflected = select<WideF>(again, zero, reflected);
  } else if (filtered && !MirrorsItsWay<M>) {
    reflected = mirrored_background;
  } else {
    reflected = background_radiance<WideF>(f.scene->lighting.background, r.reflected.direction_world);
  }
  if (f.blended.any()) {
    lay_over(f.blended.refracted, block, through, refracted, nullptr);
    if (water.mirrors) lay_over(f.blended.mirrored, block, lanes, reflected, nullptr);
  }
  const Vec3<WideF> mixed = (refracted * (WideF(1.0f) - at.reflectance) + reflected * at.reflectance) + from_water;
  out.radiance = select<WideF>(lanes, mixed, out.radiance);
  out.covered = select(lanes, WideF(1.0f), out.covered);
}

// Everything that one block shows, without post.
template <class M>
SHOAL_INLINE void shade_block(FrameData& f, const Block& block, BlockColor& out) {
  const WideI id = WideI::load(f.direct.id.data() + block.offset);
  const Ray<WideF> ray = block_rays(f.view, block);
  const WaterPass* around_eye = f.eye_in_water >= 0 ? &f.water[static_cast<std::size_t>(f.eye_in_water)] : nullptr;
  const WideM surface = is_triangle(id) & block.in_frame;
  const WideM water = (id < WideI(0)) & block.in_frame;
  if (f.capture) shade_detail::capture_clear(f, block);

  WideF eye_path_m(shade_detail::kFarAway_m);  // from the eye to what it sees first
  if (any((id == WideI(kNoId)) & block.in_frame))
    out.radiance = background_radiance<WideF>(f.scene->lighting.background, normalize(ray.direction_world));
  if (any(surface)) {
    ShadedLanes s;
    shade_hits(f, ray, pixel_ray_differential<WideF>(f.view), id, surface, around_eye, s);
    out.radiance = select<WideF>(surface, s.radiance, out.radiance);
    out.covered = select(surface, WideF(1.0f), out.covered);
    if (around_eye != nullptr) eye_path_m = select(surface, s.t * length(ray.direction_world), eye_path_m);
    if (f.capture) shade_detail::capture_surface(f, block, s.surface, surface);
  }
  if (any(water)) {
    for_each_distinct(id, water, [&](std::int32_t one, WideM lanes) SHOAL_LAMBDA {
      const WaterPass& pass = f.water[static_cast<std::size_t>(one - kFirstWaterId)];
      shade_water<M>(f, block, pass, ray, lanes, out);
      if (around_eye != nullptr) {
        const ExactRay<WideF> at = exact_ray(eye_side(pass), ray);
        eye_path_m = select(lanes, length(at.crossing_world - ray.origin_world), eye_path_m);
      }
    });
  }
  if (around_eye != nullptr) out.radiance = out.radiance * absorbed(*around_eye->body, max(eye_path_m, WideF(0.0f)));
  if (f.blended.any()) lay_over(f.blended.direct, block, block.in_frame, out.radiance, &out.covered);
}

// Adds the sample to the picture; the last one encodes it.
SHOAL_INLINE void finish_block(FrameData& f, const Block& block, const PostSettings& post, float exposure,
                               BlockColor c) {
  if (f.lit.red.size() != 0) {
    float* planes[4] = {f.lit.red.data() + block.offset, f.lit.green.data() + block.offset,
                        f.lit.blue.data() + block.offset, f.lit.alpha.data() + block.offset};
    WideF* values[4] = {&c.radiance.x, &c.radiance.y, &c.radiance.z, &c.covered};
    for (int i = 0; i < 4; ++i) {
      if (f.sample > 0) *values[i] = WideF::load(planes[i]) + *values[i];
      if (f.last_sample && f.sample_count > 1)
        *values[i] = *values[i] * WideF(1.0f / static_cast<float>(f.sample_count));
      values[i]->store(planes[i]);
    }
  }
  if (!f.last_sample) return;
  const Vec3<WideF> display = tone_map<WideF>(c.radiance, post, exposure);
  const WideI r = encode_srgb8(display.x), g = encode_srgb8(display.y), b = encode_srgb8(display.z);
  const std::size_t row_bytes = static_cast<std::size_t>(f.grid.width_px) * 3;
  std::uint8_t* pixels =
      f.srgb8.data() + static_cast<std::size_t>(block.y_px) * row_bytes + static_cast<std::size_t>(block.x_px) * 3;
  if (all(block.in_frame)) {
    store_rgb8_block(pixels, row_bytes, r, g, b);
    return;
  }
  std::uint8_t tile[48];
  store_rgb8_block(tile, 12, r, g, b);
  const int columns = min(kBlockSize, f.grid.width_px - block.x_px),
            rows = min(kBlockSize, f.grid.height_px - block.y_px);
  for (int y = 0; y < rows; ++y)
    std::memcpy(pixels + static_cast<std::size_t>(y) * row_bytes, tile + 12 * y, static_cast<std::size_t>(columns) * 3);
}

// Asks for a block's ids one row of blocks ahead: rows lie pages apart, where the processor does not look by itself.
SHOAL_INLINE void prefetch_ids(const FrameData& f, std::size_t offset) {
  const std::size_t below = offset + static_cast<std::size_t>(f.grid.blocks_x) * kBlockPixels;
  if (below >= f.direct.id.size()) return;
  __builtin_prefetch(f.direct.id.data() + below);
  if (!f.water.empty()) __builtin_prefetch(f.hits.refracted_id.data() + below);
}

// Asks for the triangles of the next blocks of the row while this one is worked on: records two blocks ahead, their
// vertices one block ahead; of water, those that show through it. Reads ids only; what it asks for wrongly costs
// nothing.
SHOAL_INLINE void prefetch_triangles(const FrameData& f, std::size_t offset) {
  constexpr std::size_t kLanes[] = {0, 3, 6, 9, 12, 14};
  if (offset + 3 * kBlockPixels > f.direct.id.size()) return;
  const std::size_t near_block = offset + kBlockPixels, far_block = near_block + kBlockPixels;
  const std::int32_t count = static_cast<std::int32_t>(f.scene->geometry.triangles.size());
  const auto shown = [&](std::size_t at) SHOAL_LAMBDA {
    const std::int32_t id = f.direct.id.data()[at];
    // Blocks past the frame hold anything.
    return id < 0 && at < f.hits.refracted_id.size() ? f.hits.refracted_id.data()[at] : id;
  };
  std::int32_t last = kNoId;
  for (const std::size_t lane : kLanes) {
    const std::int32_t far_id = shown(far_block + lane), near_id = shown(near_block + lane);
    if (far_id >= 0 && far_id < count) __builtin_prefetch(f.geometry.triangles + far_id);
    if (near_id < 0 || near_id >= count || near_id == last) continue;
    last = near_id;
    const Geometry::TriangleRecord& t = f.geometry.triangles[near_id];
    for (const std::uint32_t vertex : t.vertex) {
      __builtin_prefetch(f.geometry.vertices + vertex);
      if (f.geometry.colors != nullptr) __builtin_prefetch(f.geometry.colors + vertex);
    }
  }
}

template <class M>
void shade_region(FrameData& f, std::size_t region) {
  const PostSettings post{f.settings.exposure_stops,
                          f.settings.tone_map == ToneMap::kAces ? ToneCurve::kAces : ToneCurve::kNone};
  const float exposure = exposure_scale(post);
  for_each_block(f.grid, region, [&](const Block& block) SHOAL_LAMBDA {
    BlockColor color;
    prefetch_ids(f, block.offset);
    prefetch_triangles(f, block.offset);
    shade_block<M>(f, block, color);
    if (f.accumulate) finish_block(f, block, post, exposure, color);
  });
}

}  // namespace shoal::inline SHOAL_ISA_NS
