// Surface points stored by block, for benchmarks that light them apart from all other work.
#pragma once

#include "core/vec_lanes.h"
#include "shading/surface.h"

namespace shoal::bench {

// Sixteen pixels of a 4 x 4 block, row by row, a cache line a channel, without padding.
struct alignas(64) GBufferBlock {
  float position_world[3][16];
  float normal_world[3][16];
  float base_color[3][16];
  float alpha[16];
  float metallic[16], roughness[16];
  float emissive[3][16];
  float f0_dielectric[16], occlusion[16];
};

}  // namespace shoal::bench

namespace shoal::bench::inline SHOAL_ISA_NS {

SHOAL_INLINE Vec3<WideF> load_planes(const float (&from)[3][16]) {
  return {WideF::load(from[0]), WideF::load(from[1]), WideF::load(from[2])};
}

SHOAL_INLINE SurfaceSample<WideF> load_surface(const GBufferBlock& block) {
  SurfaceSample<WideF> s;
  s.position_world = load_planes(block.position_world);
  s.normal_world = load_planes(block.normal_world);
  s.base_color = load_planes(block.base_color);
  s.alpha = WideF::load(block.alpha);
  s.metallic = WideF::load(block.metallic);
  s.roughness = WideF::load(block.roughness);
  s.emissive = load_planes(block.emissive);
  s.f0_dielectric = WideF::load(block.f0_dielectric);
  s.occlusion = WideF::load(block.occlusion);
  return s;
}

}  // namespace shoal::bench::inline SHOAL_ISA_NS
