// Functions that paint textures.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "scene/procedural/textures.h"
#include "shading/textures/texture.h"

namespace shoal::paint {

// Colours in this file are sRGB, 0 to 1.
inline float clamp_unit(float x) { return std::min(1.0f, std::max(0.0f, x)); }
inline float lerp(float a, float b, float t) { return a + (b - a) * t; }
inline Vec3f lerp(Vec3f a, Vec3f b, float t) { return a + (b - a) * t; }
inline float ramp(float lo, float hi, float x) {
  const float t = clamp_unit((x - lo) / (hi - lo));
  return t * t * (3.0f - 2.0f * t);
}

// Calls paint(u, v), u and v in [0, 1), for every texel.
template <class Fn>
Texture paint_texture(int width, int height, Fn&& paint) {
  std::vector<std::uint8_t> texels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
  std::size_t at = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float u = (static_cast<float>(x) + 0.5f) / static_cast<float>(width);
      const float v = (static_cast<float>(y) + 0.5f) / static_cast<float>(height);
      const Vec3f c = paint(u, v);
      for (const float channel : {c.x, c.y, c.z}) {
        texels[at++] = static_cast<std::uint8_t>(clamp_unit(channel) * 255.0f + 0.5f);
      }
      texels[at++] = 255;
    }
  }
  return make_texture_rgba8(width, height, texels.data(), true);
}

inline float unit_hash(int x, int y, std::uint32_t seed) {
  return static_cast<float>(hash_lattice(x, y, seed) >> 8) * (1.0f / 16777216.0f);
}

// A cell of a lattice of tiles, and the distance to its nearest edge (in cells, 0 to 0.5).
struct Tile {
  int column, row;
  float x, y, edge;
};
inline Tile find_tile(float x, float y, float stagger = 0.0f) {
  Tile t;
  t.row = static_cast<int>(std::floor(y));
  x += stagger * static_cast<float>(t.row & 1);
  t.column = static_cast<int>(std::floor(x));
  t.x = x - std::floor(x);
  t.y = y - std::floor(y);
  t.edge = std::min(std::min(t.x, 1.0f - t.x), std::min(t.y, 1.0f - t.y));
  return t;
}

}  // namespace shoal::paint
