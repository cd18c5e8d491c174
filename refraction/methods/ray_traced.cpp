// ray-traced: the truth. Every pixel's ray is followed through the water, by reflection, refraction and total internal
// reflection, and lit as the rasterizer lights it: the same triangles, attributes, textures and shading function.
//
// Source  Whitted 1980; Li et al., Sec. 4 (recursive tracing of Perlin water).
// Differs Texture filtering follows ray differentials (Igehy 1999) as the raster methods do, not cones. A ray beyond
// the
//         depth or below the weight sees the background, so that a white scene stays white.
// Error   Which triangle is met is Embree's answer (robust mode); the point on it is our own arithmetic (resolve.h).
#include <atomic>

#include "refraction/methods/method.h"
#include "refraction/trace/trace_rays.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

enum Option { kDepth, kWeight, kReflection, kRefraction, kOptionCount };
constexpr MethodOption kOptions[kOptionCount] = {
    {"depth", "4", "surfaces of water that a path may meet, and one", MethodOption::Kind::kWhole, 1, 8},
    {"weight", "0.001", "rays that count for less see the background", MethodOption::Kind::kReal, 0, 1},
    {"reflection", "true", "follow reflected rays", MethodOption::Kind::kTruth, 0, 1},
    {"refraction", "true", "follow refracted rays", MethodOption::Kind::kTruth, 0, 1},
};

constexpr float kEndless = 3e38f;
constexpr std::int32_t kAir = -1, kNowhere = -1;

// Sixteen rays on their way.
struct Path {
  Ray<WideF> ray;
  RayDifferential<WideF> differential;
  Vec3<WideF> weight;  // of what they bring
  WideM lanes;
  float t_near = 0;              // in the direction's lengths
  int level = 1;                 // 1: from the eye
  std::int32_t medium = kAir;    // the body of water that they are in
  std::int32_t from = kNowhere;  // the flat body that they start on: they do not meet it again
  // Of the water pixels' hit buffers, at the pixel's centre: what these lanes meet is what the pixel shows.
  WideM shows;
  HitKind shown_as = HitKind::kSurface;
  std::int32_t first_body = kNowhere;  // that the eye sees
};

// Where rays meet the nearest body of water.
struct WaterMet {
  WideF t;
  WideI body;  // kNowhere: none
};

// Seen along the normal, is p inside of the outline?
SHOAL_INLINE WideM in_outline(const WaterBody& body, Vec3<WideF> p) {
  const Vec3<WideF> normal = broadcast<WideF>(body.normal);
  WideM inside = mask_from_bits(0);
  for (std::size_t i = 0; i + 2 < body.outline.size(); i += 3) {
    WideM here = mask_from_bits(0xFFFFu);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3f a = body.outline[i + k], edge = body.outline[i + (k + 1) % 3] - a;
      // A millionth of the edge to spare: no gap between two triangles.
      const float slack = -1e-6f * dot(edge, edge);
      here = here & (dot(cross(broadcast<WideF>(edge), p - broadcast<WideF>(a)), normal) >= WideF(slack));
    }
    inside = inside | here;
  }
  return inside;
}

SHOAL_INLINE WaterMet nearest_water(const FrameData& f, const Path& path) {
  WaterMet met{WideF(kEndless), WideI(kNowhere)};
  for (const WaterPass& water : f.water) {
    if (water.index == path.from) continue;
    const WaterBody& body = *water.body;
    const Vec3<WideF> normal = broadcast<WideF>(body.normal);
    const WideF approach = dot(path.ray.direction_world, normal);
    const WideF height = dot(broadcast<WideF>(body.origin) - path.ray.origin_world, normal);
    const WideM crosses = path.lanes & (approach != WideF(0.0f));
    const WideF t = height / select(crosses, approach, WideF(1.0f));
    const WideM nearer = crosses & (t > WideF(0.0f)) & (t >= WideF(path.t_near)) & (t < met.t);
    if (none(nearer)) continue;
    const WideM here = nearer & in_outline(body, path.ray.origin_world + path.ray.direction_world * t);
    met.t = select(here, t, met.t);
    met.body = select(here, WideI(water.index), met.body);
  }
  return met;
}

class Tracer {
 public:
  Tracer(FrameData& frame, const Block& at, BlockColor& color) : f(frame), block(at), out(color) {}

  // Adds what the rays bring to the block's colour.
  __attribute__((noinline)) void follow(const Path& path) {
    const WaterMet water = nearest_water(f, path);
    const WideI id = first_hits(f, path.ray, path.differential, path.t_near, water.t, path.lanes);
    const WideM hit = path.lanes & is_triangle(id);
    const WideM wet = path.lanes & !hit & (water.body >= WideI(0));
    const WideM gone = path.lanes & !hit & !wet;
    if (path.level == 1) capture_visible(path, id, water, hit, wet);
    if (any(hit)) surface(path, id, hit);
    if (any(gone)) background(path, gone);
    if (none(wet)) return;
    for_each_distinct(water.body, wet, [&](std::int32_t one, WideM lanes) SHOAL_LAMBDA {
      const WaterBody& body = f.scene->waters[static_cast<std::size_t>(one)];
      const WideM below = dot(path.ray.direction_world, broadcast<WideF>(body.normal)) > WideF(0.0f);
      if (any(lanes & !below)) interface(path, one, false, lanes & !below);
      if (any(lanes & below)) interface(path, one, true, lanes & below);
    });
  }

 private:
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
    add(weight, s.radiance, hit);
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
    add(weight, background_radiance<WideF>(f.scene->lighting.background, direction), gone);
  }

  // One side of one body's surface.
  void interface(const Path& path, std::int32_t index, bool from_below, WideM lanes) {
    const WaterPass& water = f.water[static_cast<std::size_t>(index)];
    const WaterSide side = water_side(*water.body, water.surface, from_below);
    const ExactRay<WideF> at = exact_ray(side, path.ray);
    const RayDifferential<WideF> crossing = at_crossing(path.ray, path.differential, at);
    Path next;
    next.weight = path.weight;
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
    if (f.method_option[kRefraction] != 0.0f) {
      next.ray = {at.crossing_world, at.refracted};
      next.differential = refracted_differential(crossing, at);
      next.weight = weight * (WideF(1.0f) - at.reflectance);
      next.lanes = lanes & at.transmitted;
      next.medium = from_below ? kAir : index;
      next.shows = counted & at.transmitted;
      next.shown_as = path.level == 1 ? HitKind::kSurface : path.shown_as;
      if (any(next.lanes)) follow_on(next, RayCounts::kRefracted, true);
    }
    if (f.method_option[kReflection] != 0.0f) {
      next.ray = {at.crossing_world, at.reflected};
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
    const WideF brings = max(max(next.weight.x, next.weight.y), next.weight.z);
    const bool too_deep = static_cast<float>(next.level) > f.method_option[kDepth];
    WideM on = next.lanes & (brings >= WideF(f.method_option[kWeight]));
    if (too_deep || !sees_scene) on = mask_from_bits(0);
    const WideM cut = next.lanes & !on;
    if (any(cut))
      add(next.weight, background_radiance<WideF>(f.scene->lighting.background, next.ray.direction_world), cut);
    if (none(on)) return;
    next.lanes = on;
    count_rays(f, kind, static_cast<std::uint64_t>(__builtin_popcount(to_bits(on))));
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
        f, block, {at.crossing_world, at.normal, zero, WideF(0.0f), WideF(0.0f), WideF(0.0f), zero}, lanes);
    shade_detail::capture_hits(f, block, zero, zero, WideI(kNoId), HitKind::kSky, lanes);
  }

  FrameData& f;
  const Block& block;
  BlockColor& out;
};

void trace_region(FrameData& f, std::size_t region) {
  const PostSettings post{f.settings.exposure_stops,
                          f.settings.tone_map == ToneMap::kAces ? ToneCurve::kAces : ToneCurve::kNone};
  const float exposure = exposure_scale(post);
  for_each_block(f.grid, region, [&](const Block& block) SHOAL_LAMBDA {
    BlockColor color;
    if (f.capture) shade_detail::capture_clear(f, block);
    Path path;
    path.ray = block_rays(f.view, block);
    path.differential = pixel_ray_differential<WideF>(f.view);
    path.weight = broadcast<WideF>(Vec3f{1, 1, 1});
    path.lanes = block.in_frame;
    path.t_near = f.view.camera.near_m;
    path.medium = f.eye_in_water;
    path.shows = mask_from_bits(0);
    count_rays(f, RayCounts::kPrimary, static_cast<std::uint64_t>(__builtin_popcount(to_bits(path.lanes))));
    Tracer(f, block, color).follow(path);
    if (f.accumulate) finish_block(f, block, post, exposure, color);
  });
}

// The flat-water map that hits are measured through.
BroadPhase flat_map(const WaterBody& body, const View& view) { return make_broad_phase(body, view); }

}  // namespace

Method ray_traced() {
  MethodKernels kernels{};
  kernels.map = &flat_map;
  kernels.trace = &trace_region;
  return {"ray-traced",
          "the truth: recursive reflection and refraction, by Embree",
          "Whitted 1980; Li et al.; Liu et al. 2020, reference [6]",
          kernels,
          kOptions,
          kOptionCount,
          false};
}

}  // namespace shoal::inline SHOAL_ISA_NS
