// Methods that shade before: the layer beyond the water is lit as a picture of its own, and each water pixel looks into
// that picture somewhere.
//
//   struct MyMethod {
//     static constexpr bool kShadesBefore = true;
//     static constexpr bool kWholeScene = false;                    // true: the layer is the frame without its water
//     static BroadPhase map(const WaterBody&, const View&);         // as of a method that shades after
//     template <class F> static WaterRays<F> rays(const WaterPass&, Ray<F> view_ray, RayDifferential<F>);
//     static LayerPlace look(const LookUp&);                        // where each water pixel looks in the layer
//     // If its map is no BroadPhase: one as MappedProgram's, and the option that has edges split.
//     static MyMap own_map(const FrameData&, const WaterPass&);
//     static constexpr int kSplitsEdges = kTessellate;
//     // If the surface is to mirror something else than its true ray shows:
//     static void mirror(const FrameData&, const WaterPass&, const Block&, WaterRays<WideF>&);
//   };
//
// ShadeBeforeStages<MyMethod>::kernels() makes the frame's stages of it. Surface, reflection, Fresnel, absorption and
// shadows are those of all methods, so that pictures differ by what is seen through the water alone.
#pragma once

#include "refraction/passes/front_ends.h"
#include "refraction/methods/method.h"

namespace shoal::inline SHOAL_ISA_NS {

// The option of a method with a map of its own, whose source may leave edges straight.
inline constexpr MethodOption kTessellateOption{
    "tessellate", "true", "split edges that the broad phase bends", MethodOption::Kind::kBool, 0, 1};

template <class M>
concept HasOwnMap = requires(const FrameData& f, const WaterPass& water) {
  M::own_map(f, water);
};

// What a narrow phase may know of sixteen pixels.
struct LookUp {
  const FrameData& f;
  const WaterPass& water;
  const Block& block;
  Ray<WideF> view_ray;
  const ExactRay<WideF>& at;  // where it meets the surface, waves and all
  WideM lanes;                // that look: water, not totally reflecting
};

// A place in the layer, in pixels: a texel's sample is at its index + 0.5. Outside of the frame it is brought to the
// edge.
struct LayerPlace {
  WideF x_px, y_px;
};

// The pixels' own places.
SHOAL_INLINE LayerPlace own_place(const Block& block) {
  return {to_float(WideI(block.x_px) + block_x()) + WideF(0.5f), to_float(WideI(block.y_px) + block_y()) + WideF(0.5f)};
}

// Where a point of the layer's space shows; behind the eye, far off.
SHOAL_INLINE LayerPlace project_place(const View& view, Vec3<WideF> p) {
  const ClipVertex<WideF> clip = project(view, p);
  const WideF inverse_w = WideF(1.0f) / max(clip.w, WideF(1e-6f));
  return {clip.x * inverse_w + WideF(view.centre_px.x), clip.y * inverse_w + WideF(view.centre_px.y)};
}

SHOAL_INLINE LayerPlace select_place(WideM m, LayerPlace a, LayerPlace b) {
  return {select(m, a.x_px, b.x_px), select(m, a.y_px, b.y_px)};
}

// Lights one region of the refracted layer into FrameData::layer: each pixel at its own point, where the ray through
// flat water (of a whole scene: the straight ray) meets the triangle drawn there.
void light_layer(FrameData& f, const WaterPass& water, std::size_t region, bool whole_scene);

// Fetches the layer, bilinear, for the lanes of a block, and absorbs each texel's light on its way from there to the
// surface. Writes FrameData::fetched and hits.refracted_id: the nearest texel's triangle. A point is mixed as light is
// where all four texels are of one drawable, else it is the nearest's.
void fetch_layer(FrameData& f, const WaterPass& water, const Block& block, const ExactRay<WideF>& at, LayerPlace place,
                 WideM lanes);

template <class M>
struct ShadeBeforeStages {
  static void light(FrameData& f, const WaterPass& water, std::size_t region) {
    light_layer(f, water, region, M::kWholeScene);
  }

  static void narrow(FrameData& f, const WaterPass& water, std::size_t region) {
    const RayDifferential<WideF> differential = pixel_ray_differential<WideF>(f.view);
    NarrowPhase phase(f, water, region);
    for_each_block(f.grid, region, [&](const Block& block) SHOAL_LAMBDA {
      const WideM here = water_lanes(f, water, block);
      if (none(here)) return;
      const Ray<WideF> view_ray = block_rays(f.view, block);
      WaterRays<WideF> rays = M::template rays<WideF>(water, view_ray, differential);
      if constexpr (MirrorsItsWay<M>) M::mirror(f, water, block, rays);
      const WideM through = here & rays.at_surface.transmitted;
      if (any(through)) {
        const LayerPlace place = M::look(LookUp{f, water, block, view_ray, rays.at_surface, through});
        fetch_layer(f, water, block, rays.at_surface, place, through);
      }
      phase.mirror(block, rays, here);
    });
  }

  template <class Map>
  static MappedProgram<Map> program(const FrameData& f, const WaterPass& water, const Map& map) {
    return {{water, f.view}, map, f.method_option[M::kSplitsEdges] != 0.0f};
  }
  static void refracted_front_end(FrameData& f, const WaterPass& water, std::size_t work_item) requires HasOwnMap<M> {
    const auto map = M::own_map(f, water);
    opaque_work_item(f, program(f, water, map), water.pass, work_item);
  }
  static void blended_front_end(FrameData& f, const WaterPass& water, std::size_t work_item) requires HasOwnMap<M> {
    const auto map = M::own_map(f, water);
    blended_work_item(f, program(f, water, map), water.pass, true, work_item);
  }

  static constexpr MethodKernels kernels() {
    MethodKernels k = MethodStages<M>::kernels();
    k.narrow = &narrow;
    k.light_layer = &light;
    k.follows_waves = false;
    k.whole_scene = M::kWholeScene;
    if constexpr (HasOwnMap<M>) {
      k.refracted_front_end = &refracted_front_end;
      k.blended_front_end = &blended_front_end;
    }
    return k;
  }
};

}  // namespace shoal::inline SHOAL_ISA_NS
