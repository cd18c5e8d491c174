// Attributes, material and light of what sixteen rays meet (shading/shade_hits.h): one copy for each instruction set.
#include "shading/shade_hits.h"

#include "shading/absorption.h"
#include "shading/alpha_test.h"
#include "shading/light.h"
#include "shading/shadow/shadow_lookup.h"
#include "shading/surface_maps.h"

namespace shoal::inline SHOAL_ISA_NS {

// The share of sunlight that reaches a point under water: Fresnel at the flat surface and absorption along the
// refracted ray; 1 above the plane.
static Vec3<WideF> light_under_water(const LightMedium& medium, Vec3<WideF> position) {
  const WideF depth_m =
      max(-dot(position - broadcast<WideF>(medium.plane_origin), broadcast<WideF>(medium.plane_normal)), WideF(0.0f));
  const WideM under = depth_m > WideF(0.0f);
  const Vec3<WideF> absorption_per_m = broadcast<WideF>(medium.absorption_per_m);
  const Vec3<WideF> left =
      transmittance(absorption_per_m, depth_m * WideF(medium.path_per_depth)) * WideF(medium.transmitted);
  const Vec3<WideF> one = broadcast<WideF>(Vec3f{1, 1, 1});
  return select<WideF>(under, left, one);
}

// The points that shadow rays towards the sun do not leave open.
static WideM blocked_lanes(const ShadowRays& rays, const LightMedium* medium, Vec3<WideF> position, Vec3<WideF> facet,
                           WideM lanes) {
  ShadowQuery query;
  position.x.store(query.position_world[0]), position.y.store(query.position_world[1]);
  position.z.store(query.position_world[2]);
  facet.x.store(query.facet_world[0]), facet.y.store(query.facet_world[1]), facet.z.store(query.facet_world[2]);
  return mask_from_bits(rays.blocked(rays.context, query, medium != nullptr ? &medium->bend : nullptr, to_bits(lanes)));
}

// The sun through a shadow map, or by rays, or with nothing in its way.
struct SceneSun {
  const ShadowRays& rays;  // read instead of the map where there are any
  const LightMedium* medium;
  const SunMap* map;         // null: no map
  const ShadowPlace& place;  // in the map's first level
  const PixelAttributes<WideF>& at;
  Vec3<WideF> facet;  // unit
  WideM active;

  template <class F>
  SHOAL_INLINE Vec3<F> reach(Vec3<F> irradiance, WideM facing) const {
    const WideM lanes = facing & active;
    if (none(lanes)) return irradiance;
    if (rays.blocked != nullptr) {
      const WideM dark = blocked_lanes(rays, medium, at.position_world, facet, lanes);
      return select<F>(dark, broadcast<F>(Vec3f{0, 0, 0}), irradiance);
    }
    if (map == nullptr) return irradiance;
    return irradiance * sun_visibility(*map, place, at.position_world, at.normal_world, facet, lanes);
  }
};

// The map of a medium, of the air where it is null; null where there are no maps.
static const SunMap* map_of(const SunShadows* shadows, const LightMedium* medium) {
  if (shadows == nullptr || shadows->maps.empty()) return nullptr;
  return &shadows->maps[medium != nullptr ? static_cast<std::size_t>(medium->sun_map) : 0];
}

// The lanes of one material's points, beside others'; the first one's all.
static SHOAL_INLINE void put_surface(const SurfaceSample<WideF>& s, WideM lanes, bool first, SurfaceSample<WideF>& to) {
  if (first) {
    to.position_world = s.position_world, to.normal_world = s.normal_world, to.base_color = s.base_color;
    to.alpha = s.alpha, to.metallic = s.metallic, to.roughness = s.roughness, to.emissive = s.emissive;
    to.f0_dielectric = s.f0_dielectric, to.occlusion = s.occlusion;
    return;
  }
  to.normal_world = select<WideF>(lanes, s.normal_world, to.normal_world);
  to.base_color = select<WideF>(lanes, s.base_color, to.base_color);
  to.alpha = select(lanes, s.alpha, to.alpha);
  to.metallic = select(lanes, s.metallic, to.metallic);
  to.roughness = select(lanes, s.roughness, to.roughness);
  to.emissive = select<WideF>(lanes, s.emissive, to.emissive);
  to.f0_dielectric = select(lanes, s.f0_dielectric, to.f0_dielectric);
  to.occlusion = select(lanes, s.occlusion, to.occlusion);
}

void shade_hits(const ShadingView& view, const Ray<WideF>& ray, const RayDifferential<WideF>& differential, WideI id,
                WideM active, const LightMedium* medium, ShadedLanes& out) {
  const GeometryView& g = view.geometry;
  PixelAttributes<WideF> a;
  resolve_attributes(g, ray, differential, id, active, a);
  const Vec3<WideF> to_eye = -normalize(ray.direction_world);
  // The shadow map's texels are prefetched before the material's work.
  const SunMap* map = map_of(view.sun_shadows, medium);
  const Vec3<WideF> facet = normalize(a.facet_world);
  ShadowPlace place;
  if (map != nullptr) find_place(map->levels[0], a.position_world, a.normal_world, facet, place);

  bool first = true;
  WideM unlit = mask_from_bits(0);
  for_each_distinct(a.material, active, [&](std::int32_t one, WideM lanes) SHOAL_LAMBDA {
    const Material& material = view.materials[one];
    const UvPoint<WideF> at = map_point(g, a, material.base_color_uv);
    SurfaceSample<WideF> s = make_surface<WideF>(material, view.textures, a.position_world, a.normal_world, at.uv,
                                                 at.duv_dx, at.duv_dy, a.color, to_eye, lanes);
    if (material.has_maps()) apply_maps(g, material, view.textures, a, to_eye, lanes, s);
    if (material.unlit) unlit = unlit | lanes;
    put_surface(s, lanes, first, out.surface);
    first = false;
  });
  const Vec3<WideF> light_scale =
      medium != nullptr ? light_under_water(*medium, a.position_world) : broadcast<WideF>(Vec3f{1, 1, 1});
  out.radiance = shade<WideF>(out.surface, unlit, to_eye, *view.lighting, light_scale,
                              SceneSun{view.shadow_rays, medium, map, place, a, facet, active});
  out.t = a.t;
}

std::uint32_t alpha_bits(const ShadingView& view, const Ray<WideF>& ray, const RayDifferential<WideF>& differential,
                         std::int32_t id, std::uint32_t cover) {
  return to_bits(alpha_cut(view.geometry, view.materials, view.textures, ray, differential, id, mask_from_bits(cover)));
}

}  // namespace shoal::inline SHOAL_ISA_NS
