// Blended triangles on the way of rays.
#pragma once

#include "scene/scene_view.h"
#include "trace/bvh16.h"

namespace shoal::inline SHOAL_ISA_NS {

// The light of blended triangles on the way of a ray, less the share that nearer ones absorb, and what they transmit.
struct SeenThrough {
  Vec3<WideF> light{WideF(0.0f), WideF(0.0f), WideF(0.0f)};
  WideF transmittance{1.0f};
};

// Where rays end, and the water that they run through.
struct PathSegment {
  float t_near;            // in lengths of the direction
  WideF end_t;             // the same
  WideI end_id;            // what is there: of a blended triangle as far as it, the smaller id is in front
  std::int32_t body = -1;  // that absorbs the light on its way; -1: none
};

// Composites all blended triangles between t_near (and the origin) and the end, by (distance, id).
//   blended  over the scene's blended triangles
//   ray      world, direction of about unit length (0.5 to 2)
// Source, error: as refraction/passes/blend_region.h.
SeenThrough seen_through(const Bvh16& blended, const SceneView& scene, const Ray<WideF>& ray,
                         const RayDifferential<WideF>& differential, const PathSegment& segment, WideM lanes);

}  // namespace shoal::inline SHOAL_ISA_NS
