// Image files as textures, and textures as image files. The only place of the scene room that uses OpenImageIO.
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

// Size of an encoded image from its header alone, checked against the limits; nothing is decoded.
//
//   encoded  the bytes of a PNG, JPEG, Radiance HDR or OpenEXR file; which of them it is, the first bytes say
//   name     begins the message of an Error: "NAME: what is wrong; what was expected"
ImageSize image_size(std::span<const std::uint8_t> encoded, const std::string& name, const ImageLimits& limits = {});

// Decodes an image and builds its mip chain.
//
//   srgb  true: 8- and 16-bit values are sRGB-encoded colours; false: they are linear. Ignored for HDR and EXR.
//
// Returns RGBA: grey is repeated, missing alpha is 1, alpha is never premultiplied. A 16-bit PNG is rounded to the
// nearest of 8 bits: base colours gain nothing from more, and the sampler stays one load a texel. HDR and EXR become
// linear float; NaN becomes 0 and magnitudes end at 1e9, so that no filter overflows.
// Throws Error for data that are damaged, cut short, of another format, or over the limits.
Texture decode_texture(std::span<const std::uint8_t> encoded, const std::string& name, bool srgb,
                       const ImageLimits& limits = {});

// The bytes of an image file, at most 4 GiB.
std::vector<std::uint8_t> read_image_file(const std::string& path);

// The same from a file.
Texture load_texture(const std::string& path, bool srgb, const ImageLimits& limits = {});

// RGB, row-major, top to bottom.
struct LinearImage {
  int width = 0, height = 0;
  std::vector<float> rgb;
};

// Decodes an image as linear light, without alpha and without mips. HDR and EXR: as the file has it, numbers that are
// none and infinite ones included. PNG (16 bits in full) and JPEG: 0 to 1, sRGB decoded. Throws Error as
// decode_texture.
LinearImage decode_linear(std::span<const std::uint8_t> encoded, const std::string& name,
                          const ImageLimits& limits = {});

// Level 0 of a texture as a file in memory: PNG (8-bit RGBA) for the 8-bit formats, else OpenEXR (RGBA, 32-bit float).
// Lossless, and the same bytes for the same texture. `name` is for messages.
std::vector<std::uint8_t> encode_texture(const Texture& texture, const std::string& name);

}  // namespace shoal
