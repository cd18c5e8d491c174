// Narrow phase against the scene: what the refracted and the reflected rays of a body's water pixels hit.
//
// Where a visibility layer is valid it gives the triangle, except beside its edges; there, and where waves bend rays
// away from what the layer shows, the BVH is traversed. Rays that cross another water interface first, another body or
// a crest of the same, get that body's id.
#pragma once

#include "refraction/data/category.h"

namespace shoal {

// Is what a layer of flat water shows what rays see that are bent (or not) by the body's surface?
//   bent  the rays follow the waves' normals
inline bool visibility_layer_valid(bool bent, const WaterOptics& optics) {
  return !(bent && optics.surface() != nullptr);
}

// Inputs of the reflected rays' hits by the BVH: a shared stage, the same for every method.
struct ReflectedHitsIn {
  const ViewState& view;
  const FrameGrids& grids;
  const SceneView& scene;
  const TraceView& trace;
  const WaterOptics& optics;
  const WaterInterface& interface;
  const VisibilityBuffer* reflected;  // the planar reflection layer, where it is valid; else null
  PixelRaysFunction own_rays;         // a method's own reflected rays, or null
  const MethodState& state;
  bool wants_positions;
};

// Is the planar reflection layer of a body drawn? Rays use it where it is valid.
inline bool draws_reflected_layer(const WaterOptics& optics) {
  return optics.reflections == Reflections::kPlanar ||
         (optics.reflections == Reflections::kTraced && visibility_layer_valid(true, optics));
}

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

// HitBlock::refracted_id of a region's water pixels.
//   bent  the rays follow the waves' normals
void refracted_hits(const HybridNarrowIn& in, bool bent, HitBlock* hits, std::size_t region);

// HitBlock::reflected_id of a region's water pixels (Reflections::kTraced).
void reflected_hits(const ReflectedHitsIn& in, HitBlock* hits, std::size_t region);

}  // namespace shoal::inline SHOAL_ISA_NS
