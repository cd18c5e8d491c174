// Textures of `ball`, `tank` and `pond`.
#include <array>

#include "scene/procedural/texture_paint.h"
#include "scene/procedural/textures.h"

namespace shoal {
using namespace paint;

Texture make_checker() {
  return paint_texture(512, 512, [](float u, float v) {
    const Tile t = find_tile(u * 4.0f, v * 4.0f);
    const float cloud = fractal_noise(u * 12.0f, v * 12.0f, 12, 4, 131), tone = unit_hash(t.column, t.row, 132);
    const Vec3f c = ((t.column + t.row) & 1) != 0 ? Vec3f{0.90f, 0.88f, 0.82f} : Vec3f{0.33f, 0.45f, 0.55f};
    const Vec3f stone = c * (0.92f + 0.10f * cloud + 0.05f * tone);
    return lerp(Vec3f{0.62f, 0.63f, 0.62f}, stone, ramp(0.008f, 0.02f, t.edge));
  });
}

namespace {

// Finds the nearest pebble of a lattice; each cell has a pebble with a centre, a size and a tone. Returns the distance
// to its rim (below 0: between pebbles) and its tone.
struct Pebble {
  float inside, tone;
};
Pebble find_pebble(float x, float y, int period, std::uint32_t seed) {
  Pebble best{-1.0f, 0.0f};
  const int cx = static_cast<int>(std::floor(x)), cy = static_cast<int>(std::floor(y));
  for (int j = cy - 1; j <= cy + 1; ++j) {
    for (int i = cx - 1; i <= cx + 1; ++i) {
      // One hash gives five numbers of six bits.
      const std::uint32_t h = hash_lattice(((i % period) + period) % period, ((j % period) + period) % period, seed);
      const auto random = [h](int which) { return static_cast<float>((h >> (6 * which)) & 63u) * (1.0f / 64.0f); };
      const float dx = x - (static_cast<float>(i) + 0.25f + 0.5f * random(0));
      const float dy = y - (static_cast<float>(j) + 0.25f + 0.5f * random(1));
      const float radius = 0.38f + 0.30f * random(2), stretch = 0.75f + 0.5f * random(3);
      const float inside = 1.0f - std::sqrt(dx * dx * stretch + dy * dy / stretch) / radius;
      if (inside > best.inside) best = {inside, random(4)};
    }
  }
  return best;
}

Vec3f pebbles(float u, float v, int across, std::uint32_t seed, Vec3f ground) {
  const float fa = static_cast<float>(across);
  const Pebble p = find_pebble(u * fa, v * fa, across, seed);
  const float grain = fractal_noise(u * fa * 4.0f, v * fa * 4.0f, 4 * across, 2, seed + 9);
  Vec3f c = lerp(Vec3f{0.52f, 0.44f, 0.34f}, Vec3f{0.86f, 0.80f, 0.70f}, p.tone);
  if (p.tone > 0.55f && p.tone < 0.70f) c = {0.50f, 0.52f, 0.54f};
  c = c * (0.72f + 0.30f * ramp(0.0f, 0.5f, p.inside)) * (0.90f + 0.2f * grain);
  return lerp(ground * (0.75f + 0.4f * grain), c, ramp(0.0f, 0.10f, p.inside));
}

}  // namespace

Texture make_gravel() {
  return paint_texture(512, 512, [](float u, float v) { return pebbles(u, v, 24, 141, {0.42f, 0.36f, 0.28f}); });
}

Texture make_rock() {
  return paint_texture(512, 512, [](float u, float v) {
    const float big = fractal_noise(u * 5.0f, v * 5.0f, 5, 5, 151),
                grain = fractal_noise(u * 64.0f, v * 64.0f, 64, 3, 152);
    const float crack = std::fabs(fractal_noise(u * 6.0f, v * 6.0f, 6, 4, 153) - 0.5f);
    const float lichen = ramp(0.60f, 0.72f, fractal_noise(u * 9.0f, v * 9.0f, 9, 4, 154));
    Vec3f c = lerp(Vec3f{0.44f, 0.43f, 0.41f}, Vec3f{0.70f, 0.68f, 0.63f}, big) * (0.82f + 0.36f * grain);
    c = lerp(c, Vec3f{0.56f, 0.57f, 0.40f} * (0.8f + 0.4f * grain), 0.55f * lichen);
    return c * lerp(0.72f, 1.0f, ramp(0.0f, 0.035f, crack));
  });
}

Texture make_fish_bands() {
  // v: 1 - (share of the length from the tail).
  return paint_texture(64, 512, [](float u, float v) {
    const float along = v, wave = 0.012f * (fractal_noise(u * 8.0f, 0.5f, 8, 2, 161) - 0.5f);
    const float bands[3][2] = {{0.10f, 0.030f}, {0.44f, 0.055f}, {0.75f, 0.042f}};
    Vec3f c =
        lerp(Vec3f{0.95f, 0.40f, 0.05f}, Vec3f{0.98f, 0.55f, 0.10f}, fractal_noise(u * 8.0f, v * 24.0f, 0, 2, 162));
    for (const auto& band : bands) {
      const float d = std::fabs(along - band[0] + wave) - band[1];
      c = lerp(Vec3f{0.06f, 0.05f, 0.05f}, c, ramp(0.010f, 0.018f, d));
      c = lerp(Vec3f{0.96f, 0.96f, 0.94f}, c, ramp(-0.004f, 0.004f, d));
    }
    return c;
  });
}

Texture make_fish_flank() {
  return paint_texture(128, 512, [](float u, float v) {
    // A dark sweep over both flanks, from the head along the back; u = 0.25 is the back.
    const float up =
        0.5f + 0.5f * (1.0f - 4.0f * std::fabs(std::fabs(u - 0.25f) < 0.5f ? std::fabs(u - 0.25f) - 0.25f
                                                                           : 0.75f - std::fabs(u - 0.25f)));
    const float scales = fractal_noise(u * 32.0f, v * 64.0f, 0, 2, 171);
    Vec3f c = lerp(Vec3f{0.08f, 0.20f, 0.62f}, Vec3f{0.12f, 0.36f, 0.86f}, scales);
    const float sweep = ramp(0.10f, 0.25f, v) * ramp(0.92f, 0.78f, v) * ramp(0.30f, 0.10f, std::fabs(up - 0.45f));
    return lerp(c, Vec3f{0.03f, 0.04f, 0.10f}, sweep);
  });
}

namespace {

Vec3f dirt_at(float u, float v) {
  const float cloud = fractal_noise(u * 6.0f, v * 6.0f, 6, 5, 181),
              grain = fractal_noise(u * 96.0f, v * 96.0f, 96, 2, 182);
  Vec3f ground = lerp(Vec3f{0.56f, 0.46f, 0.34f}, Vec3f{0.70f, 0.60f, 0.46f}, cloud) * (0.84f + 0.3f * grain);
  // Pebbles in drifts.
  const float drift = ramp(0.45f, 0.62f, fractal_noise(u * 5.0f, v * 5.0f, 5, 3, 183));
  return lerp(ground, pebbles(u, v, 36, 184, ground), 0.35f + 0.65f * drift);
}

// An earthenware pot: glaze over belly and shoulder, a band with a zigzag, bare clay at the foot and inside.
Texture make_glaze(Vec3f dark, Vec3f light, std::uint32_t seed) {
  return paint_texture(256, 512, [=](float u, float v) {
    const float run = fractal_noise(u * 8.0f, v * 4.0f, 8, 3, seed),
                fleck = fractal_noise(u * 48.0f, v * 96.0f, 48, 2, seed + 1);
    const Vec3f clay = lerp(Vec3f{0.62f, 0.40f, 0.28f}, Vec3f{0.74f, 0.52f, 0.38f}, fleck);
    const Vec3f cream = Vec3f{0.93f, 0.88f, 0.76f} * (0.92f + 0.12f * fleck);
    Vec3f c = lerp(dark, light, 0.25f + 0.75f * run) * (0.92f + 0.16f * fleck);
    const float teeth = std::fabs(2.0f * (u * 12.0f - std::floor(u * 12.0f)) - 1.0f);
    const float band = std::fabs(v - 0.36f);
    if (band < 0.062f) c = lerp(cream, c, ramp(0.016f, 0.022f, std::fabs(v - 0.36f - 0.05f * (teeth - 0.5f))));
    if (band > 0.056f && band < 0.068f) c = cream;
    if (v > 0.655f && v < 0.74f) c = cream;
    c = lerp(clay, c, ramp(0.10f, 0.115f, v + 0.03f * (run - 0.5f)));
    return lerp(c, clay * 0.8f, ramp(0.755f, 0.765f, v));
  });
}

}  // namespace

Texture make_dirt() {
  return paint_texture(1024, 1024, [](float u, float v) { return dirt_at(u, v); });
}

Texture make_verge() {
  return paint_texture(1024, 256, [](float u, float v) {
    // Grass has the meadow's tint, bare ground that of the beach.
    const float patch = fractal_noise(u * 6.0f, v * 3.0f, 6, 4, 191),
                blade = fractal_noise(u * 128.0f, v * 48.0f, 128, 2, 192);
    const Vec3f turf =
        lerp(Vec3f{0.392f, 0.485f, 0.247f}, Vec3f{0.49f, 0.565f, 0.277f}, patch) * (0.78f + 0.28f * blade);
    const Vec3f ground = dirt_at(u, v * 0.4f) * Vec3f{0.965f, 0.93f, 0.865f};
    const float ragged = v + 0.55f * (fractal_noise(u * 10.0f, v * 4.0f, 10, 4, 193) - 0.5f) + 0.35f * (blade - 0.5f);
    const float cover = ramp(0.42f, 0.56f, lerp(ragged, v, ramp(0.35f, 0.5f, std::fabs(v - 0.5f))));
    return lerp(ground, turf, cover);
  });
}

Texture make_blue_glaze() { return make_glaze({0.07f, 0.16f, 0.46f}, {0.16f, 0.38f, 0.78f}, 201); }
Texture make_green_glaze() { return make_glaze({0.06f, 0.30f, 0.16f}, {0.26f, 0.60f, 0.30f}, 211); }

}  // namespace shoal
