// Image-space methods: the layer beyond the water is lit as a picture of its own, and each water pixel samples that
// picture at a place that the method finds.
//
//   struct MyMethod {
//     static constexpr bool kWholeScene = false;               // true: the layer is the frame without its water
//     static constexpr bool kFollowsWaves = true;
//     static BroadPhase map(const WaterBody&, const View&);    // as of a ray-primitive method
//     template <class F> static PixelRays<F> rays(const ExactRay<F>& at, const RayDifferential<F>& crossing);
//     static LayerPlace<WideF> sample_place(const SampleIn&);  // where each water pixel samples the layer
//     static LayerPlace<WideF> planar_place(const SampleIn&);  // the same of the planar reflection layer
//     // Optional: a map that is no BroadPhase, in the form of MappedProgram's (passes/vertex_programs.h); `splits`:
//     // bent edges are split
//     static MyMap own_map(const WaterOptics&, const MethodState&);
//     static bool splits_edges(const MethodState&);
//     // Optional: reflected rays other than those of the surface
//     static PixelRays<WideF> reflected_rays(const PixelRaysIn&);
//   };
//
// ImageSpaceKernels<MyMethod>::kernels() makes the frame's kernels of it. Surface, reflection, Fresnel, absorption and
// shadows are those of all methods, so that pictures differ by what is seen through the water alone. Image-space
// methods are of the category raster.
#pragma once

#include "refraction/methods/method.h"
#include "refraction/narrow/sample_place.h"
#include "refraction/narrow/sample_planar.h"
#include "refraction/passes/vertex_programs.h"

namespace shoal::inline SHOAL_ISA_NS {

template <class M>
concept ImageSpaceMethod = requires(const WaterBody& body, const View& view, const SampleIn& in) {
  { M::kWholeScene } -> std::convertible_to<bool>;
  { M::map(body, view) } -> std::same_as<BroadPhase>;
  { M::sample_place(in) } -> std::same_as<LayerPlace<WideF>>;
  { M::planar_place(in) } -> std::same_as<LayerPlace<WideF>>;
};
template <class M>
concept HasOwnMap = requires(const WaterOptics& optics, const MethodState& state) {
  M::own_map(optics, state);
};
template <class M>
concept HasOwnReflectedRays = requires(const PixelRaysIn& in) {
  M::reflected_rays(in);
};

template <ImageSpaceMethod M>
struct ImageSpaceKernels {
  // Everything that the fetch reads beside the inputs of a raster method is hidden from sample_place.
  static void narrow(const HybridNarrowIn& in, const NarrowOut& out, std::size_t region) {
    const RasterNarrowIn& raster = in;
    const FetchIn fetch{in.scene, in.view, in.grids, in.optics, in.layer, in.lit};
    // The method may read the layer's point at the pixel itself.
    out.lit_layer->require(region, &light_layer);
    for_each_block(in.grids.frame, region, [&](const Block& block) SHOAL_LAMBDA {
      const std::size_t at_block = block_in_region(block.x_px, block.y_px);
      const InterfaceBlock& interface = in.interface.block[at_block];
      const WideM through = mask_from_bits(interface.shows & interface.transmitted);
      if (none(through)) return;
      const ExactRay<WideF> at = load_interface(interface);
      HitBlock& hits = out.hits[at_block];
      WideI fetches = WideI::load(hits.fetches);
      const LayerPlace<WideF> place =
          M::sample_place(SampleIn{raster, block, block_rays(in.view.view, block), at, through, fetches});
      require_layer(*out.lit_layer, in.grids.frame, place, through);
      fetch_layer(fetch, at, place, through, hits, out.fetched[at_block]);
      (fetches + select(through, WideI(4), WideI(0))).store(hits.fetches);  // the four texels
    });
  }

  static void planar(const PlanarIn& in, const NarrowOut& out, std::size_t region) {
    for_each_block(in.grids.frame, region, [&](const Block& block) SHOAL_LAMBDA {
      const std::size_t at_block = block_in_region(block.x_px, block.y_px);
      const InterfaceBlock& interface = in.interface.block[at_block];
      if (interface.shows == 0) return;
      const WideM lanes = mask_from_bits(interface.shows);
      const ExactRay<WideF> at = load_interface(interface);
      HitBlock& hits = out.hits[at_block];
      WideI fetches = WideI::load(hits.fetches);
      const LayerPlace<WideF> place =
          M::planar_place(SampleIn{in, block, block_rays(in.view.view, block), at, lanes, fetches});
      sample_planar(in, place, lanes, fetches, hits);
      fetches.store(hits.fetches);
    });
  }

  static void reflected_rays(const PixelRaysIn& in, RaysBlock& out) requires HasOwnReflectedRays<M> {
    store_rays(M::reflected_rays(in), out);
  }

  static void refracted_front_end(const LayerPassIn& in, const BinsOut& out,
                                  std::size_t work_item) requires HasOwnMap<M> {
    const auto map = M::own_map(*in.pass.optics, in.state);
    const MappedProgram program(in.pass, in.view.view, map, M::splits_edges(in.state));
    run_work_item(in.geometry, program, in.pass.pass, out.bins, work_item);
  }
  static void blended_front_end(const BlendedPassIn& in, const BinsOut& out,
                                std::size_t work_item) requires HasOwnMap<M> {
    const auto map = M::own_map(*in.pass->optics, in.state);
    const MappedProgram program(*in.pass, in.view.view, map, M::splits_edges(in.state));
    run_work_item(in.geometry, program, blended_settings(in), in.meshlets.data(), out.bins, work_item);
  }

  static constexpr MethodKernels kernels() {
    MethodKernels k;
    k.map = &M::map;
    k.lights_layer = true;
    k.whole_scene = M::kWholeScene;
    k.rays = k.shown_rays = &rays_of_method<M>;
    k.narrow = &narrow;
    k.planar = &planar;
    if constexpr (HasOwnReflectedRays<M>) k.own_reflected = &reflected_rays;
    if constexpr (HasOwnMap<M>) {
      k.refracted_front_end = &refracted_front_end;
      k.blended_front_end = &blended_front_end;
    }
    return k;
  }
};

// The method's entry in the registry.
template <ImageSpaceMethod M>
constexpr Method image_space_method(const char* name, const char* description, const char* source,
                                    OptionList options = {}) {
  return {name, MethodCategory::kRaster, description, source, ImageSpaceKernels<M>::kernels(), options};
}

}  // namespace shoal::inline SHOAL_ISA_NS
