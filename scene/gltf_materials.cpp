// Materials, samplers, and the textures that base colours use.
#include <algorithm>
#include <cmath>

#include "core/math.h"
#include "scene/gltf_internal.h"
#include "scene/images.h"

namespace shoal::gltf {
namespace {

using tinygltf::Value;

// Clamped into the range that the specification gives, with a warning.
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

// Source: KHR_texture_transform, "Overview": uv' = translation * rotation * scale * uv. The rotation takes u towards -v
// there, as the v axis points down.
UvSource uv_source(Document& document, const tinygltf::TextureInfo& info, const std::string& label) {
  UvSource source;
  source.set = info.texCoord;
  const auto it = info.extensions.find("KHR_texture_transform");
  if (it == info.extensions.end() || !it->second.IsObject()) return source;
  const Value& transform = it->second;
  if (transform.Has("texCoord")) source.set = static_cast<int>(number_at(transform, "texCoord", source.set));
  const double rotation = number_at(transform, "rotation", 0);
  if (!(std::fabs(rotation) <= 1e6)) {
    fail(document.path, label + " has a texture rotation of " + std::to_string(rotation), "expected radians");
  }
  const float c = det_cos(static_cast<float>(rotation));
  const float s = det_sin(static_cast<float>(rotation));
  const auto scale_u = static_cast<float>(element_of(transform, "scale", 0, 1));
  const auto scale_v = static_cast<float>(element_of(transform, "scale", 1, 1));
  const float m[2][3] = {{c * scale_u, s * scale_v, static_cast<float>(element_of(transform, "offset", 0, 0))},
                         {-s * scale_u, c * scale_v, static_cast<float>(element_of(transform, "offset", 1, 0))}};
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 3; ++column) {
      if (!std::isfinite(m[row][column])) {
        fail(document.path, label + " has a texture transform that overflows", "expected finite numbers");
      }
      source.m[row][column] = m[row][column];
    }
  }
  source.transformed = true;
  return source;
}

// The image behind a material's base colour; -1: none, or none that can be read.
int base_color_image(const Document& document, const tinygltf::Material& material) {
  const int texture = material.pbrMetallicRoughness.baseColorTexture.index;
  return texture < 0 ? -1 : document.model.textures.at(static_cast<std::size_t>(texture)).source;
}

Texture read_image(Document& document, const EncodedImage& image) {
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
  // Sixteen or eight bytes a texel, and a third more for the mips.
  const std::uint64_t texels = static_cast<std::uint64_t>(size.width + 1) * static_cast<std::uint64_t>(size.height + 1);
  charge(document, texels * (size.is_float ? 16 : 8) / 3 * 4, image.label);
  return decode_texture(bytes, name, image.srgb, limits);
}

// Decodes the images that base colours use, in the file's order. Returns each image's place among the textures.
std::vector<std::int32_t> read_textures(Document& document, Materials& materials) {
  std::vector<char> used(document.images.size(), 0);
  for (const tinygltf::Material& material : document.model.materials) {
    const int image = base_color_image(document, material);
    if (image >= 0) used.at(static_cast<std::size_t>(image)) = 1;
  }
  std::vector<std::int32_t> places(used.size(), kNoTexture);
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    places[i] = static_cast<std::int32_t>(materials.textures.size());
    materials.textures.push_back(read_image(document, document.images[i]));
  }
  return places;
}

void read_base_color(Document& document, const tinygltf::Material& from, const std::string& label,
                     const std::vector<std::int32_t>& texture_places, Material& material, UvSource& source) {
  const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
  float rgba[4];
  for (std::size_t i = 0; i < 4; ++i) rgba[i] = factor(document, pbr.baseColorFactor.at(i), 1, "base colour factor");
  material.base_color = {rgba[0], rgba[1], rgba[2], rgba[3]};
  if (pbr.baseColorTexture.index < 0) return;
  source = uv_source(document, pbr.baseColorTexture, label);
  const int image = base_color_image(document, from);
  if (image < 0) {
    warn(document, "some textures have no image that can be read: their materials have the base colour factor alone");
    return;
  }
  const int sampler = document.model.textures[static_cast<std::size_t>(pbr.baseColorTexture.index)].sampler;
  material.base_color_texture = texture_places.at(static_cast<std::size_t>(image));
  material.base_color_sampler = read_sampler(document, sampler);
}

void read_alpha(Document& document, const tinygltf::Material& from, const std::string& label, Material& material) {
  if (from.alphaMode == "MASK") {
    material.alpha_mode = AlphaMode::kMask;
  } else if (from.alphaMode == "BLEND") {
    material.alpha_mode = AlphaMode::kBlend;
    warn(document, "blended materials are not read yet: drawn opaque");
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
  if (from.emissiveTexture.index >= 0 && rgb[0] + rgb[1] + rgb[2] > 0) {
    // The factor alone would make the whole surface glow.
    material.emissive = {0, 0, 0};
    warn(document, "emissive textures are not read yet: their materials do not glow");
  }
}

void warn_unread(Document& document, const tinygltf::Material& from) {
  if (from.normalTexture.index >= 0) warn(document, "normal textures are not read yet");
  if (from.occlusionTexture.index >= 0) warn(document, "occlusion textures are not read yet");
  for (const auto& [name, value] : from.extensions) {
    (void)value;
    if (name != "KHR_materials_unlit" && name != "KHR_materials_emissive_strength") {
      warn(document, "extension " + one_line(name, 60) + " is not read yet");
    }
  }
}

}  // namespace

std::vector<UvSource> read_materials(Document& document, Scene& scene) {
  std::vector<UvSource> sources;
  const std::vector<std::int32_t> texture_places = read_textures(document, scene.materials);
  for (std::size_t i = 0; i < document.model.materials.size(); ++i) {
    const tinygltf::Material& from = document.model.materials[i];
    const std::string label = label_of("materials", i, from.name);
    Material material;
    UvSource source;
    read_base_color(document, from, label, texture_places, material, source);
    read_alpha(document, from, label, material);
    read_emissive(document, from, material);
    const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
    material.metallic = factor(document, pbr.metallicFactor, 1, "metallic factor");
    material.roughness = factor(document, pbr.roughnessFactor, 1, "roughness factor");
    material.double_sided = from.doubleSided;
    material.unlit = from.extensions.count("KHR_materials_unlit") != 0;
    if (pbr.metallicRoughnessTexture.index >= 0) {
      // The factors of a textured material are usually 1, which alone would be bare metal.
      material.metallic = 0;
      warn(document, "metallic-roughness textures are not read yet: their materials are no metal, rough as the factor");
    }
    warn_unread(document, from);
    scene.materials.materials.push_back(material);
    sources.push_back(source);
  }
  return sources;
}

}  // namespace shoal::gltf
