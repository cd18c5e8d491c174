// Where each water pixel's view ray crosses the surface, and the rays that continue from there. The interface stage
// computes it once; every later stage reads it.
#pragma once

#include <cstdint>

#include "raster/blocks.h"
#include "water/exact_ray.h"

namespace shoal {

// The channels of one pixel, each sixteen floats of a 4 x 4 block.
struct alignas(64) InterfaceBlock {
  enum Channel {
    kT,                   // of the crossing along the view ray, in lengths of its direction
    kCrossing,            // world, m; three channels, as the other vectors
    kIncident = 4,        // unit, world: the view ray's direction
    kPlaneNormal = 7,     // unit, on the ray's side: of the plane, or of a displaced surface's tangent plane
    kNormal = 10,         // unit, against the ray: the surface's
    kSlopeVariance = 13,  // of waves that the pixel's footprint hides, else 0
    kCosIncident,         // >= 0
    kCosTransmitted,      // >= 0; 0 where totally reflected
    kEta,                 // n_incident / n_transmitted
    kReflectance,         // Fresnel, the mean over hidden slopes; 1 where totally reflected
    kRefracted,           // unit; tangential where totally reflected
    kReflected = 21,      // unit
    kBackground = 24,     // linear radiance of the background that filtered waves reflect; unset without filtering
    kChannels = 27
  };
  float channel[kChannels][16];
  std::uint16_t shows;        // bit i: lane i shows this body's surface
  std::uint16_t crosses;      // bit i: the ray of lane i crosses the surface
  std::uint16_t transmitted;  // bit i: lane i is not totally reflected
};

// One 64-pixel region of one body: scratch of a thread. Blocks lie in rows; those of no water pixel hold shows 0 and
// nothing else.
struct WaterInterface {
  static constexpr int kBlocksAcross = kRegionSize / kBlockSize;
  InterfaceBlock block[kBlocksAcross * kBlocksAcross];
};

// Index in a region's scratch of the block at a pixel of the frame.
inline std::size_t block_in_region(int x_px, int y_px) {
  return static_cast<std::size_t>((y_px % kRegionSize / kBlockSize) * WaterInterface::kBlocksAcross +
                                  x_px % kRegionSize / kBlockSize);
}

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

namespace interface_detail {
SHOAL_INLINE void put(InterfaceBlock& b, int channel, WideF v) { v.store(b.channel[channel]); }
SHOAL_INLINE void put(InterfaceBlock& b, int channel, const Vec3<WideF>& v) {
  v.x.store(b.channel[channel]), v.y.store(b.channel[channel + 1]), v.z.store(b.channel[channel + 2]);
}
SHOAL_INLINE WideF get(const InterfaceBlock& b, int channel) { return WideF::load(b.channel[channel]); }
SHOAL_INLINE Vec3<WideF> get3(const InterfaceBlock& b, int channel) {
  return {WideF::load(b.channel[channel]), WideF::load(b.channel[channel + 1]), WideF::load(b.channel[channel + 2])};
}
}  // namespace interface_detail

SHOAL_INLINE void store_interface(const ExactRay<WideF>& at, InterfaceBlock& b) {
  using namespace interface_detail;
  put(b, InterfaceBlock::kT, at.t), put(b, InterfaceBlock::kCrossing, at.crossing_world);
  put(b, InterfaceBlock::kIncident, at.incident), put(b, InterfaceBlock::kPlaneNormal, at.plane_normal);
  put(b, InterfaceBlock::kNormal, at.normal), put(b, InterfaceBlock::kSlopeVariance, at.slope_variance);
  put(b, InterfaceBlock::kCosIncident, at.cos_incident), put(b, InterfaceBlock::kCosTransmitted, at.cos_transmitted);
  put(b, InterfaceBlock::kEta, at.eta), put(b, InterfaceBlock::kReflectance, at.reflectance);
  put(b, InterfaceBlock::kRefracted, at.refracted), put(b, InterfaceBlock::kReflected, at.reflected);
  b.crosses = static_cast<std::uint16_t>(to_bits(at.crosses));
  b.transmitted = static_cast<std::uint16_t>(to_bits(at.transmitted));
}

// What the interface stage stored. wave_normal and height_m, which no later stage reads, are those of the plane.
SHOAL_INLINE ExactRay<WideF> load_interface(const InterfaceBlock& b) {
  using namespace interface_detail;
  ExactRay<WideF> at;
  at.t = get(b, InterfaceBlock::kT), at.crossing_world = get3(b, InterfaceBlock::kCrossing);
  at.incident = get3(b, InterfaceBlock::kIncident), at.plane_normal = get3(b, InterfaceBlock::kPlaneNormal);
  at.normal = get3(b, InterfaceBlock::kNormal), at.wave_normal = at.plane_normal;
  at.slope_variance = get(b, InterfaceBlock::kSlopeVariance), at.height_m = WideF(0.0f);
  at.cos_incident = get(b, InterfaceBlock::kCosIncident), at.cos_transmitted = get(b, InterfaceBlock::kCosTransmitted);
  at.eta = get(b, InterfaceBlock::kEta), at.reflectance = get(b, InterfaceBlock::kReflectance);
  at.refracted = get3(b, InterfaceBlock::kRefracted), at.reflected = get3(b, InterfaceBlock::kReflected);
  at.crosses = mask_from_bits(b.crosses), at.transmitted = mask_from_bits(b.transmitted);
  return at;
}

}  // namespace shoal::inline SHOAL_ISA_NS
