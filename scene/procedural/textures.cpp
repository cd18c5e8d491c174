#include "scene/procedural/textures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/procedural/texture_paint.h"

namespace shoal {
using namespace paint;
namespace {

// Glazed tiles in pale grout. Each has its own shade between three colours and is darker towards its rim.
Texture make_mosaic(int size, const std::array<Vec3f, 3>& shades, Vec3f grout, std::uint32_t seed) {
  constexpr int kTiles = 16;
  return paint_texture(size, size, [&](float u, float v) {
    Tile t = find_tile(u * kTiles, v * kTiles);
    const float pick = unit_hash(t.column, t.row, seed) * 1.999f;
    Vec3f c = pick < 1.0f ? lerp(shades[0], shades[1], pick) : lerp(shades[1], shades[2], pick - 1.0f);
    const float cloud = fractal_noise(u * 32.0f, v * 32.0f, 32, 3, seed + 1) - 0.5f;
    const float slope = (unit_hash(t.column, t.row, seed + 2) - 0.5f) * (t.x - 0.5f) +
                        (unit_hash(t.column, t.row, seed + 3) - 0.5f) * (t.y - 0.5f);
    c = c * (1.0f + 0.10f * cloud + 0.10f * slope);
    c = c * lerp(0.86f, 1.0f, ramp(0.03f, 0.12f, t.edge));
    return lerp(grout * (1.0f + 0.1f * cloud), c, ramp(0.025f, 0.04f, t.edge));
  });
}

}  // namespace

std::uint32_t hash_lattice(std::int32_t x, std::int32_t y, std::uint32_t seed) {
  std::uint32_t h =
      static_cast<std::uint32_t>(x) * 0x9E3779B1u + static_cast<std::uint32_t>(y) * 0x85EBCA77u + seed * 0xC2B2AE3Du;
  h = (h ^ (h >> 16)) * 0x7FEB352Du;
  h = (h ^ (h >> 15)) * 0x846CA68Bu;
  return h ^ (h >> 16);
}

namespace {

// The greatest integer not above x, |x| < 2^31, without a call.
std::int32_t floor_of(float x) {
  const std::int32_t i = static_cast<std::int32_t>(x);
  return static_cast<float>(i) > x ? i - 1 : i;
}

// The values at the corners of the lattice cell that a noise was last evaluated in. Textures are painted row by row,
// and a cell is many texels wide, so most evaluations find their corners here instead of computing four hashes.
struct LatticeCell {
  std::int32_t x = 0, y = 0, period = -1;
  std::uint32_t seed = 0;
  float corner[4] = {};
};

const LatticeCell& lattice_cell(std::int32_t x, std::int32_t y, std::int32_t period, std::uint32_t seed) {
  thread_local std::array<LatticeCell, 64> kept;
  LatticeCell& cell = kept[seed * 0x9E3779B1u >> 26];
  if (cell.x == x && cell.y == y && cell.period == period && cell.seed == seed) return cell;
  const auto wrap = [period](std::int32_t i) {
    return period > 0 && (i < 0 || i >= period) ? ((i % period) + period) % period : i;
  };
  const std::int32_t x0 = wrap(x), x1 = wrap(x + 1), y0 = wrap(y), y1 = wrap(y + 1);
  cell = {x,
          y,
          period,
          seed,
          {unit_hash(x0, y0, seed), unit_hash(x1, y0, seed), unit_hash(x0, y1, seed), unit_hash(x1, y1, seed)}};
  return cell;
}

}  // namespace

float value_noise(float x, float y, std::int32_t period, std::uint32_t seed) {
  const std::int32_t ix = floor_of(x), iy = floor_of(y);
  const float sx = ramp(0, 1, x - static_cast<float>(ix)), sy = ramp(0, 1, y - static_cast<float>(iy));
  const LatticeCell& cell = lattice_cell(ix, iy, period, seed);
  return lerp(lerp(cell.corner[0], cell.corner[1], sx), lerp(cell.corner[2], cell.corner[3], sx), sy);
}

float fractal_noise(float x, float y, std::int32_t period, int octaves, std::uint32_t seed) {
  float sum = 0, weight = 0, amplitude = 1;
  for (int i = 0; i < octaves; ++i) {
    sum += amplitude * value_noise(x, y, period, seed + static_cast<std::uint32_t>(i) * 101u);
    weight += amplitude;
    amplitude *= 0.5f;
    x *= 2;
    y *= 2;
    period *= 2;
  }
  return sum / weight;
}

Texture make_pool_tiles() {
  return make_mosaic(1024, {Vec3f{0.36f, 0.74f, 0.80f}, Vec3f{0.50f, 0.84f, 0.86f}, Vec3f{0.66f, 0.91f, 0.90f}},
                     {0.86f, 0.93f, 0.92f}, 11);
}

Texture make_lane_tiles() {
  return make_mosaic(512, {Vec3f{0.05f, 0.15f, 0.42f}, Vec3f{0.08f, 0.21f, 0.50f}, Vec3f{0.12f, 0.28f, 0.58f}},
                     {0.45f, 0.60f, 0.72f}, 23);
}

Texture make_waterline_tiles() {
  // 10 x 5 mosaic cells a motif, two motifs a texture: rims, and a diamond chain between.
  static constexpr const char* kMotif[10] = {"nnnnnnnnnn", "wwwwwwwwww", "nnnnbbnnnn", "nnnbttbnnn", "nnbtggtbnn",
                                             "nnbtggtbnn", "nnnbttbnnn", "nnnnbbnnnn", "wwwwwwwwww", "nnnnnnnnnn"};
  return paint_texture(512, 256, [&](float u, float v) {
    const Tile t = find_tile(u * 20.0f, v * 10.0f);
    const float shade = 0.85f + 0.3f * unit_hash(t.column, t.row, 31);
    Vec3f c{0.06f, 0.16f, 0.40f};
    switch (kMotif[t.row % 10][t.column % 10]) {
      case 'w':
        c = {0.88f, 0.93f, 0.93f};
        break;
      case 'b':
        c = {0.14f, 0.42f, 0.72f};
        break;
      case 't':
        c = {0.25f, 0.70f, 0.78f};
        break;
      case 'g':
        c = {0.95f, 0.78f, 0.38f};
        break;
      default:
        break;
    }
    return lerp(Vec3f{0.70f, 0.78f, 0.80f}, c * shade, ramp(0.06f, 0.10f, t.edge));
  });
}

Texture make_pavers() {
  return paint_texture(1024, 1024, [](float u, float v) {
    Tile t = find_tile(u * 4.0f, v * 4.0f, 0.5f);
    t.column &= 3;
    const float tone = unit_hash(t.column, t.row, 41), warm = unit_hash(t.column, t.row, 42);
    Vec3f c = lerp(Vec3f{0.80f, 0.73f, 0.62f}, Vec3f{0.90f, 0.85f, 0.76f}, tone);
    c = lerp(c, Vec3f{0.86f, 0.76f, 0.63f}, 0.5f * warm);
    // Travertine: layers drawn out along u, with pits.
    const float layers = fractal_noise(u * 6.0f, v * 28.0f + tone * 9.0f, 0, 1, 43);
    const float cloud = fractal_noise(u * 16.0f, v * 16.0f, 16, 4, 44);
    const float pits = ramp(0.70f, 0.80f, fractal_noise(u * 64.0f, v * 128.0f, 64, 2, 45));
    const float blend = ramp(0.0f, 0.1f, u) * ramp(1.0f, 0.9f, u);
    c = c * (0.93f + 0.10f * cloud + 0.04f * (layers - 0.5f) * blend) * (1.0f - 0.10f * pits);
    c = c * lerp(0.90f, 1.0f, ramp(0.008f, 0.03f, t.edge));
    return lerp(Vec3f{0.60f, 0.55f, 0.47f} * (0.9f + 0.2f * cloud), c, ramp(0.007f, 0.013f, t.edge));
  });
}

Texture make_coping() {
  return paint_texture(512, 512, [](float u, float v) {
    const float edge = std::min(u, 1.0f - u);
    const float cloud = fractal_noise(u * 8.0f, v * 8.0f, 8, 5, 51);
    const float speck = ramp(0.66f, 0.78f, fractal_noise(u * 64.0f, v * 64.0f, 64, 2, 52));
    Vec3f c = lerp(Vec3f{0.86f, 0.83f, 0.77f}, Vec3f{0.95f, 0.93f, 0.89f}, cloud) * (1.0f - 0.07f * speck);
    return lerp(Vec3f{0.64f, 0.60f, 0.54f}, c, ramp(0.006f, 0.014f, edge));
  });
}

Texture make_stucco() {
  return paint_texture(512, 512, [](float u, float v) {
    const float cloud = fractal_noise(u * 4.0f, v * 4.0f, 4, 4, 61),
                grain = fractal_noise(u * 96.0f, v * 96.0f, 96, 2, 62);
    const float trowel = fractal_noise(u * 10.0f, v * 24.0f, 0, 1, 63);
    const float fade = ramp(0.0f, 0.12f, std::min(std::min(u, 1.0f - u), std::min(v, 1.0f - v)));
    const float l = 0.93f + 0.08f * (cloud - 0.5f) + 0.07f * (grain - 0.5f) + 0.03f * (trowel - 0.5f) * fade;
    return Vec3f{l, l * 0.99f, l * 0.965f};
  });
}

Texture make_roof_tiles() {
  return paint_texture(512, 512, [](float u, float v) {
    const Tile t = find_tile(u * 6.0f, v * 4.0f);
    const float tone = unit_hash(t.column, t.row, 71), moss = fractal_noise(u * 12.0f, v * 12.0f, 12, 4, 72);
    Vec3f c = lerp(Vec3f{0.66f, 0.33f, 0.20f}, Vec3f{0.84f, 0.52f, 0.33f}, tone);
    c = lerp(c, Vec3f{0.58f, 0.42f, 0.30f}, 0.5f * ramp(0.5f, 0.75f, moss)) * (0.92f + 0.16f * moss);
    // Each course shades the next, and rows meet in a valley.
    c = c * lerp(0.55f, 1.0f, ramp(0.0f, 0.12f, t.y));
    return c * lerp(0.62f, 1.0f, ramp(0.0f, 0.16f, std::min(t.x, 1.0f - t.x)));
  });
}

Texture make_planks() {
  return paint_texture(512, 512, [](float u, float v) {
    const Tile t = find_tile(u, v * 8.0f);
    const float tone = unit_hash(0, t.row, 81);
    const float grain = fractal_noise(u * 4.0f, v * 96.0f + tone * 31.0f, 0, 1, 82);
    const float fibre = fractal_noise(u * 8.0f, v * 256.0f, 8, 2, 83);
    const float seam = ramp(0.0f, 0.06f, std::min(u, 1.0f - u));
    Vec3f c =
        lerp(Vec3f{0.56f, 0.38f, 0.24f}, Vec3f{0.72f, 0.53f, 0.35f}, 0.5f * tone + 0.5f * lerp(0.5f, grain, seam));
    c = c * (0.9f + 0.2f * fibre);
    return c * lerp(0.35f, 1.0f, ramp(0.02f, 0.07f, std::min(t.y, 1.0f - t.y)));
  });
}

Texture make_foliage() {
  return paint_texture(512, 512, [](float u, float v) {
    const float big = fractal_noise(u * 10.0f, v * 10.0f, 10, 3, 91),
                leaf = fractal_noise(u * 56.0f, v * 56.0f, 56, 3, 92);
    const float lit = ramp(0.32f, 0.72f, 0.35f * big + 0.65f * leaf);
    const Vec3f c = lerp(Vec3f{0.34f, 0.36f, 0.36f}, Vec3f{0.88f, 0.88f, 0.82f}, lit);
    return lerp(c, Vec3f{1.0f, 0.99f, 0.90f}, 0.7f * ramp(0.62f, 0.85f, leaf));
  });
}

Texture make_grass() {
  return paint_texture(512, 512, [](float u, float v) {
    const float patch = fractal_noise(u * 6.0f, v * 6.0f, 6, 4, 101),
                blade = fractal_noise(u * 96.0f, v * 96.0f, 96, 2, 102);
    const Vec3f c = lerp(Vec3f{0.80f, 0.84f, 0.80f}, Vec3f{1.0f, 0.98f, 0.90f}, patch);
    return c * (0.78f + 0.28f * blade);
  });
}

Texture make_beach_ball() {
  static constexpr std::array<Vec3f, 6> kGores = {Vec3f{0.90f, 0.13f, 0.14f}, Vec3f{0.97f, 0.96f, 0.93f},
                                                  Vec3f{0.98f, 0.76f, 0.12f}, Vec3f{0.97f, 0.96f, 0.93f},
                                                  Vec3f{0.08f, 0.36f, 0.78f}, Vec3f{0.97f, 0.96f, 0.93f}};
  return paint_texture(768, 256, [&](float u, float v) {
    const float x = u * 6.0f;
    const Vec3f c = kGores[static_cast<std::size_t>(std::min(5, static_cast<int>(x)))];
    if (v < 0.06f || v > 0.94f) return Vec3f{0.97f, 0.96f, 0.93f};
    const float seam = std::min(x - std::floor(x), 1.0f - (x - std::floor(x)));
    return c * lerp(0.86f, 1.0f, ramp(0.004f, 0.018f, seam));
  });
}

Texture make_ring_stripes() {
  return paint_texture(512, 64, [](float u, float v) {
    const float x = u * 8.0f, inside = x - std::floor(x);
    const bool white = (static_cast<int>(x) & 1) != 0;
    const Vec3f c = white ? Vec3f{0.97f, 0.96f, 0.93f} : Vec3f{0.93f, 0.22f, 0.20f};
    // The welded seam runs around the ring.
    const float weld = ramp(0.0f, 0.03f, std::min(v, 1.0f - v));
    return c * lerp(0.9f, 1.0f, weld) * lerp(0.94f, 1.0f, ramp(0.0f, 0.02f, std::min(inside, 1.0f - inside)));
  });
}

Texture make_awning() {
  return paint_texture(1024, 64, [](float u, float v) {
    const float x = u * 16.0f;
    const bool white = (static_cast<int>(x) & 1) != 0;
    const float weave = 0.96f + 0.06f * fractal_noise(u * 256.0f, v * 32.0f, 0, 1, 111);
    return (white ? Vec3f{0.97f, 0.95f, 0.90f} : Vec3f{0.10f, 0.47f, 0.58f}) * weave;
  });
}

Texture make_ripple_marble() {
  return paint_texture(512, 512, [](float u, float v) {
    const float bend = fractal_noise(u * 4.0f, v * 4.0f, 4, 4, 121);
    float vein = fractal_noise(u * 4.0f + 3.0f * bend, v * 4.0f, 0, 1, 122);
    vein = 1.0f - ramp(0.0f, 0.05f, std::fabs(vein - 0.5f));
    const float fade = ramp(0.0f, 0.1f, std::min(std::min(u, 1.0f - u), std::min(v, 1.0f - v)));
    const Vec3f c = lerp(Vec3f{0.88f, 0.86f, 0.83f}, Vec3f{0.97f, 0.96f, 0.94f}, bend);
    return c * (1.0f - 0.05f * vein * fade);
  });
}

}  // namespace shoal
