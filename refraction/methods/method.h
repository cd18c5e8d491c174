// What a method is made of, and the kernels built from it.
//
// A ray-primitive method follows one ray for each water pixel and shades the point that the ray hits:
//
//   struct MyMethod {
//     static constexpr MethodCategory kCategory = MethodCategory::kHybrid;
//     static constexpr bool kFollowsWaves = true;              // its ray is bent by the waves' normals
//     static BroadPhase map(const WaterBody&, const View&);    // the broad phase: geometry to virtual positions
//     template <class F> static PixelRays<F> rays(const ExactRay<F>& at, const RayDifferential<F>& crossing);
//   };
//
// `rays` makes the ray of a water pixel from the interface: `at` is where the view ray crosses the surface and how it
// continues, `crossing` its differential there (at_crossing). Optional members:
//
//   static void narrow(const NarrowIn<kCategory>&, const NarrowOut&, std::size_t region)
//       finds the hits by itself; no refracted layer is drawn (distance_field.cpp), but see kSearchesLayers
//   static void prepare(const PrepareIn&, MethodState&)
//       makes private data of the scene before the frames (distance_field.cpp)
//   static PixelRays<WideF> shown_rays(const PixelRaysIn&)
//       the rays that the pixels show, where they are not `rays` (block_grid.cpp)
//   static constexpr bool kMisses = true;
//       the method may find nothing where there is something
//   static constexpr bool kSearchesLayers = true;
//       its own narrow phase searches the layers (two_phase.cpp): they are drawn, under waves too
//   static constexpr bool kWholeScene = true;
//       its layer is the frame without its water (none.cpp), which is drawn once for the direct pass too
//   static LayerSearch layer_search(const MethodState&)
//       how the layers are searched, those of the planar reflection included
//
// Options are a plain struct and a table of its fields, given to ray_method (refraction/data/options.h).
// RayMethodKernels<MyMethod>::kernels() makes the frame's kernels of it. Methods that fetch from a lit picture of the
// layer are image-space methods (refraction/methods/image_space.h).
#pragma once

#include <concepts>

#include "refraction/methods/kernels.h"
#include "refraction/narrow/search_region.h"

namespace shoal::inline SHOAL_ISA_NS {

// Rays that continue from the surface as it bends them, and straight on.
template <class F>
SHOAL_INLINE PixelRays<F> bent_rays(const ExactRay<F>& at, const RayDifferential<F>& crossing) {
  return {{at.crossing_world, at.refracted}, refracted_differential(crossing, at)};
}
template <class F>
SHOAL_INLINE PixelRays<F> straight_rays(const ExactRay<F>& at, const RayDifferential<F>& crossing) {
  return {{at.crossing_world, at.incident}, crossing};
}

// The map and the rays without refraction: geometry where it is, each ray straight on.
struct StraightRays {
  static constexpr bool kFollowsWaves = false;
  // Index 1 makes the broad phase the identity.
  static BroadPhase map(const WaterBody& body, const View& view) {
    return make_broad_phase(body.origin, body.normal, 1.0f, view);
  }
  template <class F>
  SHOAL_INLINE static PixelRays<F> rays(const ExactRay<F>& at, const RayDifferential<F>& crossing) {
    return straight_rays(at, crossing);
  }
};

// The map and the rays of flat water's physics: geometry where the plane shows it, each ray as the surface bends it.
struct TrueRays {
  static constexpr bool kFollowsWaves = true;
  static BroadPhase map(const WaterBody& body, const View& view) { return make_broad_phase(body, view); }
  template <class F>
  SHOAL_INLINE static PixelRays<F> rays(const ExactRay<F>& at, const RayDifferential<F>& crossing) {
    return bent_rays(at, crossing);
  }
};

template <class M>
concept RayMethod = requires(const WaterBody& body, const View& view, const ExactRay<WideF>& at,
                             const RayDifferential<WideF>& crossing) {
  { M::kCategory } -> std::convertible_to<MethodCategory>;
  { M::kFollowsWaves } -> std::convertible_to<bool>;
  { M::map(body, view) } -> std::same_as<BroadPhase>;
  { M::template rays<WideF>(at, crossing) } -> std::same_as<PixelRays<WideF>>;
};
template <class M>
concept FindsHits = requires {
  &M::narrow;
};
template <class M>
concept Prepares = requires {
  &M::prepare;
};
template <class M>
concept HasShownRays = requires(const PixelRaysIn& in) {
  M::shown_rays(in);
};
template <class M>
concept Misses = M::kMisses;
template <class M>
concept SearchesLayers = M::kSearchesLayers;
template <class M>
concept ShowsWholeScene = M::kWholeScene;
template <class M>
concept HasLayerSearch = requires(const MethodState& state) {
  { M::layer_search(state) } -> std::same_as<LayerSearch>;
};

// The rays of a method in the form that stages call.
template <class M>
void rays_of_method(const PixelRaysIn& in, RaysBlock& out) {
  const ExactRay<WideF> at = load_interface(in.interface);
  store_rays(M::template rays<WideF>(at, crossing_differential(in, at)), out);
}

// The method's own narrow phase with the inputs of its category, and no others.
template <class M>
void narrow_of_method(const HybridNarrowIn& in, const NarrowOut& out, std::size_t region) {
  if constexpr (M::kCategory == MethodCategory::kRaster)
    M::narrow(static_cast<const RasterNarrowIn&>(in), out, region);
  else if constexpr (M::kCategory == MethodCategory::kVolume)
    M::narrow(VolumeNarrowIn{in, in.scene.geometry()}, out, region);
  else
    M::narrow(in, out, region);
}

template <RayMethod M>
struct RayMethodKernels {
  static_assert(FindsHits<M> || M::kCategory == MethodCategory::kHybrid,
                "only hybrid methods may have their hits found by the BVH; others have a narrow phase of their own");

  static void shown_rays(const PixelRaysIn& in, RaysBlock& out) requires HasShownRays<M> {
    store_rays(M::shown_rays(in), out);
  }
  static void hybrid_narrow(const HybridNarrowIn& in, const NarrowOut& out, std::size_t region) {
    refracted_hits(in, M::kFollowsWaves, out.hits, region);
  }

  // Reflected rays against the triangles of the planar reflection layer.
  static void planar(const PlanarIn& in, const NarrowOut& out, std::size_t region) {
    // What stands in front of a reflected hit is searched for by no method: it costs more than it shows.
    LayerSearch how{.planes = 1, .way = 0, .neighbours = false, .behind = false, .beside_edges = false};
    if constexpr (HasLayerSearch<M>) how = M::layer_search(in.state), how.way = 0, how.beside_edges = false;
    search_reflected(in, in.own_rays, how, out.hits, region);
  }
  static bool searches_behind(const MethodState& state) requires HasLayerSearch<M> {
    return M::layer_search(state).behind;
  }

  static constexpr MethodKernels kernels() {
    MethodKernels k;
    k.map = &M::map;
    k.traces = M::kCategory == MethodCategory::kHybrid;
    k.planar = &planar;
    k.follows_waves = M::kFollowsWaves;
    k.misses = Misses<M>;
    k.rays = k.shown_rays = &rays_of_method<M>;
    if constexpr (HasShownRays<M>) k.shown_rays = &shown_rays;
    if constexpr (FindsHits<M>) {
      k.searches = SearchesLayers<M>;
      k.whole_scene = ShowsWholeScene<M>;
      k.draws_layer = k.searches || k.whole_scene;
      k.narrow = &narrow_of_method<M>;
    } else {
      k.narrow = &hybrid_narrow;
    }
    if constexpr (HasLayerSearch<M>) k.searches_behind = &searches_behind;
    if constexpr (Prepares<M>) k.prepare = &M::prepare;
    return k;
  }
};

// The method's entry in the registry. Its options, if it has any, are a plain struct and a table of its fields
// (refraction/data/options.h).
template <RayMethod M>
constexpr Method ray_method(const char* name, const char* description, const char* source, OptionList options = {}) {
  return {name, M::kCategory, description, source, RayMethodKernels<M>::kernels(), options};
}

}  // namespace shoal::inline SHOAL_ISA_NS
