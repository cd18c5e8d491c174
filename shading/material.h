// Materials and lights: plain data that the pixel program reads.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/vec.h"
#include "raster/draw_state.h"
#include "shading/environment/environment.h"
#include "shading/textures/texture.h"
#include "shading/textures/uv_map.h"

namespace shoal {

enum class AlphaMode : std::uint8_t { kOpaque, kMask, kBlend };

inline constexpr std::int32_t kNoTexture = -1;

// A texture that modulates one property of a material.
struct MaterialMap {
  std::int32_t texture = kNoTexture;  // index into Materials::textures
  Sampler sampler;
  UvMap uv;
};

struct Material {
  Vec4f base_color{1, 1, 1, 1};                  // linear
  std::int32_t base_color_texture = kNoTexture;  // index into Materials::textures
  Sampler base_color_sampler;
  UvMap base_color_uv;
  float metallic = 1, roughness = 1;
  Vec3f emissive{0, 0, 0};
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  float alpha_cutoff = 0.5f;
  bool double_sided = false;
  bool unlit = false;

  MaterialMap metallic_roughness;  // linear: G times roughness, B times metallic
  MaterialMap normal;              // linear: a tangent-space normal from -1 to 1, x and y times normal_scale
  MaterialMap occlusion;           // linear: R, of ambient light only
  MaterialMap emission;            // sRGB: times emissive
  float normal_scale = 1, occlusion_strength = 1;
  float ior = 1.5f;  // of a dielectric: 1.5 reflects 0.04 at normal incidence (KHR_materials_ior); 0: all of it

  // Whether apply_maps (shading/surface_maps.h) changes the surface.
  bool has_maps() const {
    return metallic_roughness.texture != kNoTexture || normal.texture != kNoTexture ||
           occlusion.texture != kNoTexture || emission.texture != kNoTexture || ior != 1.5f;
  }
  // Sets the anisotropy of every texture: 1 to 16.
  void set_anisotropy(int limit) {
    for (Sampler* s :
         {&base_color_sampler, &metallic_roughness.sampler, &normal.sampler, &occlusion.sampler, &emission.sampler})
      s->anisotropy = limit;
  }
};

struct Materials {
  std::vector<Material> materials;
  std::vector<Texture> textures;
};

// The properties of each material that the rasterizer reads.
std::vector<DrawState> draw_states(const std::vector<Material>& materials);

struct DirectionalLight {
  Vec3f direction_world{0, -1, 0};  // unit, the way that the light travels
  Vec3f irradiance{1, 1, 1};        // linear, on a surface facing it (lux in glTF's terms)
};

// A point or spot light: small beside its distance.
struct PunctualLight {
  Vec3f position_world{0, 0, 0};
  Vec3f direction_world{0, -1, 0};  // unit, a spot's axis
  Vec3f intensity{1, 1, 1};         // linear; candela in glTF's terms
  float inverse_range2 = 0;         // 1 / range^2 (1/m^2); 0: no end
  // Across a spot's cone clamp(cosine * cone_scale + cone_offset, 0, 1)^2; these of a point light give 1.
  float cone_scale = 0, cone_offset = 1;
};

// The radiance of every ray that leaves the scene, and the source of ambient light.
struct Background {
  enum class Kind : std::uint8_t { kColor, kSky, kEnvironment } kind = Kind::kColor;
  Vec3f color{0, 0, 0};  // linear, kColor
  // kSky: a clear-day gradient between horizon and zenith, ground below, and the sun's disc and glow.
  Vec3f zenith{0.18f, 0.38f, 0.78f}, horizon{0.72f, 0.83f, 0.94f}, ground{0.35f, 0.33f, 0.30f};
  Vec3f to_sun_world{0, 1, 0};
  Vec3f sun{0, 0, 0};                              // radiance scale of disc and glow; 0 hides it
  std::shared_ptr<const Environment> environment;  // kEnvironment, and there only: never null then
};

struct Lighting {
  std::vector<DirectionalLight> directional;
  std::vector<PunctualLight> punctual;
  // Hemispherical ambient irradiance over pi: from above (+up) and from below.
  Vec3f ambient_up{0, 0, 0}, ambient_down{0, 0, 0};
  Vec3f up_world{0, 1, 0};
  Background background;
};

}  // namespace shoal
