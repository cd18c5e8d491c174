// Traces paths from water interface to water interface: what each ray hits, the reflected and refracted rays that
// continue from there, and the light that they carry. The reference's pixels start here; the rays of raster methods
// that cross a secondary water interface continue here.
//
// Water is its plane, with the waves' normals bent to valid ones, or, displaced, the height field itself: rays may
// cross it again and again, from both sides.
//
// Source  Whitted 1980; Li et al., Sec. 4 (recursive tracing of Perlin water).
// Differs Texture filtering uses ray differentials (Igehy 1999) as the raster methods do, not cones. A ray beyond the
//         depth or below the weight sees the background, so that a white scene stays white.
#pragma once

#include "raster/resolve.h"
#include "scene/rough_mirror.h"
#include "scene/scene_view.h"
#include "scene/water_absorption.h"
#include "shading/block_color.h"
#include "shading/shade_hits.h"
#include "shading/sky.h"
#include "trace/nearest_hit.h"
#include "trace/path.h"
#include "trace/ray_counts.h"
#include "trace/seen_through.h"
#include "water/exact_ray.h"

namespace shoal::inline SHOAL_ISA_NS {

// Traces sixteen paths through a scene.
//   Rays      first_hits(path, t_far): what the path's lanes hit first (NearestHit); count(kind, lanes) of the rays
//             traced; blended(): the BVH over the blended triangles, or null where none are composited
//   Recorder  receives what the paths find, for the buffers of the pixels' centres:
//             visible(path, id, water, hit, wet): the first hits of the eye's rays
//             surface(sample, lanes): the surface that the eye's rays hit
//             water(crossing, lanes): the water that they cross
//             shown(path, position, id, lanes): a hit that the pixel shows
template <class Rays, class Recorder>
class PathTracer {
 public:
  //   pixel  differential of the eye's rays, for filtered waves
  PathTracer(const SceneView& scene, const Rays& rays, Recorder& recorder, const RayDifferential<float>& pixel,
             const TraceLimits& limits, BlockColor& color)
      : scene_(scene), rays_(rays), recorder_(recorder), pixel_(pixel), limits_(limits), out_(color) {}

  // Adds the light that the paths carry to the block's colour.
  __attribute__((noinline)) void trace(const Path& path) {
    const WaterCrossing water = nearest_water(scene_.water, path);
    const NearestHit nearest = rays_.first_hits(path, water.t);
    const WideI id = nearest.id;
    const WideM hit = path.lanes & is_triangle(id);
    const WideM wet = path.lanes & !hit & (water.body >= WideI(0));
    const WideM gone = path.lanes & !hit & !wet;
    if (path.level == 1) recorder_.visible(path, id, water, hit, wet);
    if (rays_.blended() == nullptr) {
      end(path, id, water, hit, gone, wet);
      return;
    }
    Path behind = path;
    const SeenThrough over = see_through(behind, nearest, water, hit, wet);
    end(behind, id, water, hit, gone, wet);
    if (path.level == 1)
      out_.covered = select(path.lanes, WideF(1.0f) - over.transmittance * (WideF(1.0f) - out_.covered), out_.covered);
  }

 private:
  // The ends of the rays: surfaces, the background, and water, from above or from below.
  void end(const Path& path, WideI id, const WaterCrossing& water, WideM hit, WideM gone, WideM wet) {
    if (any(hit)) surface(path, id, hit);
    if (any(gone)) background(path, gone);
    if (none(wet)) return;
    for_each_distinct(water.body, wet, [&](std::int32_t one, WideM lanes) SHOAL_LAMBDA {
      const PlacedWater& placed = scene_.water[static_cast<std::size_t>(one)];
      Vec3<WideF> normal = broadcast<WideF>(placed.body->normal);
      if (is_displaced(*placed.body, placed.surface))
        normal =
            displaced_normal(*placed.body, *placed.surface, path.ray.origin_world + path.ray.direction_world * water.t);
      const WideM below = dot(path.ray.direction_world, normal) > WideF(0.0f);
      if (any(lanes & !below)) interface(path, placed, water.t, false, lanes & !below);
      if (any(lanes & below)) interface(path, placed, water.t, true, lanes & below);
    });
  }

  // Adds the light of blended triangles on the way, which dims the light from behind.
  SeenThrough see_through(Path& path, const NearestHit& nearest, const WaterCrossing& water, WideM hit, WideM wet) {
    const WideF t = select(hit, nearest.t, select(wet, water.t, WideF(kEndless)));
    const WideI what = select(hit, nearest.id, select(wet, WideI(kFirstWaterId) + water.body, WideI(kNoId)));
    const SeenThrough over = seen_through(*rays_.blended(), scene_, path.ray, path.differential,
                                          {path.t_near, t, what, path.medium}, path.lanes);
    add(path.weight * path.clear, over.light, path.lanes);
    path.clear = path.clear * over.transmittance;
    return over;
  }

  const WaterBody* medium_of(const Path& path) const {
    return path.medium == kAir ? nullptr : scene_.water[static_cast<std::size_t>(path.medium)].body;
  }
  void add(Vec3<WideF> weight, Vec3<WideF> radiance, WideM lanes) {
    out_.radiance = select<WideF>(lanes, out_.radiance + weight * radiance, out_.radiance);
  }

  void surface(const Path& path, WideI id, WideM hit) {
    const WaterBody* medium = medium_of(path);
    ShadedLanes s;
    shade_hits(scene_.shading, path.ray, path.differential, id, hit,
               medium != nullptr ? &scene_.light_media[path.medium] : nullptr, s);
    Vec3<WideF> weight = path.weight;
    if (medium != nullptr)
      weight = weight * absorbed(*medium, max(s.t * length(path.ray.direction_world), WideF(0.0f)));
    add(weight * path.clear, s.radiance, hit);
    if (path.level == 1) {
      out_.covered = select(hit, WideF(1.0f), out_.covered);
      recorder_.surface(s.surface, hit);
    }
    const WideM shown = hit & path.shows;
    if (any(shown)) recorder_.shown(path, s.surface.position_world, id, shown);
  }

  void background(const Path& path, WideM gone) {
    Vec3<WideF> weight = path.weight;
    const Vec3<WideF> direction = normalize(path.ray.direction_world);
    if (const WaterBody* medium = medium_of(path)) {
      // The ray leaves the scene through the water's bottom, as in the raster methods (passes/shade_water.isa.cpp).
      const WideF descent = abs(dot(direction, broadcast<WideF>(medium->normal)));
      const WideF path_m = path.level == 1 ? WideF(kFarAway_m) : WideF(medium->depth_m) / max(descent, WideF(1e-3f));
      weight = weight * absorbed(*medium, path_m);
    }
    add(weight * path.clear, beyond(path, direction), gone);
  }

  Vec3<WideF> beyond(const Path& path, Vec3<WideF> direction) const {
    return path.seen_beyond != nullptr ? *path.seen_beyond : background_radiance<WideF>(scene_.background(), direction);
  }

  // One side of one body's surface.
  void interface(const Path& path, const PlacedWater& water, WideF t, bool from_below, WideM lanes) {
    WaterSide side = water_side(*water.body, water.surface, from_below);
    // Waves are filtered for the eye's rays; later rays cross them as they are.
    if (path.level == 1 && water.surface != nullptr && water.surface->filtered) side.pixel = &pixel_;
    const bool displaced = is_displaced(*water.body, water.surface);
    ExactRay<WideF> at =
        displaced ? displaced_ray(*water.body, *water.surface, path.ray, t, side.pixel) : exact_ray(side, path.ray);
    Vec3<WideF> filtered_background;
    if (side.pixel != nullptr) {
      const RoughMirror<WideF> mirror =
          mirror_roughly<WideF>(SkyView{scene_.background()}, *water.body, displaced, at.reflected, at);
      filtered_background = mirror.radiance;
      at.reflectance = mirror.reflectance;
    }
    const RayDifferential<WideF> crossing = at_crossing(path.ray, path.differential, at);
    Path next;
    next.weight = path.weight;
    next.clear = path.clear;
    if (const WaterBody* medium = medium_of(path))
      next.weight = next.weight * absorbed(*medium, max(at.t * length(path.ray.direction_world), WideF(0.0f)));
    next.level = path.level + 1;
    next.from = water.index;
    next.first_body = path.level == 1 ? water.index : path.first_body;
    const WideM counted = path.level == 1 ? lanes : lanes & path.shows;
    if (path.level == 1) {
      out_.covered = select(lanes, WideF(1.0f), out_.covered);
      recorder_.water(at, lanes);
    } else if (any(counted)) {
      recorder_.secondary(counted);
    }

    const Vec3<WideF> weight = next.weight;
    const Vec3<WideF> lift = displaced ? at.normal * surface_lift(*water.body, *water.surface, at.crossing_world)
                                       : broadcast<WideF>(Vec3f{0, 0, 0});
    if (limits_.refraction) {
      next.ray = {at.crossing_world, at.refracted};
      next.lift = -lift;
      next.differential = refracted_differential(crossing, at);
      next.weight = weight * (WideF(1.0f) - at.reflectance);
      next.lanes = lanes & at.transmitted;
      next.medium = from_below ? kAir : water.index;
      next.shows = counted & at.transmitted;
      next.shown_as = path.level == 1 ? HitKind::kSurface : path.shown_as;
      if (any(next.lanes)) continue_path(next, RayCounts::kRefracted, true);
    }
    if (limits_.reflection) {
      next.ray = {at.crossing_world, at.reflected};
      if (side.pixel != nullptr && !from_below) next.seen_beyond = &filtered_background;
      next.lift = lift;
      next.differential = reflected_differential(crossing, at);
      next.weight = weight * at.reflectance;
      next.lanes = lanes & (at.reflectance > WideF(0.0f));
      next.medium = path.medium;
      next.shows = counted & !at.transmitted;
      next.shown_as = HitKind::kMirror;
      const bool sees_scene = limits_.reflects_scene || always_reflects_scene(from_below, side.eta);
      if (any(next.lanes)) continue_path(next, RayCounts::kReflected, sees_scene);
    }
  }

  // Traces rays from a surface. Rays that may not hit the scene, are too deep or of too little weight see the
  // background.
  void continue_path(Path& next, RayCounts::Kind kind, bool sees_scene) {
    // A pixel's hit buffers hold its water and what lies in it, however little of that is visible.
    const WideF brings =
        max(max(next.weight.x, next.weight.y), next.weight.z) * select(next.shows, WideF(1.0f), next.clear);
    const bool too_deep = next.level > limits_.depth;
    WideM on = next.lanes & (brings >= WideF(limits_.weight));
    if (too_deep || !sees_scene) on = mask_from_bits(0);
    const WideM cut = next.lanes & !on;
    if (any(cut)) add(next.weight * next.clear, beyond(next, next.ray.direction_world), cut);
    if (none(on)) return;
    next.lanes = on;
    rays_.count(kind, on);
    trace(next);
  }

  const SceneView& scene_;
  const Rays& rays_;
  Recorder& recorder_;
  const RayDifferential<float>& pixel_;
  const TraceLimits limits_;
  BlockColor& out_;
};

}  // namespace shoal::inline SHOAL_ISA_NS
