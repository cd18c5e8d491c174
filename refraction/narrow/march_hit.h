// Narrow phase under waves: what does a ray meet that the waves bent away from flat water's?
//
// The refracted layer is the scene as flat water shows it. A point of the bent ray has its place there by the same map
// that geometry was drawn with. So the plane of the triangle that a pixel shows gives a point of the ray, that point a
// place in the layer, and that place another triangle, until the ray meets the one that its own point shows. Then the
// way there is looked over: where it stays in front of every edge that it passes (layer_edges.h), nothing can be in the
// way; else the layer does not tell, and the scene is asked (nearest_hit.h).
#pragma once

#include "refraction/narrow/confirm_hit.h"
#include "refraction/narrow/layer_edges.h"

namespace shoal::inline SHOAL_ISA_NS {

// A layer of a body's water that rays are followed through.
struct Layer {
  const VisibilityBuffer& visibility;
  const LayerEdges& edges;
  const WaterPass& water;
  bool mirrored;  // drawn by mirrored_position, else by WaterPass::map
};

struct MarchedHit {
  WideI id;    // a triangle that the ray meets, or kNoId
  WideF t;     // where; beyond everything for kNoId
  WideM sure;  // it is the first, or there is none; else the layer does not tell: something nearer may be hidden in it,
               // outside of it, or beside an edge
};

//   ray    the true ray of each lane, from the water, unit direction
//   own    what the layer shows at the lanes' own pixels
//   lanes  which of them
// Source: Wyman 2005 (the plane behind as the first guess); Liu et al. 2020 (the broad phase's layer); the iteration
//         and the test by edges are ours.
// Error: a sure answer is wrong where the ray meets what the layer does not show at all, near no edge of it: sides that
//        face away from flat water's rays and towards the bent one. Wrong objects by scene: docs/QUALITY.md; bounded by
//        tests/refraction/test_waves_against_rays.cpp.
MarchedHit march_hit(const FrameData& f, const Layer& layer, const Ray<WideF>& ray, WideI own, WideM lanes);

}  // namespace shoal::inline SHOAL_ISA_NS
