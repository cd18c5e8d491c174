// Textures: plain data. Sampling is in raster/sample.h.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace shoal {

enum class TexelFormat : std::uint8_t {
  kRgba8Srgb,    // decoded to linear before filtering
  kRgba8Linear,  // UNORM
  kRgba32Float,  // linear
};
enum class Wrap : std::uint8_t { kRepeat, kMirror, kClamp };
enum class Filter : std::uint8_t { kNearest, kLinear };
enum class MipFilter : std::uint8_t { kNone, kNearest, kLinear };

// Sixteen bytes a texel for kRgba32Float, four otherwise; rows top to bottom, no gap between them.
// Level 0 and its mips (2 x 2 boxes in linear light, sizes halved and floored, down to 1 x 1), one after the other.
struct TextureLevel {
  int width = 0, height = 0;
  std::size_t first_texel = 0;
};
struct Texture {
  TexelFormat format = TexelFormat::kRgba8Srgb;
  std::vector<TextureLevel> levels;
  // For the 8-bit formats every level's rows are stored with one more texel at the right end, the first of the row
  // again, so that a pair of neighbours is one load in the repeat mode.
  std::vector<std::uint32_t> rgba8;  // R in the lowest byte
  std::vector<float> rgba32f;
};

struct Sampler {
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
  Filter magnify = Filter::kLinear, minify = Filter::kLinear;
  MipFilter mip = MipFilter::kLinear;
};

// Builds the mip chain. `texels` are level 0, row-major, without padding: 4 bytes each (RGBA).
Texture make_texture_rgba8(int width, int height, const std::uint8_t* texels, bool srgb);
Texture make_texture_float(int width, int height, const float* rgba);

}  // namespace shoal
