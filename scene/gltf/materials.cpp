// Reads materials, samplers, and the textures that materials use.
#include <algorithm>
#include <cmath>

#include "scene/gltf/internal.h"
#include "scene/images/images.h"

namespace shoal::gltf {
namespace {

using tinygltf::Value;

// Clamps a value to the range of the specification, with a warning.
float factor(Document& document, double value, double max, const std::string& what) {
  if (!(value >= 0 && value <= max)) {
    warn(document, "some materials have a " + what + " outside of 0 to " +
                       (max < 2 ? "1" : std::to_string(static_cast<std::int64_t>(max))) + ": clamped");
    value = value < 0 ? 0 : max;
  }
  return static_cast<float>(value);
}

Wrap wrap_mode(Document& document, int mode, const std::string& label) {
  switch (mode) {
    case TINYGLTF_TEXTURE_WRAP_REPEAT:
      return Wrap::kRepeat;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
      return Wrap::kMirror;
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
      return Wrap::kClamp;
    default:
      fail(document.path, label + " has wrap mode " + std::to_string(mode), "expected 10497, 33071 or 33648");
  }
}

Sampler read_sampler(Document& document, int index) {
  Sampler sampler;
  if (index < 0) return sampler;
  const tinygltf::Sampler& from = document.model.samplers.at(static_cast<std::size_t>(index));
  const std::string label = label_of("samplers", static_cast<std::size_t>(index), from.name);
  sampler.wrap_u = wrap_mode(document, from.wrapS, label);
  sampler.wrap_v = wrap_mode(document, from.wrapT, label);
  switch (from.magFilter) {
    case -1:
    case TINYGLTF_TEXTURE_FILTER_LINEAR:
      sampler.magnify = Filter::kLinear;
      break;
    case TINYGLTF_TEXTURE_FILTER_NEAREST:
      sampler.magnify = Filter::kNearest;
      break;
    default:
      fail(document.path, label + " has magFilter " + std::to_string(from.magFilter), "expected 9728 or 9729");
  }
  struct Minify {
    int code;
    Filter filter;
    MipFilter mip;
  };
  constexpr Minify kMinify[] = {{-1, Filter::kLinear, MipFilter::kLinear},
                                {TINYGLTF_TEXTURE_FILTER_NEAREST, Filter::kNearest, MipFilter::kNone},
                                {TINYGLTF_TEXTURE_FILTER_LINEAR, Filter::kLinear, MipFilter::kNone},
                                {TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST, Filter::kNearest, MipFilter::kNearest},
                                {TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST, Filter::kLinear, MipFilter::kNearest},
                                {TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR, Filter::kNearest, MipFilter::kLinear},
                                {TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR, Filter::kLinear, MipFilter::kLinear}};
  const auto it =
      std::find_if(std::begin(kMinify), std::end(kMinify), [&](const Minify& m) { return m.code == from.minFilter; });
  if (it == std::end(kMinify)) {
    fail(document.path, label + " has minFilter " + std::to_string(from.minFilter),
         "expected 9728, 9729 or 9984 to 9987");
  }
  sampler.minify = it->filter;
  sampler.mip = it->mip;
  return sampler;
}

double number_at(const Value& object, const char* key, double fallback) {
  return object.Has(key) && object.Get(key).IsNumber() ? object.Get(key).GetNumberAsDouble() : fallback;
}
double element_of(const Value& object, const char* key, int index, double fallback) {
  if (!object.Has(key) || !object.Get(key).IsArray()) return fallback;
  const Value& element = object.Get(key).Get(index);
  return element.IsNumber() ? element.GetNumberAsDouble() : fallback;
}

// Reads the set and the transform of a texture's coordinates. UvMap::set holds the file's number here.
// Source: KHR_texture_transform, whose texCoord overrides that of the texture reference.
UvMap read_uv_map(const Document& document, int tex_coord, const tinygltf::ExtensionMap& extensions,
                  const std::string& label) {
  const auto it = extensions.find("KHR_texture_transform");
  UvMap map;
  map.set = tex_coord;
  if (it == extensions.end() || !it->second.IsObject()) return map;
  const Value& transform = it->second;
  const auto set = static_cast<std::int32_t>(number_at(transform, "texCoord", tex_coord));
  const double rotation = number_at(transform, "rotation", 0);
  if (!(std::fabs(rotation) <= 1e6)) {
    fail(document.path, label + " has a texture rotation of " + std::to_string(rotation), "expected radians");
  }
  const auto pair = [&](const char* key, double fallback) {
    return Vec2f{static_cast<float>(element_of(transform, key, 0, fallback)),
                 static_cast<float>(element_of(transform, key, 1, fallback))};
  };
  map = make_uv_map(set, pair("offset", 0), static_cast<float>(rotation), pair("scale", 1));
  for (const auto& row : map.row) {
    for (const float value : row) {
      if (!std::isfinite(value)) {
        fail(document.path, label + " has a texture transform that overflows", "expected finite numbers");
      }
    }
  }
  return map;
}

// The image of a texture; -1 where there is none that can be read.
int image_of(const Document& document, int texture) {
  return texture < 0 ? -1 : document.model.textures.at(static_cast<std::size_t>(texture)).source;
}

bool is_unlit(const tinygltf::Material& material) { return material.extensions.count("KHR_materials_unlit") != 0; }

bool glows(const tinygltf::Material& material) {
  return std::any_of(material.emissiveFactor.begin(), material.emissiveFactor.end(), [](double f) { return f > 0; });
}

Texture read_image(Document& document, const EncodedImage& image, bool srgb) {
  const std::string name = one_line(document.path, 4096) + ": " + image.label;
  std::vector<std::uint8_t> from_file;
  Bytes bytes = image.bytes;
  if (!image.uri.empty()) {
    const std::string file = resolve_uri(document, image.uri, image.label);
    from_file = read_file(file, document.limits.max_file_bytes, document.path);
    bytes = from_file;
  }
  const ImageLimits limits{document.limits.max_texture_size, document.limits.max_texels};
  const ImageSize size = image_size(bytes, name, limits);
  // The memory of a texel and a third more for the mip levels.
  const std::uint64_t texels = static_cast<std::uint64_t>(size.width + 1) * static_cast<std::uint64_t>(size.height + 1);
  charge(document, texels * (size.is_float ? 16 : 8) / 3 * 4, image.label);
  return decode_texture(bytes, name, srgb && image.srgb, limits);
}

// The texture of each image, as colour and as data. An image that is used as both becomes two textures.
struct TexturePlaces {
  std::vector<std::int32_t> color, data;
};

// Decodes the images that materials use, in the file's order.
TexturePlaces read_textures(Document& document, Materials& materials) {
  const std::size_t count = document.images.size();
  std::vector<char> is_color(count, 0), is_data(count, 0);
  const auto use = [&](std::vector<char>& as, int texture) {
    const int image = image_of(document, texture);
    if (image >= 0) as.at(static_cast<std::size_t>(image)) = 1;
  };
  for (const tinygltf::Material& material : document.model.materials) {
    use(is_color, material.pbrMetallicRoughness.baseColorTexture.index);
    if (is_unlit(material)) continue;
    if (glows(material)) use(is_color, material.emissiveTexture.index);
    use(is_data, material.pbrMetallicRoughness.metallicRoughnessTexture.index);
    use(is_data, material.normalTexture.index);
    use(is_data, material.occlusionTexture.index);
  }
  TexturePlaces places;
  places.color.assign(count, kNoTexture);
  places.data.assign(count, kNoTexture);
  for (std::size_t i = 0; i < count; ++i) {
    const auto add = [&](bool srgb) {
      materials.textures.push_back(read_image(document, document.images[i], srgb));
      return static_cast<std::int32_t>(materials.textures.size() - 1);
    };
    if (is_color[i]) places.color[i] = add(true);
    if (!is_data[i]) continue;
    const bool shared = is_color[i] && materials.textures.back().format != TexelFormat::kRgba8Srgb;
    places.data[i] = shared ? places.color[i] : add(false);
  }
  return places;
}

// The common part of tinygltf's kinds of texture reference.
template <class Info>
MaterialMap read_map(Document& document, const Info& info, const std::vector<std::int32_t>& places,
                     const std::string& label) {
  MaterialMap map;
  if (info.index < 0) return map;
  const int image = image_of(document, info.index);
  if (image < 0) {
    warn(document, "some textures have no image that can be read: their materials go without them");
    return map;
  }
  map.texture = places.at(static_cast<std::size_t>(image));
  map.sampler = read_sampler(document, document.model.textures[static_cast<std::size_t>(info.index)].sampler);
  map.uv = read_uv_map(document, info.texCoord, info.extensions, label);
  return map;
}

void read_base_color(Document& document, const tinygltf::Material& from, const std::string& label,
                     const TexturePlaces& places, Material& material) {
  const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
  float rgba[4];
  for (std::size_t i = 0; i < 4; ++i) rgba[i] = factor(document, pbr.baseColorFactor.at(i), 1, "base colour factor");
  material.base_color = {rgba[0], rgba[1], rgba[2], rgba[3]};
  const MaterialMap map = read_map(document, pbr.baseColorTexture, places.color, label);
  material.base_color_texture = map.texture;
  material.base_color_sampler = map.sampler;
  material.base_color_uv = map.uv;
}

// Reads all maps except the base colour.
void read_maps(Document& document, const tinygltf::Material& from, const std::string& label,
               const TexturePlaces& places, Material& material) {
  material.metallic_roughness =
      read_map(document, from.pbrMetallicRoughness.metallicRoughnessTexture, places.data, label);
  material.normal = read_map(document, from.normalTexture, places.data, label);
  material.occlusion = read_map(document, from.occlusionTexture, places.data, label);
  if (glows(from)) material.emission = read_map(document, from.emissiveTexture, places.color, label);
  if (material.normal.texture != kNoTexture) {
    const double scale = from.normalTexture.scale;
    if (!(std::fabs(scale) <= 1e6)) {
      fail(document.path, label + " has a normal scale of " + std::to_string(scale), "expected at most a million");
    }
    material.normal_scale = static_cast<float>(scale);
  }
  if (material.occlusion.texture != kNoTexture) {
    material.occlusion_strength = factor(document, from.occlusionTexture.strength, 1, "occlusion strength");
  }
}

// Reads the index of refraction: 1 or more, or 0 for full reflection. Source: KHR_materials_ior.
void read_ior(Document& document, const tinygltf::Material& from, Material& material) {
  const auto it = from.extensions.find("KHR_materials_ior");
  if (it == from.extensions.end() || !it->second.IsObject()) return;
  const double ior = number_at(it->second, "ior", 1.5);
  if (ior != 0 && !(ior >= 1 && ior <= 1e6)) {
    warn(document, "some materials have an ior that is neither 0 nor from 1 on: clamped");
  }
  material.ior = ior == 0 ? 0.0f : static_cast<float>(std::fmin(std::fmax(ior, 1.0), 1e6));
}

// Numbers the sets of texture coordinates that a material uses, at most two, in increasing order.
UvSource number_uv_sets(Document& document, Material& material) {
  UvSource source;
  std::vector<UvMap*> maps;
  const auto use = [&](std::int32_t texture, UvMap& uv) {
    if (texture != kNoTexture) maps.push_back(&uv);
  };
  use(material.base_color_texture, material.base_color_uv);
  for (MaterialMap* map : {&material.metallic_roughness, &material.normal, &material.occlusion, &material.emission}) {
    use(map->texture, map->uv);
  }
  for (const UvMap* map : maps) source.sets.push_back(map->set);
  std::sort(source.sets.begin(), source.sets.end());
  source.sets.erase(std::unique(source.sets.begin(), source.sets.end()), source.sets.end());
  if (source.sets.size() > 2) {
    warn(document,
         "some materials use more than two sets of texture coordinates: the third and on are taken for the first");
    source.sets.resize(2);
  }
  for (UvMap* map : maps) map->set = source.sets.size() > 1 && map->set == source.sets[1] ? 1 : 0;
  source.needs_tangents = material.normal.texture != kNoTexture;
  source.normal_uv = material.normal.uv;
  return source;
}

void read_alpha(Document& document, const tinygltf::Material& from, const std::string& label, Material& material) {
  if (from.alphaMode == "MASK") {
    material.alpha_mode = AlphaMode::kMask;
  } else if (from.alphaMode == "BLEND") {
    material.alpha_mode = AlphaMode::kBlend;
  } else if (from.alphaMode != "OPAQUE") {
    fail(document.path, label + " has alphaMode '" + one_line(from.alphaMode, 40) + "'",
         "expected OPAQUE, MASK or BLEND");
  }
  material.alpha_cutoff = factor(document, from.alphaCutoff, 1e6, "alphaCutoff");
}

void read_emissive(Document& document, const tinygltf::Material& from, Material& material) {
  if (from.emissiveFactor.size() != 3) return;
  double strength = 1;
  const auto it = from.extensions.find("KHR_materials_emissive_strength");
  if (it != from.extensions.end() && it->second.IsObject()) strength = number_at(it->second, "emissiveStrength", 1);
  strength = factor(document, strength, 1e9, "emissiveStrength");
  float rgb[3];
  for (std::size_t i = 0; i < 3; ++i) {
    rgb[i] = static_cast<float>(factor(document, from.emissiveFactor[i], 1, "emissive factor") * strength);
  }
  material.emissive = {rgb[0], rgb[1], rgb[2]};
}

void warn_unread(Document& document, const tinygltf::Material& from) {
  for (const auto& [name, value] : from.extensions) {
    (void)value;
    if (name != "KHR_materials_unlit" && name != "KHR_materials_emissive_strength" && name != "KHR_materials_ior") {
      warn(document, "extension " + one_line(name, 60) + " is not read yet");
    }
  }
}

}  // namespace

std::vector<UvSource> read_materials(Document& document, Scene& scene) {
  std::vector<UvSource> sources;
  const TexturePlaces places = read_textures(document, scene.materials);
  for (std::size_t i = 0; i < document.model.materials.size(); ++i) {
    const tinygltf::Material& from = document.model.materials[i];
    const std::string label = label_of("materials", i, from.name);
    Material material;
    read_base_color(document, from, label, places, material);
    read_alpha(document, from, label, material);
    read_emissive(document, from, material);
    const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
    material.metallic = factor(document, pbr.metallicFactor, 1, "metallic factor");
    material.roughness = factor(document, pbr.roughnessFactor, 1, "roughness factor");
    material.double_sided = from.doubleSided;
    material.unlit = is_unlit(from);
    if (!material.unlit) read_maps(document, from, label, places, material);
    read_ior(document, from, material);
    warn_unread(document, from);
    sources.push_back(number_uv_sets(document, material));
    scene.materials.materials.push_back(material);
  }
  return sources;
}

}  // namespace shoal::gltf
