#include "shading/textures/texture.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "core/error.h"
#include "shading/srgb.h"

namespace shoal {
namespace {

void check_size(int width, int height) {
  if (width >= 1 && width <= kMaxTextureSize && height >= 1 && height <= kMaxTextureSize) return;
  throw Error("texture: size is " + std::to_string(width) + " x " + std::to_string(height) + "; expected 1 to " +
              std::to_string(kMaxTextureSize) + " texels each way");
}

// Sizes and places of all levels; returns the number of texels, padding included.
std::size_t lay_out(Texture& texture, int width, int height) {
  std::size_t total = 0;
  int w = width, h = height;
  for (int k = 0; k < 16; ++k) {
    if (texture.level_count > 0 && texture.width[k - 1] == 1 && texture.height[k - 1] == 1) {
      texture.width[k] = texture.height[k] = 1;
      texture.first_texel[k] = texture.first_texel[k - 1];
      continue;
    }
    texture.width[k] = w;
    texture.height[k] = h;
    texture.first_texel[k] = static_cast<std::int32_t>(total);
    texture.level_count = k + 1;
    total += (static_cast<std::size_t>(w) + 1) * (static_cast<std::size_t>(h) + 1);
    w = std::max(w / 2, 1);
    h = std::max(h / 2, 1);
  }
  return total;
}

std::size_t texel_number(const Texture& texture, int level, int x, int y) {
  return static_cast<std::size_t>(texture.first_texel[level]) +
         static_cast<std::size_t>(y) * (static_cast<std::size_t>(texture.width[level]) + 1) +
         static_cast<std::size_t>(x);
}

// The source texels under one texel of the next level, along one axis: integer weights and their sum.
struct Taps {
  int first = 0, count = 1;
  std::uint64_t weight[3] = {1, 0, 0};
  std::uint64_t sum = 1;
};

std::vector<Taps> make_taps(int size) {
  const int half = std::max(size / 2, 1);
  std::vector<Taps> taps(static_cast<std::size_t>(half));
  for (int i = 0; size > 1 && i < half; ++i) {
    const auto n = static_cast<std::uint64_t>(half), at = static_cast<std::uint64_t>(i);
    if (size % 2 == 0)
      taps[static_cast<std::size_t>(i)] = {2 * i, 2, {1, 1, 0}, 2};
    else
      taps[static_cast<std::size_t>(i)] = {2 * i, 3, {n - at, n, at + 1}, 2 * n + 1};
  }
  return taps;
}

// Repeats the first column at the right and the first row at the bottom; `store` copies texel b to a.
template <class Copy>
void pad_level(const Texture& texture, int level, Copy copy) {
  const int w = texture.width[level], h = texture.height[level];
  for (int y = 0; y < h; ++y) copy(texel_number(texture, level, w, y), texel_number(texture, level, 0, y));
  for (int x = 0; x <= w; ++x) copy(texel_number(texture, level, x, h), texel_number(texture, level, x, 0));
}

// Calls make(x, y, horizontal taps, vertical taps) for every texel of `level`, from the sizes of the one above it.
template <class Make>
void for_each_mip_texel(const Texture& texture, int level, Make make) {
  const std::vector<Taps> across = make_taps(texture.width[level - 1]);
  const std::vector<Taps> down = make_taps(texture.height[level - 1]);
  for (int y = 0; y < texture.height[level]; ++y)
    for (int x = 0; x < texture.width[level]; ++x)
      make(x, y, across[static_cast<std::size_t>(x)], down[static_cast<std::size_t>(y)]);
}

// Makes a float safe to store: differences of stored floats do not overflow, and -0 becomes 0, so that filtering by a
// weight of 0 changes no bit.
float storable(float value) {
  constexpr float kLargest = 1e37f;
  return std::isfinite(value) ? std::clamp(value, -kLargest, kLargest) + 0.0f : 0.0f;
}

std::uint64_t pack15(const std::uint32_t* channel) {
  std::uint64_t texel = 0;
  for (int c = 0; c < 4; ++c) texel |= static_cast<std::uint64_t>(channel[c]) << (16 * c);
  return texel;
}

// The mip chain of 15-bit texels. Between levels the means keep sixteen more bits (31 in all), so that rounding does
// not add up down the chain; weights of two axes are below 2^28, so a sum fits 64 bits.
void build_mips(Texture& texture) {
  constexpr int kExtraBits = 16;
  std::vector<std::uint32_t> above, here;
  for (int level = 1; level < texture.level_count; ++level) {
    const auto width_above = static_cast<std::size_t>(texture.width[level - 1]);
    const auto width = static_cast<std::size_t>(texture.width[level]);
    here.assign(width * static_cast<std::size_t>(texture.height[level]) * 4, 0);
    for_each_mip_texel(texture, level, [&](int x, int y, const Taps& across, const Taps& down) {
      std::uint64_t sum[4] = {};
      for (int j = 0; j < down.count; ++j) {
        for (int i = 0; i < across.count; ++i) {
          const std::uint64_t weight = across.weight[i] * down.weight[j];
          const auto sx = static_cast<std::size_t>(across.first + i), sy = static_cast<std::size_t>(down.first + j);
          for (std::size_t c = 0; c < 4; ++c) {
            std::uint64_t value = 0;
            if (level > 1) {
              value = above[(sy * width_above + sx) * 4 + c];
            } else {
              const std::uint64_t texel = texture.rgba15[texel_number(texture, 0, across.first + i, down.first + j)];
              value = ((texel >> (16 * c)) & 0xFFFFu) << kExtraBits;
            }
            sum[c] += weight * value;
          }
        }
      }
      const std::uint64_t total = across.sum * down.sum;
      std::uint32_t rounded[4];
      for (std::size_t c = 0; c < 4; ++c) {
        const auto mean = static_cast<std::uint32_t>((sum[c] + total / 2) / total);
        here[(static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)) * 4 + c] = mean;
        rounded[c] = (mean + (1u << (kExtraBits - 1))) >> kExtraBits;
      }
      texture.rgba15[texel_number(texture, level, x, y)] = pack15(rounded);
    });
    above.swap(here);
  }
}

void build_mips_float(Texture& texture) {
  for (int level = 1; level < texture.level_count; ++level) {
    for_each_mip_texel(texture, level, [&](int x, int y, const Taps& across, const Taps& down) {
      double sum[4] = {};
      for (int j = 0; j < down.count; ++j) {
        for (int i = 0; i < across.count; ++i) {
          const double weight = static_cast<double>(across.weight[i] * down.weight[j]);
          const std::size_t texel = texel_number(texture, level - 1, across.first + i, down.first + j);
          for (std::size_t c = 0; c < 4; ++c) sum[c] += weight * static_cast<double>(texture.rgba32f[texel * 4 + c]);
        }
      }
      const double total = static_cast<double>(across.sum * down.sum);
      const std::size_t texel = texel_number(texture, level, x, y);
      for (std::size_t c = 0; c < 4; ++c) texture.rgba32f[texel * 4 + c] = storable(static_cast<float>(sum[c] / total));
    });
  }
}

}  // namespace

Texture make_texture_rgba8(int width, int height, const std::uint8_t* texels, bool srgb) {
  check_size(width, height);
  Texture texture;
  texture.format = srgb ? TexelFormat::kRgba8Srgb : TexelFormat::kRgba8Linear;
  texture.rgba15.resize(lay_out(texture, width, height));

  // UNORM byte to 15 bits: nearest, never a tie, for 255 is odd.
  const auto unorm = [](std::uint8_t byte) { return (byte * 2u * kTexelOne + 255u) / 510u; };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x, texels += 4) {
      std::uint32_t channel[4];
      for (int c = 0; c < 4; ++c)
        channel[c] = srgb && c < 3 ? static_cast<std::uint32_t>(kLinear15FromSrgb8.at[texels[c]]) : unorm(texels[c]);
      texture.rgba15[texel_number(texture, 0, x, y)] = pack15(channel);
    }
  }
  build_mips(texture);
  for (int k = 0; k < texture.level_count; ++k)
    pad_level(texture, k, [&](std::size_t to, std::size_t from) { texture.rgba15[to] = texture.rgba15[from]; });
  return texture;
}

Texture make_texture_float(int width, int height, const float* rgba) {
  check_size(width, height);
  Texture texture;
  texture.format = TexelFormat::kRgba32Float;
  texture.rgba32f.resize(lay_out(texture, width, height) * 4);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x, rgba += 4) {
      const std::size_t texel = texel_number(texture, 0, x, y);
      for (std::size_t c = 0; c < 4; ++c) texture.rgba32f[texel * 4 + c] = storable(rgba[c]);
    }
  }
  build_mips_float(texture);
  for (int k = 0; k < texture.level_count; ++k) {
    pad_level(texture, k, [&](std::size_t to, std::size_t from) {
      for (std::size_t c = 0; c < 4; ++c) texture.rgba32f[to * 4 + c] = texture.rgba32f[from * 4 + c];
    });
  }
  return texture;
}

std::vector<std::uint8_t> texture_bytes(const Texture& texture) {
  if (texture.format == TexelFormat::kRgba32Float) throw Error("texture: texels are floats; expected an 8-bit format");
  const auto byte_of_srgb = [](std::uint32_t linear15) {
    const auto at = std::lower_bound(std::begin(kLinear15FromSrgb8.at), std::end(kLinear15FromSrgb8.at),
                                     static_cast<int>(linear15));
    return static_cast<std::uint8_t>(at - std::begin(kLinear15FromSrgb8.at));
  };
  const auto byte_of_unorm = [](std::uint32_t linear15) {
    return static_cast<std::uint8_t>((linear15 * 510u + kTexelOne) / (2u * kTexelOne));
  };
  std::vector<std::uint8_t> bytes;
  bytes.reserve(static_cast<std::size_t>(texture.width[0]) * static_cast<std::size_t>(texture.height[0]) * 4);
  for (int y = 0; y < texture.height[0]; ++y) {
    for (int x = 0; x < texture.width[0]; ++x) {
      const std::uint64_t texel = texture.rgba15[texel_number(texture, 0, x, y)];
      for (int c = 0; c < 4; ++c) {
        const auto value = static_cast<std::uint32_t>(texel >> (16 * c)) & 0xFFFFu;
        const bool encoded = texture.format == TexelFormat::kRgba8Srgb && c < 3;
        bytes.push_back(encoded ? byte_of_srgb(value) : byte_of_unorm(value));
      }
    }
  }
  return bytes;
}

}  // namespace shoal
