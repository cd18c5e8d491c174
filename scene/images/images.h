// Reads image files as textures and writes textures as image files, with OpenImageIO.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "shading/textures/texture.h"

namespace shoal {

struct ImageLimits {
  int max_size = 16384;                               // texels, width and height
  std::uint64_t max_texels = std::uint64_t{1} << 28;  // of one image
};

struct ImageSize {
  int width = 0, height = 0;
  bool is_float = false;  // HDR and EXR: kRgba32Float; else an 8-bit format
};

// Reads the size of an encoded image from its header and checks it against the limits.
//
//   encoded  the bytes of a PNG, JPEG, Radiance HDR or OpenEXR file; the first bytes determine which of them it is
//   name     begins the message of an Error: "NAME: what is wrong; what was expected"
ImageSize image_size(std::span<const std::uint8_t> encoded, const std::string& name, const ImageLimits& limits = {});

// Decodes an image and builds its mip chain.
//
//   srgb  true: 8- and 16-bit values are sRGB-encoded colours; false: they are linear. Ignored for HDR and EXR.
//
// Returns RGBA: grey is repeated, missing alpha is 1, alpha is never premultiplied. A 16-bit PNG is rounded to the
// nearest 8-bit value, so that the sampler needs one load a texel. HDR and EXR become linear float; NaN becomes 0 and
// magnitudes are clamped to 1e9, so that no filter overflows.
// Throws Error for data that are damaged, truncated, of another format, or over the limits.
Texture decode_texture(std::span<const std::uint8_t> encoded, const std::string& name, bool srgb,
                       const ImageLimits& limits = {});

// Reads the bytes of an image file of at most 4 GiB.
std::vector<std::uint8_t> read_image_file(const std::string& path);

// Reads and decodes an image file.
Texture load_texture(const std::string& path, bool srgb, const ImageLimits& limits = {});

// Linear RGB, row-major, top to bottom.
struct LinearImage {
  int width = 0, height = 0;
  std::vector<float> rgb;
};

// Decodes an image as linear light, without alpha and mip levels. HDR and EXR values are those of the file, NaN and
// infinity included. PNG (all 16 bits) and JPEG values are decoded from sRGB to 0 to 1. Throws Error as decode_texture
// does.
LinearImage decode_linear(std::span<const std::uint8_t> encoded, const std::string& name,
                          const ImageLimits& limits = {});

// Encodes level 0 of a texture as a file in memory, without loss: PNG (8-bit RGBA) for the 8-bit formats, else OpenEXR
// (RGBA, 32-bit float). The same texture gives the same bytes.
//   name  begins the message of an Error
std::vector<std::uint8_t> encode_texture(const Texture& texture, const std::string& name);

}  // namespace shoal
