// The triangle that each ray hits first, by traversal of the BVH.
#pragma once

#include "raster/blocks.h"
#include "shading/shade_hits.h"
#include "trace/trace_view.h"
#include "water/nearest_water.h"

namespace shoal::inline SHOAL_ISA_NS {

struct NearestHit {
  WideI id = WideI(kNoId);
  WideF t = WideF(kEndless);  // along the ray
};

// The nearest opaque triangle that each ray hits, as the rasterizer draws them: one-sided materials from their front
// alone, alpha-tested ones where the material keeps the point, blended ones not.
//
//   bvh           over the scene's geometry
//   view          geometry and materials, for the alpha test
//   ray           world, unit direction; fastest where the rays lie near each other, as a block's do
//   differential  of the rays: the footprint of alpha-tested textures
//   known         a hit that each ray has already, or where it ends: only nearer triangles are searched for
//   lanes         the rays that are wanted
// Returns the nearest hit, of triangles equally far the one of smallest id; `known` where nothing is nearer, and in
// the other lanes.
// Source: Wald et al. 2001 (rays in packets), Reshetov et al. 2005 (one box test for all of a packet's rays: here by
//         intervals along an axis), Kay and Kajiya 1986 (slabs).
// Error: a ray within 1e-5 of a triangle's sides beyond it (in barycentrics) hits it (tests/trace/test_bvh16.cpp,
//        against all triangles in double).
NearestHit nearest_hits(const Bvh16& bvh, const ShadingView& view, const Ray<WideF>& ray,
                        const RayDifferential<WideF>& differential, const NearestHit& known, WideM lanes);

}  // namespace shoal::inline SHOAL_ISA_NS
