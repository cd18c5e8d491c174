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

}  // namespace shoal
