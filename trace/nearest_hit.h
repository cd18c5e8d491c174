// Narrow phase: the triangle that a ray meets first, looked up in the whole scene.
#pragma once

#include "refraction/pixel_stage.h"

namespace shoal::inline SHOAL_ISA_NS {

inline constexpr float kEndless = 3e38f;

struct NearestHit {
  WideI id = WideI(kNoId);
  WideF t = WideF(kEndless);  // along the ray
};

// The nearest opaque triangle that each ray meets, as the rasterizer draws them: one-sided materials from their front
// alone, alpha-tested ones where the material keeps the point, blended ones not.
//
//   ray           world, unit direction; fastest where rays are near each other, as a block's are
//   differential  of the rays: what cut-out textures are filtered by
//   known         what each is known to meet, or where it ends: only what is nearer is looked for
//   lanes         that are asked
// Returns the nearest, of triangles equally far the one of smallest id; what is known where nothing is nearer, and in
// the other lanes.
// Source: Wald et al. 2001 (rays in packets), Reshetov et al. 2005 (one box test for all of a packet's rays: here by
//         intervals along an axis), Kay and Kajiya 1986 (slabs).
// Differs: Embree, which the ray tracer asks, answers rays at edges differently from machine to machine
//         (docs/decisions/0009).
// Error: a ray within 1e-5 of a triangle's sides beyond it (in barycentrics) meets it
//        (tests/trace/test_bvh16.cpp, against all triangles in double).
NearestHit nearest_hits(const FrameData& f, const Ray<WideF>& ray, const RayDifferential<WideF>& differential,
                        const NearestHit& known, WideM lanes);

}  // namespace shoal::inline SHOAL_ISA_NS
