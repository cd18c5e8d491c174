// The lit layer of image-space methods: lighting the refracted layer as a picture, and fetching from it.
#pragma once

#include <atomic>
#include <cstdint>

#include "refraction/data/frame_grids.h"
#include "refraction/data/layer_view.h"
#include "refraction/data/region_hits.h"
#include "refraction/data/targets.h"
#include "refraction/data/view_state.h"
#include "refraction/data/water_pass.h"
#include "scene/scene_view.h"

namespace shoal {

struct LightLayerIn {
  const SceneView& scene;
  const ViewState& view;
  const FrameGrids& grids;
  const WaterOptics& optics;
  const VisibilityBuffer& refracted;
};

// The layer is lit where it is fetched from: a region by the thread that is the first to need it.
enum LitState : std::int32_t { kDark, kBeingLit, kLit };
struct LazyLayer {
  const LightLayerIn& in;
  LitLayer& out;
  std::int32_t* lit;  // [regions] LitState, all kDark before the first fetch

  // Returns when a region is lit. Lighting depends on nothing that other threads write, so no two wait for each other.
  //   light(in, out, region)  lights it
  template <class Light>
  void require(std::size_t region, Light light) const {
    std::atomic_ref<std::int32_t> state(lit[region]);
    std::int32_t seen = state.load(std::memory_order_acquire);
    if (seen == kDark && state.compare_exchange_strong(seen, kBeingLit, std::memory_order_acquire)) {
      light(in, out, region);
      state.store(kLit, std::memory_order_release);
      state.notify_all();
      return;
    }
    for (; seen != kLit; seen = state.load(std::memory_order_acquire)) state.wait(seen, std::memory_order_acquire);
  }
};

// What a fetch from the layer reads, for one block.
struct FetchIn {
  const SceneView& scene;
  const ViewState& view;
  const FrameGrids& grids;
  const WaterOptics& optics;
  const LayerView& layer;
  const LitLayer& lit;
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

// Lights one region of the refracted layer: each pixel at its own point, where the ray through flat water (of a whole
// scene: the straight ray) hits the triangle drawn there.
void light_layer(const LightLayerIn& in, LitLayer& out, std::size_t region);

// Lights the regions of the frame that a block fetches from.
void require_layer(const LazyLayer& layer, const FrameGrid& frame, const LayerPlace<WideF>& place, WideM lanes);

// Fetches the layer at a place, bilinear, for the lanes of a block; a place outside of the frame is clamped to its
// edge. Absorbs each texel's light on its way from there to the surface. Writes the light, the triangle of the nearest
// texel, and, where the sample is captured, the point: mixed as the light is where all four texels are of one drawable,
// else the nearest's.
//   at  where the pixels' rays cross the surface
void fetch_layer(const FetchIn& in, const ExactRay<WideF>& at, LayerPlace<WideF> place, WideM lanes, HitBlock& hits,
                 FetchedBlock& out);

}  // namespace shoal::inline SHOAL_ISA_NS
