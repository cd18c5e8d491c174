// Rays followed from water to water: what they meet, and what goes on from there by reflection and refraction, lit as
// the rasterizer lights it. The ray tracer's pixels begin here; the raster methods' rays come here where they meet
// water a second time.
//
// Water is its plane, with the waves' normals bent to what a plane can bear, or, displaced, the height field itself:
// rays may meet it again and again, from both sides.
//
// Source  Whitted 1980; Li et al., Sec. 4 (recursive tracing of Perlin water).
// Differs Texture filtering follows ray differentials (Igehy 1999) as the raster methods do, not cones. A ray beyond
//         the depth or below the weight sees the background, so that a white scene stays white.
#pragma once

#include <atomic>

#include "refraction/shade_block.h"
#include "trace/path.h"
#include "trace/trace_rays.h"

namespace shoal::inline SHOAL_ISA_NS {

// Follows sixteen paths through a scene.
//   Scene  first_hits(frame, path, t_far): the triangles that the path's lanes meet first; count(frame, kind, lanes) of
//          rays followed; kBlends: what is blended on their way is seen
template <class Scene>
class Tracer {
 public:
  Tracer(FrameData& frame, const Block& at, const TraceLimits& up_to, BlockColor& color)
      : f(frame), block(at), limits(up_to), out(color) {}

  // Adds what the rays bring to the block's colour.
  __attribute__((noinline)) void follow(const Path& path) {
    const WaterMet water = nearest_water(f, path);
    const WideI id = Scene::first_hits(f, path, water.t);
    const WideM hit = path.lanes & is_triangle(id);
    const WideM wet = path.lanes & !hit & (water.body >= WideI(0));
    const WideM gone = path.lanes & !hit & !wet;
    if (path.level == 1) capture_visible(path, id, water, hit, wet);
    if (Scene::kBlends && f.blended.any()) {
      Path behind = path;
      const SeenThrough over = see_through(behind, id, water, hit, wet);
      end(behind, id, water, hit, gone, wet);
      if (path.level == 1)
        out.covered = select(path.lanes, WideF(1.0f) - over.keep * (WideF(1.0f) - out.covered), out.covered);
      return;
    }
    end(path, id, water, hit, gone, wet);
  }

 private:
  // What the rays end at.
  void end(const Path& path, WideI id, const WaterMet& water, WideM hit, WideM gone, WideM wet) {
    if (any(hit)) surface(path, id, hit);
    if (any(gone)) background(path, gone);
    if (none(wet)) return;
    for_each_distinct(water.body, wet, [&](std::int32_t one, WideM lanes) SHOAL_LAMBDA {
      const WaterPass& pass = f.water[static_cast<std::size_t>(one)];
      Vec3<WideF> normal = broadcast<WideF>(pass.body->normal);
      if (is_displaced(*pass.body, pass.surface))
        normal =
            displaced_normal(*pass.body, *pass.surface, path.ray.origin_world + path.ray.direction_world * water.t);
      const WideM below = dot(path.ray.direction_world, normal) > WideF(0.0f);
      if (any(lanes & !below)) interface(path, one, water.t, false, lanes & !below);
      if (any(lanes & below)) interface(path, one, water.t, true, lanes & below);
    });
  }

  // Adds the light of what is blended on the way, which dims what comes from behind.
  SeenThrough see_through(Path& path, WideI id, const WaterMet& water, WideM hit, WideM wet) {
    WideF t = select(wet, water.t, WideF(kEndless));
    if (any(hit)) t = select(hit, triangle_distance(f.geometry, path.ray, id, hit), t);
    const WideI what = select(hit, id, select(wet, WideI(kFirstWaterId) + water.body, WideI(kNoId)));
    const SeenThrough over =
        seen_through(f, path.ray, path.differential, path.t_near, t, what, medium_of(path), path.lanes);
    add(path.weight * path.clear, over.light, path.lanes);
    path.clear = path.clear * over.keep;
    return over;
  }

  const WaterPass* medium_of(const Path& path) const {
    return path.medium == kAir ? nullptr : &f.water[static_cast<std::size_t>(path.medium)];
  }
  void add(Vec3<WideF> weight, Vec3<WideF> radiance, WideM lanes) {
    out.radiance = select<WideF>(lanes, out.radiance + weight * radiance, out.radiance);
  }

  void surface(const Path& path, WideI id, WideM hit) {
    const WaterPass* medium = medium_of(path);
    ShadedLanes s;
    shade_hits(f, path.ray, path.differential, id, hit, medium, s);
    Vec3<WideF> weight = path.weight;
    if (medium != nullptr)
      weight = weight * absorbed(*medium->body, max(s.t * length(path.ray.direction_world), WideF(0.0f)));
    add(weight * path.clear, s.radiance, hit);
    if (path.level == 1) {
      out.covered = select(hit, WideF(1.0f), out.covered);
      if (f.capture) shade_detail::capture_surface(f, block, s.surface, hit);
    }
    const WideM shown = hit & path.shows;
    if (f.capture && any(shown)) {
      const Vec3<WideF> p = s.surface.position_world;
      const BroadPhase& optics = f.water[static_cast<std::size_t>(path.first_body)].optics;
      const Vec3<WideF> image = path.shown_as == HitKind::kSurface ? virtual_position(optics, p) : p;
      shade_detail::capture_hits(f, block, p, image, id, path.shown_as, shown);
    }
  }

  void background(const Path& path, WideM gone) {
    Vec3<WideF> weight = path.weight;
    const Vec3<WideF> direction = normalize(path.ray.direction_world);
    if (const WaterPass* medium = medium_of(path)) {
      // Out of the scene through the water's bottom, as the raster methods have it (shade_block.h).
      const WideF descent = abs(dot(direction, broadcast<WideF>(medium->body->normal)));
      const WideF path_m =
          path.level == 1 ? WideF(shade_detail::kFarAway_m) : WideF(medium->body->depth_m) / max(descent, WideF(1e-3f));
      weight = weight * absorbed(*medium->body, path_m);
    }
    add(weight * path.clear, beyond(path, direction), gone);
  }

  Vec3<WideF> beyond(const Path& path, Vec3<WideF> direction) const {
    return path.seen_beyond != nullptr ? *path.seen_beyond
                                       : background_radiance<WideF>(f.scene->lighting.background, direction);
  }

  // One side of one body's surface.
  void interface(const Path& path, std::int32_t index, WideF t, bool from_below, WideM lanes) {
    const WaterPass& water = f.water[static_cast<std::size_t>(index)];
    WaterSide side = water_side(*water.body, water.surface, from_below);
    // Waves are filtered for the eye's rays; those that come later meet them as they are.
    if (path.level == 1) side.pixel = filtering_pixel(water);
    const bool displaced = is_displaced(*water.body, water.surface);
    ExactRay<WideF> at =
        displaced ? displaced_ray(*water.body, *water.surface, path.ray, t, side.pixel) : exact_ray(side, path.ray);
    Vec3<WideF> mirrored_background;
    if (side.pixel != nullptr)
      mirrored_background =
          mirror_roughly<WideF>(f.scene->lighting.background, *water.body, displaced, at.reflected, at);
    const RayDifferential<WideF> crossing = at_crossing(path.ray, path.differential, at);
    Path next;
    next.weight = path.weight;
    next.clear = path.clear;
    if (const WaterPass* medium = medium_of(path))
      next.weight = next.weight * absorbed(*medium->body, max(at.t * length(path.ray.direction_world), WideF(0.0f)));
    next.level = path.level + 1;
    next.from = index;
    next.first_body = path.level == 1 ? index : path.first_body;
    const WideM counted = path.level == 1 ? lanes : lanes & path.shows;
    if (path.level == 1) {
      out.covered = select(lanes, WideF(1.0f), out.covered);
      if (f.capture) capture_water(at, lanes);
    }

    const Vec3<WideF> weight = next.weight;
    const Vec3<WideF> lift = displaced ? at.normal * surface_lift(*water.body, *water.surface, at.crossing_world)
                                       : broadcast<WideF>(Vec3f{0, 0, 0});
    if (limits.refraction) {
      next.ray = {at.crossing_world, at.refracted};
      next.lift = -lift;
      next.differential = refracted_differential(crossing, at);
      next.weight = weight * (WideF(1.0f) - at.reflectance);
      next.lanes = lanes & at.transmitted;
      next.medium = from_below ? kAir : index;
      next.shows = counted & at.transmitted;
      next.shown_as = path.level == 1 ? HitKind::kSurface : path.shown_as;
      if (any(next.lanes)) follow_on(next, RayCounts::kRefracted, true);
    }
    if (limits.reflection) {
      next.ray = {at.crossing_world, at.reflected};
      if (side.pixel != nullptr && !from_below) next.seen_beyond = &mirrored_background;
      next.lift = lift;
      next.differential = reflected_differential(crossing, at);
      next.weight = weight * at.reflectance;
      next.lanes = lanes & (at.reflectance > WideF(0.0f));
      next.medium = path.medium;
      next.shows = counted & !at.transmitted;
      next.shown_as = HitKind::kMirror;
      const bool sees_scene = f.settings.reflections == Reflections::kScene || always_mirrors(from_below, side.eta);
      if (any(next.lanes)) follow_on(next, RayCounts::kReflected, sees_scene);
    }
  }

  // Follows rays from a surface, or has them see the background: those that may not see the scene, are too deep, or
  // bring too little.
  void follow_on(Path& next, RayCounts::Kind kind, bool sees_scene) {
    // The pixel's hit buffers are those of the water and what is in it, however much of that is seen.
    const WideF brings =
        max(max(next.weight.x, next.weight.y), next.weight.z) * select(next.shows, WideF(1.0f), next.clear);
    const bool too_deep = next.level > limits.depth;
    WideM on = next.lanes & (brings >= WideF(limits.weight));
    if (too_deep || !sees_scene) on = mask_from_bits(0);
    const WideM cut = next.lanes & !on;
    if (any(cut)) add(next.weight * next.clear, beyond(next, next.ray.direction_world), cut);
    if (none(on)) return;
    next.lanes = on;
    Scene::count(f, kind, on);
    follow(next);
  }

  // What the direct pass would have left: ids and depth.
  void capture_visible(const Path& path, WideI id, const WaterMet& water, WideM hit, WideM wet) {
    const WideI seen = select(hit, id, select(wet, WideI(kFirstWaterId) + water.body, WideI(kNoId)));
    store_masked(f.direct.id.data() + block.offset, seen, path.lanes);
    const std::uint32_t pixels = to_bits(wet);
    if (pixels != 0)
      std::atomic_ref<std::uint64_t>(f.water_pixels)
          .fetch_add(static_cast<std::uint64_t>(__builtin_popcount(pixels)), std::memory_order_relaxed);
    if (!f.capture) return;
    WideF t = water.t;
    if (any(hit)) {
      PixelAttributes<WideF> a;
      resolve_attributes(f.geometry, path.ray, path.differential, id, hit, a);
      t = select(hit, a.t, t);
    }
    const ClipVertex<WideF> clip = project(f.view, path.ray.origin_world + path.ray.direction_world * t);
    const WideF depth = select(hit | wet, clip.z / clip.w, WideF(0.0f));
    store_masked(f.direct.depth.data() + block.offset, depth, path.lanes);
  }

  // At water pixels the G-buffer holds the surface itself; what is seen in it comes with the rays that go on.
  void capture_water(const ExactRay<WideF>& at, WideM lanes) {
    const Vec3<WideF> zero = broadcast<WideF>(Vec3f{0, 0, 0});
    shade_detail::capture_surface(
        f, block,
        {at.crossing_world, at.normal, zero, WideF(0.0f), WideF(0.0f), roughness_of_waves(at.slope_variance), zero},
        lanes);
    shade_detail::capture_hits(f, block, zero, zero, WideI(kNoId), HitKind::kSky, lanes);
  }

  FrameData& f;
  const Block& block;
  const TraceLimits limits;
  BlockColor& out;
};

}  // namespace shoal::inline SHOAL_ISA_NS
