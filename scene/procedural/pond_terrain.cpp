// The ground of the scene `pond`: a bowl, its shore, the banks, the meadow and the hills as one sheet in rings around
// the centre.
#include <cmath>

#include "scene/procedural/pond_parts.h"
#include "scene/procedural/textures.h"

namespace shoal::pond {
namespace {

// The slope at the shore, and the height of the banks over the water.
constexpr float kBeach = 0.24f, kBank_m = 0.62f;
constexpr float kFar = 420.0f, kVergeWidth = 0.07f;

Vec2f direction_of(float x, float z) {
  const float r = std::sqrt(x * x + z * z);
  return r > 1e-6f ? Vec2f{x / r, z / r} : Vec2f{1, 0};
}

// The start of the grass as a share of the shore's distance.
float verge_share(Vec2f d) { return 1.065f + 0.09f * fractal_noise(d.x * 5.0f + 31.0f, d.y * 5.0f + 31.0f, 0, 3, 403); }

Vec3f bed_tint(float x, float z, float y) {
  const float silt = fractal_noise(x * 0.35f + 11.0f, z * 0.35f + 11.0f, 0, 4, 405);
  const Vec3f sand{0.94f, 0.86f, 0.72f}, mud{0.50f, 0.50f, 0.34f}, wet{0.62f, 0.54f, 0.44f};
  Vec3f c = mix(sand, mud, smooth_step(0.42f, 0.62f, silt) * smooth_step(-0.2f, -0.9f, y));
  // A dark line where the water wets the beach.
  return mix(c, wet, smooth_step(0.10f, 0.02f, y) * smooth_step(-0.35f, -0.02f, y));
}

constexpr Vec3f kLawn{0.205f, 0.30f, 0.075f};

Vec3f meadow_tint(float x, float z, float r) {
  const float knoll = fractal_noise(x * 0.05f + 9.0f, z * 0.05f + 9.0f, 0, 3, 407);
  const float patch = fractal_noise(x * 0.25f + 3.0f, z * 0.25f + 3.0f, 0, 3, 408);
  const Vec3f dry{0.36f, 0.36f, 0.13f}, wood{0.10f, 0.18f, 0.06f};
  Vec3f c = mix(kLawn, dry, 0.55f * smooth_step(0.50f, 0.75f, patch) * smooth_step(12.0f, 18.0f, r));
  c = mix(c, mix(dry, wood, smooth_step(0.40f, 0.55f, knoll)), smooth_step(30.0f, 80.0f, r));
  return mix(c, {0.30f, 0.44f, 0.66f}, 0.80f * smooth_step(90.0f, 400.0f, r));
}

// Rings of one sheet between two distances.
template <class Fn>
void rings(PartBuilder& b, int material, int around, int count, Fn&& distance, float uv_metres, bool meadow,
           Poles poles) {
  b.surface(
      material, around, count,
      [&](float u, float v) {
        const Vec2f d = turn(u);
        const float r = distance(d, v);
        const float x = d.x * r, z = d.y * r, y = ground_y(x, z);
        const Vec2f uv = uv_metres > 0 ? Vec2f{x / uv_metres, z / uv_metres} : Vec2f{u * 36.0f, mix(0.02f, 0.98f, v)};
        const Vec3f tint = uv_metres <= 0 ? Vec3f{1, 1, 1} : meadow ? meadow_tint(x, z, r) : bed_tint(x, z, y);
        const float step = 0.04f + 0.012f * r;
        const Vec3f normal = normalize({ground_y(x - step, z) - ground_y(x + step, z), 2.0f * step,
                                        ground_y(x, z - step) - ground_y(x, z + step)});
        return SurfacePoint{{x, y, z}, normal, uv, tint};
      },
      Normals::kGiven, poles);
}

}  // namespace

float shore_m(Vec2f d) {
  const float x = d.x / kLongX, z = d.y / kLongZ;
  const float wander = fractal_noise(d.x * 1.7f + 20.0f, d.y * 1.7f + 20.0f, 0, 3, 401);
  return (0.82f + 0.36f * wander) / std::sqrt(x * x + z * z);
}

float shore_share(float x, float z) { return std::sqrt(x * x + z * z) / shore_m(direction_of(x, z)); }

float ground_y(float x, float z) {
  const float r = std::sqrt(x * x + z * z), shore = shore_m(direction_of(x, z)), q = r / shore;
  const float bumps = fractal_noise(x * 0.6f + 50.0f, z * 0.6f + 50.0f, 0, 4, 402) - 0.5f;
  if (q < 1.0f) {
    // The beach goes on under water, then the bed falls to the middle.
    const float in = 1.0f - q * q, beach = 0.5f * kBeach * shore;
    return -(mix(beach, kDeep, smooth_step(0.0f, 0.75f, in)) * in) + 0.45f * bumps * smooth_step(0.02f, 0.4f, in);
  }
  const float out = q - 1.0f;
  const float bank = kBeach * shore * out / (1.0f + kBeach * shore * out / kBank_m);
  const float meadow = fractal_noise(x * 0.11f + 70.0f, z * 0.11f + 70.0f, 0, 4, 404) - 0.35f;
  const float ridge = fractal_noise(x * 0.012f + 40.0f, z * 0.012f + 40.0f, 0, 5, 406);
  const float far_away = smooth_step(150.0f, kFar, r);
  return bank + 0.10f * bumps * smooth_step(0.0f, 0.3f, out) + 1.3f * meadow * smooth_step(0.4f, 1.6f, out) +
         smooth_step(26.0f, 190.0f, r) * (2.0f + 34.0f * ridge * ridge) + far_away * 50.0f * ridge;
}

void terrain(PartBuilder& b, int level) {
  // A third of the quads are the bed's and the beach's, a thin belt the verge's, the rest go to the horizon.
  const int around = std::max(12, static_cast<int>(std::sqrt(static_cast<float>(level) * 3.2f)));
  const int count = std::max(4, level / around), belt = count >= 24 ? 2 : 1;
  const int bed = std::max(2, (count - belt) / 2), outer = std::max(1, count - belt - bed);
  rings(
      b, kDirt, around, bed, [](Vec2f d, float v) { return shore_m(d) * verge_share(d) * v * (1.25f - 0.25f * v); },
      2.0f, false, Poles::kV0);
  rings(
      b, kVerge, around, belt, [](Vec2f d, float v) { return shore_m(d) * (verge_share(d) + kVergeWidth * v); }, 0.0f,
      false, Poles::kOpen);
  rings(
      b, kMeadow, around, outer,
      [](Vec2f d, float v) {
        const float near = shore_m(d) * (verge_share(d) + kVergeWidth);
        return mix(near, kFar, 0.09f * v + 0.91f * v * v * v * v);
      },
      4.0f, true, Poles::kOpen);
}

}  // namespace shoal::pond
