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

#include "refraction/kernels.h"
#include "refraction/narrow/confirm_hit.h"
#include "refraction/narrow/march_hit.h"
#include "refraction/narrow/unsure_rays.h"
#include "refraction/pixel_stage.h"
#include "refraction/shade_block.h"

namespace shoal::inline SHOAL_ISA_NS {

// The ray that the surface bends, and the one that goes straight on; both mirror alike.
template <class F>
SHOAL_INLINE WaterRays<F> bent_rays(const WaterPass& water, Ray<F> view_ray, RayDifferential<F> differential) {
  const ExactRay<F> hit = exact_ray(eye_side(water), view_ray);
  const RayDifferential<F> crossing = at_crossing(view_ray, differential, hit);
  return {hit,
          {hit.crossing_world, hit.refracted},
          {hit.crossing_world, hit.reflected},
          refracted_differential(crossing, hit),
          reflected_differential(crossing, hit)};
}
template <class F>
SHOAL_INLINE WaterRays<F> straight_rays(const WaterPass& water, Ray<F> view_ray, RayDifferential<F> differential) {
  const ExactRay<F> hit = exact_ray(eye_side(water), view_ray);
  const RayDifferential<F> crossing = at_crossing(view_ray, differential, hit);
  return {hit,
          {hit.crossing_world, hit.incident},
          {hit.crossing_world, hit.reflected},
          crossing,
          reflected_differential(crossing, hit)};
}

// The narrow phase of one region: what the rays of its blocks meet in a layer, or else in the scene.
class NarrowPhase {
 public:
  NarrowPhase(FrameData& frame, const WaterPass& pass)
      : f(frame),
        water(pass),
        refracted_(frame, frame.hits.refracted_id.data()),
        mirrored_(frame, frame.hits.mirrored_id.data()) {}

  // Of the block's pixels at `here`, which show the water.
  void refract(const Block& block, const WaterRays<WideF>& rays, WideM here, bool bent) {
    const WideM through = here & rays.at_surface.transmitted;
    meet({f.refracted, f.refracted_edges, water, false}, block, rays.refracted, rays.refracted_differential, here,
         through, bent, f.hits.refracted_id, refracted_);
  }
  // What the surface mirrors is found alike by every method.
  void mirror(const Block& block, const WaterRays<WideF>& rays, WideM here) {
    if (!water.mirrors) return;
    meet({f.mirrored, f.mirrored_edges, water, true}, block, rays.reflected, rays.reflected_differential, here, here,
         water.surface != nullptr, f.hits.mirrored_id, mirrored_);
  }

 private:
  void meet(const Layer& layer, const Block& block, const Ray<WideF>& ray, const RayDifferential<WideF>& differential,
            WideM here, WideM lanes, bool bent, AlignedArray<std::int32_t>& ids, UnsureRays& unsure) {
    const WideI own = WideI::load(layer.visibility.id.data() + f.layers.offset(block.x_px, block.y_px));
    if (bent) {
      const MarchedHit hit = march_hit(f, layer, ray, own, lanes);
      store_masked(ids.data() + block.offset, hit.id, here);
      unsure.add(ray, differential, hit.t, hit.id, block.offset, lanes & !hit.sure);
      return;
    }
    const WideI x = WideI(block.x_px + f.layers.margin_px) + block_x(),
                y = WideI(block.y_px + f.layers.margin_px) + block_y();
    const ConfirmedHit hit = confirm_hit(f.geometry, layer.visibility, ray, own, x, y, lanes);
    store_masked(ids.data() + block.offset, hit.id, here);
    unsure.add(ray, differential, WideF(kEndless), WideI(kNoId), block.offset, lanes & !hit.held & !hit.bare);
  }

  FrameData& f;
  const WaterPass& water;
  UnsureRays refracted_, mirrored_;
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
    return straight_rays(water, view_ray, differential);
  }
};

// The map and the rays of flat water's physics: geometry where the plane shows it, each ray as the surface bends it.
struct TrueRays {
  static constexpr bool kFollowsWaves = true;
  static BroadPhase map(const WaterBody& body, const View& view) { return make_broad_phase(body, view); }

  template <class F>
  SHOAL_INLINE static WaterRays<F> rays(const WaterPass& water, Ray<F> view_ray, RayDifferential<F> differential) {
    return bent_rays(water, view_ray, differential);
  }
};

// For a method that draws no refracted layer: writes what a block's rays met into it, for blended materials are laid
// over what it holds.
//   id, position  of the points met; kNoId: none
//   at            of the block in the layer
SHOAL_INLINE void note_layer(FrameData& f, const WaterPass& water, WideI id, Vec3<WideF> position, std::size_t at) {
  const ClipVertex<WideF> clip = project(f.view, virtual_position(water.map, position));
  const WideM seen = is_triangle(id) & (clip.w > WideF(0.0f));
  const WideF depth = select(seen, clip.z / select(seen, clip.w, WideF(1.0f)), WideF(0.0f));
  depth.store(f.refracted.depth.data() + at);
  id.store(f.refracted.id.data() + at);
}

template <class M>
struct MethodStages {
  // The lanes of a block that show the body's surface.
  static WideM shown(const FrameData& f, const WaterPass& water, const Block& block) {
    return (WideI::load(f.direct.id.data() + block.offset) == WideI(kFirstWaterId + water.index)) & block.in_frame;
  }

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
    NarrowPhase phase(f, water);
    for_each_block(f.grid, region, [&](const Block& block) SHOAL_LAMBDA {
      const WideM here = shown(f, water, block);
      if (none(here)) return;
      const WaterRays<WideF> rays = M::template rays<WideF>(water, block_rays(f.view, block), differential);
      phase.refract(block, rays, here, water.surface != nullptr && M::kFollowsWaves);
      phase.mirror(block, rays, here);
    });
  }

  // The method's refracted ray, or, for a mirrored pass, the reflected one.
  struct WaterBlend {
    const FrameData& f;
    const WaterPass& water;

    WideM lanes(const Block& block) const {
      return (WideI::load(f.direct.id.data() + block.offset) == WideI(kFirstWaterId + water.index)) & block.in_frame;
    }
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

  static constexpr MethodKernels kernels() { return {&M::map, &refracted_alpha, &narrow, &blend_water, &shade}; }

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
