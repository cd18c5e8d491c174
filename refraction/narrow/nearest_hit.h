// Narrow phase, where a layer cannot tell: the triangle that a ray meets first, looked up in the whole scene.
#pragma once

#include "refraction/pixel_stage.h"

namespace shoal::inline SHOAL_ISA_NS {

inline constexpr float kEndless = 3e38f;

// The nearest opaque triangle that each ray meets, as the rasterizer draws them: one-sided materials from their front
// alone, masked ones where the material keeps the point, blended ones not.
//
//   ray           world, from the water, unit direction; one lane after the other
//   differential  of the rays: what cut-out textures are filtered by
//   t, id         what each is known to meet: only what is nearer is looked for. kEndless, kNoId: nothing
// Returns its id, of triangles equally far the smallest; kNoId where there is none, anything in the other lanes.
// Source: Kay and Kajiya 1986 (slabs); Wald et al. 2008 (one ray, sixteen children at once).
// Differs: Embree, which the ray tracer asks, answers rays at edges differently from machine to machine
//         (docs/decisions/0009).
// Error: a ray within 1e-5 of a triangle's sides beyond it (in barycentrics) meets it
//        (tests/refraction/test_triangle_tree.cpp, against all triangles in double).
WideI nearest_hits(const FrameData& f, const Ray<WideF>& ray, const RayDifferential<WideF>& differential, WideF t,
                   WideI id, WideM lanes);

}  // namespace shoal::inline SHOAL_ISA_NS
