// The triangle that each ray hits first, by traversal of the BVH.
#pragma once

#include "raster/blocks.h"
#include "shading/shade_hits.h"
#include "trace/bvh16.h"
#include "water/nearest_water.h"

namespace shoal::inline SHOAL_ISA_NS {

struct NearestHit {
  WideI id = WideI(kNoId);
  WideF t = WideF(kEndless);  // along the ray
};

// The nearest opaque triangle that each ray hits, as the rasterizer draws them: one-sided materials from their front
// alone, alpha-tested ones where the material keeps the point, blended ones not.
//
//   bvh     over the scene's geometry
//   view    geometry and materials, for the alpha test
//   ray     world, direction of about unit length (0.5 to 2); fastest where the rays lie near each other
//   differential  of the rays: the footprint of alpha-tested textures
//   known   a hit that each ray has already, or where it ends: only nearer triangles are searched for
//   lanes   the rays that are wanted
//   t_near  where the rays start, in lengths of the direction; at least 0
// Returns the nearest hit, of triangles equally far the one of smallest id; `known` where nothing is nearer, and in
// the other lanes.
// Source: Wald et al. 2001 (rays in packets), Kay and Kajiya 1986 (slabs), trace/traversal.h.
// Error: a ray within 1e-5 of a triangle's sides beyond it (in barycentrics) hits it (tests/trace/test_bvh16.cpp,
//        against all triangles in double; tests/trace/test_against_embree.cpp, against Embree).
NearestHit nearest_hits(const Bvh16& bvh, const ShadingView& view, const Ray<WideF>& ray,
                        const RayDifferential<WideF>& differential, const NearestHit& known, WideM lanes,
                        float t_near = 0.0f);

// The same for rays that have nothing in common: each one is traced by itself.
// Error: none; equal to nearest_hits (tests/trace/test_bvh16.cpp).
NearestHit nearest_hit_of_each(const Bvh16& bvh, const ShadingView& view, const Ray<WideF>& ray,
                               const RayDifferential<WideF>& differential, const NearestHit& known, WideM lanes,
                               float t_near = 0.0f);

}  // namespace shoal::inline SHOAL_ISA_NS
