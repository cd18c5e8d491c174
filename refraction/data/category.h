// What a method may use, and which inputs its narrow phase therefore receives.
#pragma once

#include <cstdint>

#include "refraction/data/layer_view.h"
#include "refraction/data/method_state.h"
#include "refraction/data/pixel_rays.h"
#include "refraction/data/reflections.h"
#include "refraction/data/targets.h"
#include "scene/scene_view.h"
#include "trace/trace_view.h"

namespace shoal {

// kRaster: rasterized buffers alone. kVolume: rays marched through a voxel grid. kHybrid: rays against the BVH.
// kTraced: rays alone.
enum class MethodCategory : std::uint8_t { kRaster, kVolume, kHybrid, kTraced };
const char* category_name(MethodCategory category);

// What water reflects where nothing is asked for: rasterized methods use their layers, the others their rays.
constexpr Reflections default_reflections(MethodCategory category) {
  return category == MethodCategory::kRaster || category == MethodCategory::kVolume ? Reflections::kPlanar
                                                                                    : Reflections::kTraced;
}

// Inputs of every narrow phase: one body of water, one 64-pixel region.
struct RasterNarrowIn {
  const ViewState& view;
  const FrameGrids& grids;
  const WaterOptics& optics;
  const WaterInterface& interface;  // of the region
  const LayerView& layer;           // of the direction, where the method has it drawn
  const LitLayer& lit;              // the same, lit: of an image-space method, else empty
  const MethodState& state;
  bool wants_positions;  // hits are to be written with their positions (HitBlock)
};
// Inputs of the narrow phase of reflected rays by the planar reflection layer, which `layer` is here.
struct PlanarIn : RasterNarrowIn {
  PixelRaysFunction own_rays;  // a method's own reflected rays, or null
};
// And the triangles that a voxel grid refers to.
struct VolumeNarrowIn : RasterNarrowIn {
  const GeometryView& geometry;
};
// And the scene and the BVH.
struct HybridNarrowIn : RasterNarrowIn {
  const SceneView& scene;
  const TraceView& trace;
  const VisibilityBuffer& refracted;  // the layer whole, for its edges
  PixelRaysFunction rays;             // that the water pixels follow
};

// The narrow phase's input by category: the type is what keeps a raster method from the BVH.
template <MethodCategory>
struct NarrowInOf;
template <>
struct NarrowInOf<MethodCategory::kRaster> {
  using Type = RasterNarrowIn;
};
template <>
struct NarrowInOf<MethodCategory::kVolume> {
  using Type = VolumeNarrowIn;
};
template <>
struct NarrowInOf<MethodCategory::kHybrid> {
  using Type = HybridNarrowIn;
};
template <MethodCategory category>
using NarrowIn = typename NarrowInOf<category>::Type;

struct LazyLayer;  // refraction/passes/lit_layer.h

// What a narrow phase writes, by block of the region.
struct NarrowOut {
  HitBlock* hits;
  FetchedBlock* fetched;       // of image-space methods
  const LazyLayer* lit_layer;  // of image-space methods: lights the layer where it is fetched from; else null
};

}  // namespace shoal
