// Sixteen pixels of a block into the planes of captured targets.
#pragma once

#include "refraction/data/targets.h"
#include "scene/hit_kind.h"
#include "shading/surface.h"

namespace shoal::inline SHOAL_ISA_NS {

SHOAL_INLINE void store_plane(FloatPlane& plane, std::size_t at, WideF v, WideM lanes) {
  store_masked(plane.data() + at, v, lanes);
}
SHOAL_INLINE void store_plane(IntPlane& plane, std::size_t at, WideI v, WideM lanes) {
  store_masked(plane.data() + at, v, lanes);
}
SHOAL_INLINE void store_plane(PlaneXyz& planes, std::size_t at, const Vec3<WideF>& v, WideM lanes) {
  store_plane(planes.x, at, v.x, lanes), store_plane(planes.y, at, v.y, lanes), store_plane(planes.z, at, v.z, lanes);
}
SHOAL_INLINE Vec3<WideF> load_plane(const PlaneXyz& planes, std::size_t at) {
  return {WideF::load(planes.x.data() + at), WideF::load(planes.y.data() + at), WideF::load(planes.z.data() + at)};
}

//   offset  of the block's first slot
SHOAL_INLINE void store_surface(GBuffer& gbuffer, std::size_t offset, const SurfaceSample<WideF>& s, WideM lanes) {
  store_plane(gbuffer.position_world, offset, s.position_world, lanes);
  store_plane(gbuffer.normal_world, offset, s.normal_world, lanes);
  store_plane(gbuffer.base_color, offset, s.base_color, lanes);
  store_plane(gbuffer.metallic, offset, s.metallic, lanes);
  store_plane(gbuffer.roughness, offset, s.roughness, lanes);
}

//   position, image  world: the point, and where it appears through flat water
SHOAL_INLINE void store_hits(HitPoints& hits, std::size_t offset, HitKind kind, WideI id, const Vec3<WideF>& position,
                             const Vec3<WideF>& image, WideM lanes) {
  store_plane(hits.position_world, offset, position, lanes);
  store_plane(hits.virtual_world, offset, image, lanes);
  store_plane(hits.kind, offset, WideI(static_cast<std::int32_t>(kind)), lanes);
  store_plane(hits.id, offset, id, lanes);
}

SHOAL_INLINE void store_interface_target(InterfaceTarget& target, std::size_t offset, const ExactRay<WideF>& at,
                                         WideM lanes) {
  store_plane(target.t, offset, at.t, lanes);
  store_plane(target.normal_world, offset, at.normal, lanes);
  store_plane(target.slope_variance, offset, at.slope_variance, lanes);
  store_plane(target.refracted, offset, at.refracted, lanes);
  store_plane(target.reflected, offset, at.reflected, lanes);
}

// What G-buffer and hit buffers hold of the water itself: its surface, and, until a later stage finds more, the sky.
//   roughness  of the waves that the pixel hides
SHOAL_INLINE void store_water(GBuffer& gbuffer, HitPoints& hits, std::size_t offset, const Vec3<WideF>& crossing,
                              const Vec3<WideF>& normal, WideF roughness, WideM lanes) {
  const Vec3<WideF> zero = broadcast<WideF>(Vec3f{0, 0, 0});
  store_surface(gbuffer, offset, {crossing, normal, zero, WideF(0.0f), WideF(0.0f), roughness, zero}, lanes);
  store_hits(hits, offset, HitKind::kSky, WideI(kNoId), zero, zero, lanes);
}

}  // namespace shoal::inline SHOAL_ISA_NS
