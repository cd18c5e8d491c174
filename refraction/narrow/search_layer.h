// The narrow phase of a rasterizer: true rays, bent by waves, against the triangles that a layer of flat water shows.
//
// 1. Planes: each ray intersects the plane of the triangle at its place on the frame, the point is projected as the
//    layer is, and the triangle there comes next, until a ray hits a triangle that it has fetched.
// 2. Neighbours: the nine pixels about the place of the hit, which may show what stands in front.
// 3. Way: pixels on the line from the water pixel to that place.
// 4. Behind: the same pixels of the second layer.
// 5. Between samples: a ray that hits the plane of a pixel's triangle in a point that the same pixel shows, and whose
//    surface goes on to the neighbours on that side, is taken to hit that surface; the hit is approximate.
// 6. A ray that hits nothing sees the background where the layer shows none at its vanishing point; else the last
//    triangle of the first step is shown for it, and the hit is approximate.
//
// Source  Liu et al. 2020 (planes), Steel 2024 (virtual space), McGuire and Mara 2014 (way), Everitt 2001 (second layer).
// Differs From all: what is tested is the true ray against the triangle itself, so a hit is exact, however it was found.
// Cost    a fetch and its test take about 150 cycles a block; at most 32 a direction
//         (docs/decisions/0013-two-phase-searches-its-layers.md).
#pragma once

#include "refraction/data/layer_view.h"

namespace shoal {

// What the search does, a method's options.
struct LayerSearch {
  int planes = 4;            // steps from plane to plane, after the pixel's own
  int way = 4;               // pixels on the way
  bool neighbours = true;    // the nine pixels about the last place
  bool behind = false;       // the second layer
  bool beside_edges = true;  // neighbours and way of rays that have a hit, where an edge is near; else of the others
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

struct LayerHits {
  WideI id = WideI(kNoId);                // of triangles; kNoId: the background
  WideF t = WideF(0.0f);                  // along the ray, of the triangle's plane; of hits alone
  WideM approximate = mask_from_bits(0);  // the ray does not hit the triangle, which is only the nearest candidate
};

//   layer    its place_of maps points of the rays
//   x_px, y_px  of the block's first pixel
//   ray      from the water's surface, unit direction
//   fetches  of each lane: added to
// Returns the nearest hit among the triangles fetched; of equally far ones the one of smallest id.
LayerHits search_layer(const LayerView& layer, const LayerSearch& how, int x_px, int y_px, const Ray<WideF>& ray,
                       WideM lanes, WideI& fetches);

}  // namespace shoal::inline SHOAL_ISA_NS
