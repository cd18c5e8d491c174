// Attributes, material and light of what sixteen rays hit: one copy an ISA, for every pass and method.
#include "shading/light.h"
#include "shading/surface_maps.h"
#include "refraction/pixel_stage.h"
#include "shading/shadow/shadow_lookup.h"
#include "trace/trace_rays.h"

namespace shoal::inline SHOAL_ISA_NS {

// What sunlight keeps on its way through the water down to a point: Fresnel at the flat surface and absorption along
// the refracted ray; 1 above the plane. Without a directional light, straight down.
static Vec3<WideF> light_under_water(const WaterPass& water, const Lighting& lighting, Vec3<WideF> position) {
  const WaterBody& body = *water.body;
  const WideF depth_m = max(-dot(position - broadcast<WideF>(body.origin), broadcast<WideF>(body.normal)), WideF(0.0f));
  float cosine = 1.0f;
  if (!lighting.directional.empty())
    cosine = min(max(-dot(lighting.directional[0].direction_world, body.normal), 0.05f), 1.0f);
  const float eta = 1.0f / body.ior;
  const float sine2 = eta * eta * (1.0f - cosine * cosine);
  const float cosine_water = sqrt(max(1.0f - sine2, 0.01f));
  const float enters = 1.0f - fresnel_dielectric(cosine, eta);
  const WideM under = depth_m > WideF(0.0f);
  const Vec3<WideF> kept = absorbed(body, depth_m * WideF(1.0f / cosine_water)) * WideF(enters);
  const Vec3<WideF> one = broadcast<WideF>(Vec3f{1, 1, 1});
  return select<WideF>(under, kept, one);
}

// The sun through a shadow map, or by rays, or open.
struct SceneSun {
  const FrameData& frame;
  const WaterPass* water;
  const SunMap* map;         // null: open, or by rays
  const ShadowPlace& place;  // in the map's first level
  const PixelAttributes<WideF>& at;
  Vec3<WideF> facet;  // unit
  WideM active;

  template <class F>
  SHOAL_INLINE Vec3<F> reach(Vec3<F> irradiance, WideM facing) const {
    const WideM lanes = facing & active;
    if (none(lanes)) return irradiance;
    if (frame.settings.shadows == Shadows::kRays) {
      const WideM dark = sun_blocked(frame, water, at.position_world, facet, lanes);
      return select<F>(dark, broadcast<F>(Vec3f{0, 0, 0}), irradiance);
    }
    if (map == nullptr) return irradiance;
    return irradiance * sun_visibility(*map, place, at.position_world, at.normal_world, facet, lanes);
  }
};

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

void shade_hits(const FrameData& f, const Ray<WideF>& ray, const RayDifferential<WideF>& differential, WideI id,
                WideM active, const WaterPass* water, ShadedLanes& out) {
  PixelAttributes<WideF> a;
  resolve_attributes(f.geometry, ray, differential, id, active, a);
  const Vec3<WideF> to_eye = -normalize(ray.direction_world);
  // The shadow map's texels are on their way while the material is worked on.
  const SunMap* map = water != nullptr ? f.shadows.of_body(static_cast<std::size_t>(water->index)) : f.shadows.air();
  const Vec3<WideF> facet = normalize(a.facet_world);
  ShadowPlace place;
  if (map != nullptr) find_place(map->levels[0], a.position_world, a.normal_world, facet, place);

  const Materials& all_materials = f.scene->materials;
  bool first = true;
  WideM unlit = mask_from_bits(0);
  for_each_distinct(a.material, active, [&](std::int32_t one, WideM lanes) SHOAL_LAMBDA {
    const Material& material = f.geometry.materials[one];
    const UvPoint<WideF> at = map_point(f.geometry, a, material.base_color_uv);
    SurfaceSample<WideF> s = make_surface<WideF>(material, all_materials, a.position_world, a.normal_world, at.uv,
                                                 at.duv_dx, at.duv_dy, a.color, to_eye, lanes);
    if (material.has_maps()) apply_maps(f.geometry, material, all_materials, a, to_eye, lanes, s);
    if (material.unlit) unlit = unlit | lanes;
    put_surface(s, lanes, first, out.surface);
    first = false;
  });
  const Vec3<WideF> light_scale = water != nullptr ? light_under_water(*water, f.scene->lighting, a.position_world)
                                                   : broadcast<WideF>(Vec3f{1, 1, 1});
  out.radiance = shade<WideF>(out.surface, unlit, to_eye, f.scene->lighting, light_scale,
                              SceneSun{f, water, map, place, a, facet, active});
  out.t = a.t;
}

std::uint32_t alpha_bits(const FrameData& f, const Ray<WideF>& ray, const RayDifferential<WideF>& differential,
                         std::int32_t id, std::uint32_t cover) {
  return to_bits(alpha_cut(f.geometry, f.scene->materials, ray, differential, id, mask_from_bits(cover)));
}

}  // namespace shoal::inline SHOAL_ISA_NS
