// Attributes, material and light of what sixteen rays meet: one function for every pass and method.
#pragma once

#include <cstdint>

#include "core/ray.h"
#include "core/vec_lanes.h"
#include "shading/shading_view.h"
#include "shading/surface.h"

namespace shoal::inline SHOAL_ISA_NS {

// Surface points and their light for one ray a lane.
struct ShadedLanes {
  Vec3<WideF> radiance;  // linear, towards the ray's origin
  SurfaceSample<WideF> surface;
  WideF t;  // along the ray, in its direction's lengths
};

// Shades the points where rays meet triangles.
//   view          the scene
//   ray           world, direction of any length; differential: its change by pixel, which filters textures
//   id, active    the triangle of each active lane; at least one lane is active
//   medium        the water that may lie above the points and then dims and bends their light; null: air
//   out           the active lanes are set; the others hold finite leftovers
void shade_hits(const ShadingView& view, const Ray<WideF>& ray, const RayDifferential<WideF>& differential, WideI id,
                WideM active, const LightMedium* medium, ShadedLanes& out);

// The alpha test of one triangle.
//   view, ray, differential  as above
//   id                       of an alpha-tested triangle
//   cover                    bit i: lane i's pixel is covered
// Returns the bits of `cover` whose pixels the triangle's material keeps.
std::uint32_t alpha_bits(const ShadingView& view, const Ray<WideF>& ray, const RayDifferential<WideF>& differential,
                         std::int32_t id, std::uint32_t cover);

}  // namespace shoal::inline SHOAL_ISA_NS
