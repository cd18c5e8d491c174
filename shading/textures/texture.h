// Textures: plain data. Sampling is in shading/textures/sample.h.
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

inline constexpr int kMaxTextureSize = 16384;
inline constexpr int kMaxTextureLevels = 15;  // 16384 = 2^14

// Level 0 and its mips, one after the other: 2 x 2 boxes in linear light, sizes halved and floored, down to 1 x 1.
//
// Both 8-bit formats are stored as 15-bit linear light (shading/srgb.h), 64 bits a texel: nothing is left to decode
// when a texel is read, and integer filtering gives the same bits on every machine. It costs twice the bytes of the
// input. Every level's rows have one more texel at the right end, the first of the row again, and every level one more
// row at the bottom, the first again, so that the four texels of a bilinear tap are two loads in the repeat mode too.
struct Texture {
  TexelFormat format = TexelFormat::kRgba8Srgb;
  int level_count = 0;
  // By level, sixteen entries each for a lookup a lane (shading/textures/sample.h); those past the last level repeat
  // it. Texel (x, y) of level k is number first_texel[k] + y * (width[k] + 1) + x.
  alignas(64) std::int32_t width[16] = {};
  alignas(64) std::int32_t height[16] = {};
  alignas(64) std::int32_t first_texel[16] = {};
  std::vector<std::uint64_t> rgba15;  // the 8-bit formats; R in the lowest sixteen bits, each 0 to kTexelOne
  std::vector<float> rgba32f;         // kRgba32Float; four a texel, finite
};

struct Sampler {
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
  Filter magnify = Filter::kLinear, minify = Filter::kLinear;
  MipFilter mip = MipFilter::kLinear;
  int anisotropy = 1;  // 1 (none) to 16; a frame's setting, not a file's
};

// Builds a texture and its mip chain.
//   width, height  texels, 1 to kMaxTextureSize; anything else throws Error
//   texels         level 0, row-major, top to bottom, without padding: 4 bytes (R, G, B, A) each
//   srgb           R, G and B are sRGB-encoded; alpha never is
// An odd size 2n + 1 goes to n texels of 2 + 1/n source texels each, so that no row or column is lost or moved.
// Differs: from the usual 2 x 2 box only at odd sizes. Error: a mip texel is within 0.51 / 32767 of the exact mean of
// the stored 15-bit texels (tests/shading/test_texture.cpp); levels are not rounded to 8 bits.
Texture make_texture_rgba8(int width, int height, const std::uint8_t* texels, bool srgb);

// The same for linear floats, 4 a texel. Values that are not finite become 0; others are clamped to +-1e37.
Texture make_texture_float(int width, int height, const float* rgba);

// The bytes (R, G, B, A; row-major, no padding) that level 0 of an 8-bit texture was made from, exactly.
std::vector<std::uint8_t> texture_bytes(const Texture& texture);

}  // namespace shoal
