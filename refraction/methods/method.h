// What a method is made of, and the stages built from it.
//
// A method that shades after is a struct with two templates (see two_phase.cpp, the shortest real one):
//
//   struct MyMethod {
//     static BroadPhase map(const WaterBody&, const View&);          // the broad phase: geometry to virtual positions
//     template <class F> static WaterRays<F> rays(const WaterPass&,  // the ray that a water pixel follows
//         Ray<F> view_ray, RayDifferential<F> differential);
//     static constexpr bool kFollowsWaves = true;                    // that ray is bent by the waves' normals
//   };
//
// It may also find by itself what its rays meet (distance_field.cpp), and have rays that depend on the pixel (below,
// PixelRays; block_grid.cpp). MethodStages<MyMethod>::kernels() makes the frame's stages of it.
#pragma once

#include <optional>

#include "refraction/kernels.h"
#include "refraction/narrow/confirm_hit.h"
#include "refraction/narrow/layer_edges.h"
#include "water/nearest_water.h"
#include "refraction/pixel_stage.h"
#include "refraction/shade_block.h"

namespace shoal::inline SHOAL_ISA_NS {

// The rays that go on from the surface: into the water as it bends them, or straight; back as it mirrors them.
template <bool kBent, class F>
SHOAL_INLINE WaterRays<F> rays_from_surface(const WaterPass& water, Ray<F> view_ray, RayDifferential<F> differential) {
  const ExactRay<F> hit = exact_ray(eye_side(water), view_ray);
  const RayDifferential<F> crossing = at_crossing(view_ray, differential, hit);
  WaterRays<F> out{hit, {}, {hit.crossing_world, hit.reflected}, {}, reflected_differential(crossing, hit)};
  out.refracted = {hit.crossing_world, kBent ? hit.refracted : hit.incident};
  out.refracted_differential = kBent ? refracted_differential(crossing, hit) : crossing;
  return out;
}

// Writes what rays meet into a layer that is not drawn, for blended materials are laid over what it holds.
//   id, position  of the points met; kNoId: none
//   block         whose pixels the rays are of
SHOAL_INLINE void note_layer(FrameData& f, const WaterPass& water, bool mirrored, WideI id, Vec3<WideF> position,
                             const Block& block) {
  const Vec3<WideF> image =
      mirrored ? mirrored_position(water.optics, position) : virtual_position(water.map, position);
  const ClipVertex<WideF> clip = project(f.view, image);
  const WideM seen = is_triangle(id) & (clip.w > WideF(0.0f));
  const WideF depth = select(seen, clip.z / select(seen, clip.w, WideF(1.0f)), WideF(0.0f));
  VisibilityBuffer& layer = mirrored ? f.mirrored : f.refracted;
  const std::size_t at = f.layers.offset(block.x_px, block.y_px);
  depth.store(layer.depth.data() + at);
  id.store(layer.id.data() + at);
}

// The narrow phase of one region: what the rays of its blocks meet.
//
// Where a layer is drawn it tells, but for what is beside its edges: there, and where waves bend rays away from what it
// shows, the scene is asked. True rays may meet water again, another body or the crests of the same: then that is what
// they show, kFirstWaterId and its number.
class NarrowPhase {
 public:
  NarrowPhase(FrameData& frame, const WaterPass& pass, std::size_t region)
      : f(frame),
        water(pass),
        meets_water_(frame.water.size() > 1 || is_displaced(*pass.body, pass.surface)),
        layer_region_(frame.layers.region(frame.grid, region)) {}

  // Of the block's pixels at `here`, which show the water.
  //   bent  the rays follow the waves, and what water does to them
  void refract(const Block& block, const WaterRays<WideF>& rays, WideM here, bool bent) {
    const WideM through = here & rays.at_surface.transmitted;
    const NearestHit hit = meet(layer_tells(bent, water) ? &f.refracted : nullptr, refracted_edges_, false, block,
                                rays.refracted, rays.refracted_differential, through);
    const WideI id = bent ? or_water(hit, rays, false, through) : hit.id;
    store_masked(f.hits.refracted_id.data() + block.offset, id, here);
  }
  // What the surface mirrors is found alike by every method.
  void mirror(const Block& block, const WaterRays<WideF>& rays, WideM here) {
    if (!water.mirrors) return;
    const NearestHit hit = meet(draws_mirrored(water) ? &f.mirrored : nullptr, mirrored_edges_, true, block,
                                rays.reflected, rays.reflected_differential, here);
    store_masked(f.hits.mirrored_id.data() + block.offset, or_water(hit, rays, true, here), here);
  }

 private:
  // What was hit, or the water that is nearer.
  WideI or_water(const NearestHit& hit, const WaterRays<WideF>& rays, bool mirrored, WideM lanes) const {
    if (!meets_water_ || none(lanes)) return hit.id;
    const WaterMet met = nearest_water(f, onward(water, rays, mirrored, lanes));
    return select(lanes & (met.t < hit.t), WideI(kFirstWaterId) + met.body, hit.id);
  }

  //   layer  that tells, drawn by these rays' map; null: the scene is asked
  NearestHit meet(const VisibilityBuffer* layer, std::optional<EdgeBlocks>& edges, bool mirrored, const Block& block,
                  const Ray<WideF>& ray, const RayDifferential<WideF>& differential, WideM lanes) {
    NearestHit known;
    if (layer != nullptr) {
      const WideI own = WideI::load(layer->id.data() + f.layers.offset(block.x_px, block.y_px));
      const WideI x = WideI(block.x_px + f.layers.margin_px) + block_x(),
                  y = WideI(block.y_px + f.layers.margin_px) + block_y();
      const ConfirmedHit shown = confirm_hit(f.geometry, *layer, ray, own, x, y, lanes);
      if (!edges) edges = find_edges(*layer, layer_region_);
      lanes = lanes & !shown.bare;
      known.id = select(shown.held, shown.id, known.id);
      const bool at_edge = edges->at(block.x_px, block.y_px);
      if (!at_edge) lanes = lanes & !shown.held;
      if ((at_edge || meets_water_) && any(shown.held))
        known.t = select(shown.held, triangle_distance(f.geometry, ray, shown.id, shown.held), known.t);
      if (none(lanes)) return known;
    }
    const NearestHit hit = nearest_hits(f, ray, differential, known, lanes);
    if (layer == nullptr && f.blended.any())
      note_layer(f, water, mirrored, hit.id, ray.origin_world + ray.direction_world * hit.t, block);
    return hit;
  }

  FrameData& f;
  const WaterPass& water;
  bool meets_water_;
  std::size_t layer_region_;
  std::optional<EdgeBlocks> refracted_edges_, mirrored_edges_;
};

// The map and the rays without refraction: geometry where it is, each ray straight on.
struct StraightRays {
  static constexpr bool kFollowsWaves = false;
  // Index 1 makes the broad phase the identity.
  static BroadPhase map(const WaterBody& body, const View& view) {
    return make_broad_phase(body.origin, body.normal, 1.0f, view);
  }

  template <class F>
  SHOAL_INLINE static WaterRays<F> rays(const WaterPass& water, Ray<F> view_ray, RayDifferential<F> differential) {
    return rays_from_surface<false>(water, view_ray, differential);
  }
};

// The map and the rays of flat water's physics: geometry where the plane shows it, each ray as the surface bends it.
struct TrueRays {
  static constexpr bool kFollowsWaves = true;
  static BroadPhase map(const WaterBody& body, const View& view) { return make_broad_phase(body, view); }

  template <class F>
  SHOAL_INLINE static WaterRays<F> rays(const WaterPass& water, Ray<F> view_ray, RayDifferential<F> differential) {
    return rays_from_surface<true>(water, view_ray, differential);
  }
};

template <class M>
struct MethodStages {
  // Alpha test of the refracted pass: where the method's ray meets the triangle.
  static std::uint32_t refracted_alpha(const FrameData& f, const WaterPass* water, std::int32_t id, int x_px, int y_px,
                                       std::uint32_t cover) {
    const Ray<WideF> view_ray = block_rays(f.view, make_block(f.grid, x_px, y_px));
    // The refracted layer is what flat water shows, whatever its waves do.
    WaterPass still = *water;
    still.surface = nullptr;
    const WaterRays<WideF> r = M::template rays<WideF>(still, view_ray, pixel_ray_differential<WideF>(f.view));
    return alpha_bits(f, r.refracted, r.refracted_differential, id, cover);
  }

  static void narrow(FrameData& f, const WaterPass& water, std::size_t region) {
    const RayDifferential<WideF> differential = pixel_ray_differential<WideF>(f.view);
    NarrowPhase phase(f, water, region);
    for_each_block(f.grid, region, [&](const Block& block) SHOAL_LAMBDA {
      const WideM here = water_lanes(f, water, block);
      if (none(here)) return;
      const WaterRays<WideF> rays = M::template rays<WideF>(water, block_rays(f.view, block), differential);
      phase.refract(block, rays, here, M::kFollowsWaves);
      phase.mirror(block, rays, here);
    });
  }

  // The method's refracted ray, or, for a mirrored pass, the reflected one.
  struct WaterBlend {
    const FrameData& f;
    const WaterPass& water;

    WideM lanes(const Block& block) const { return water_lanes(f, water, block); }
    BlendRays rays(const Block& block, WideM& here) const {
      const WaterRays<WideF> r =
          M::template rays<WideF>(water, block_rays(f.view, block), pixel_ray_differential<WideF>(f.view));
      if (water.mirrored) return {r.reflected, r.reflected_differential};
      here = here & r.at_surface.transmitted;
      return {r.refracted, r.refracted_differential};
    }
    // The far side's pass is in the water where the eye is not, the mirrored one where it is.
    bool in_water() const { return water.mirrored == water.optics.eye_below; }
    const WaterPass* lit_in() const { return in_water() ? &water : nullptr; }
    const WaterBody* absorbs() const { return in_water() ? water.body : nullptr; }
    static constexpr bool kFromSurface = true;
  };

  static void blend_water(FrameData& f, const WaterPass& water, std::size_t region, int thread) {
    VisibilityBuffer& opaque = water.mirrored ? f.mirrored : f.refracted;
    BlendLayer& layer = water.mirrored ? f.blended.mirrored : f.blended.refracted;
    blend_region(f, opaque, layer, WaterBlend{f, water}, region, thread);
  }

  static void shade(FrameData& f, std::size_t region) { shade_region<M>(f, region); }

  static constexpr MethodKernels kernels() {
    return {&M::map, &refracted_alpha, M::kFollowsWaves, &narrow, &blend_water, &shade};
  }

  // Of a method that finds by itself what its rays meet, in what it has prepared: no refracted layer is drawn.
  static constexpr MethodKernels kernels_without_layer(decltype(MethodKernels::narrow) finds,
                                                       decltype(MethodKernels::prepare) prepares) {
    MethodKernels k = kernels();
    k.refracted_alpha = nullptr;
    k.narrow = finds;
    k.prepare = prepares;
    return k;
  }
};

}  // namespace shoal::inline SHOAL_ISA_NS
