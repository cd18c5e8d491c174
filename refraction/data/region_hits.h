// What the narrow phase finds for the water pixels of one 64-pixel region: scratch of a thread.
#pragma once

#include <cstdint>

#include "refraction/data/water_interface.h"

namespace shoal {

// Ids are those of triangles; kNoId: the ray leaves the scene; kFirstWaterId + b: it crosses the surface of body b
// first, a secondary water interface.
struct alignas(64) HitBlock {
  std::int32_t refracted_id[16], reflected_id[16];
  // The triangle that the rays hit, whatever water they cross before it, and the point hit, world: filled where the
  // scene has blended materials and the layer of that ray is not drawn. A method whose rays go to a point that it found
  // by itself writes refracted_position in every scene.
  std::int32_t refracted_triangle[16], reflected_triangle[16];
  float refracted_position[3][16], reflected_position[3][16];
  std::int32_t fetches[16];  // of each pixel, from the layers of both directions
  // Bit i: the ray of lane i does not hit the triangle, which is only the method's nearest candidate.
  std::uint16_t refracted_approximate, reflected_approximate;
  std::uint16_t reflected_aimed;  // bit i: lane i shows what lies in the direction of reflected_position instead
};

// What an image-space method fetched from the lit layer.
struct alignas(64) FetchedBlock {
  float radiance[3][16];         // linear, absorbed on its way to the surface
  float position_world[3][16];   // of the point fetched; filled where it is captured
  std::int32_t approximate[16];  // 1: the place lies outside of the frame; filled where it is captured
};

// The light of rays that cross a secondary water interface.
struct alignas(64) SecondaryBlock {
  float radiance[3][16];
  std::uint16_t lanes;  // that have any
};

struct RegionScratch {
  static constexpr int kBlocks = WaterInterface::kBlocksAcross * WaterInterface::kBlocksAcross;
  WaterInterface interface;
  HitBlock hits[kBlocks];
  FetchedBlock fetched[kBlocks];
  SecondaryBlock secondary[kBlocks];
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

SHOAL_INLINE void store3(float (&to)[3][16], const Vec3<WideF>& v) {
  v.x.store(to[0]), v.y.store(to[1]), v.z.store(to[2]);
}
SHOAL_INLINE void store3(float (&to)[3][16], const Vec3<WideF>& v, WideM lanes) {
  store_masked(to[0], v.x, lanes), store_masked(to[1], v.y, lanes), store_masked(to[2], v.z, lanes);
}

}  // namespace shoal::inline SHOAL_ISA_NS
