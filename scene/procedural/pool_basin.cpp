// The basin of the scene `pool`: floor with lanes, walls with a frieze, steps, coping, and the deck around it.
#include <array>
#include <cmath>

#include "scene/procedural/pool_parts.h"

namespace shoal::pool {
namespace {

// A side of the basin: the direction along its wall (to the right, seen from the water) and the outward direction.
struct Side {
  Vec3f along, out;
  float half_along, half_out;
};
constexpr std::array<Side, 4> kSides = {
    Side{{1, 0, 0}, {0, 0, -1}, kHalfX, kHalfZ}, Side{{-1, 0, 0}, {0, 0, 1}, kHalfX, kHalfZ},
    Side{{0, 0, -1}, {-1, 0, 0}, kHalfZ, kHalfX}, Side{{0, 0, 1}, {1, 0, 0}, kHalfZ, kHalfX}};

int segments(float from, float to, float step) {
  return std::max(1, static_cast<int>(std::floor((to - from) / step + 0.5f)));
}

// Divides the cells between lines into steps of about `step`. Neighbouring cells share the vertices of their border, so
// that no crack opens.
//   cell  void(float x0, float x1, int nx, float y0, float y1, int ny, size_t i, size_t j)
template <std::size_t kX, std::size_t kY, class Fn>
void for_each_cell(const std::array<float, kX>& xs, const std::array<float, kY>& ys, float step, Fn&& cell) {
  for (std::size_t j = 0; j + 1 < kY; ++j) {
    for (std::size_t i = 0; i + 1 < kX; ++i) {
      cell(xs[i], xs[i + 1], segments(xs[i], xs[i + 1], step), ys[j], ys[j + 1], segments(ys[j], ys[j + 1], step), i,
           j);
    }
  }
}

// Rounds to 1/4096 m, so that floor and walls have the same corners from whichever end they count.
float snap(float x) { return std::floor(x * 4096.0f + 0.5f) / 4096.0f; }

// Darkening near a crease, by the distance to it and its range in metres.
float crease(float distance, float reach, float depth) {
  const float d = std::max(0.0f, distance) / reach;
  return 1.0f - depth / (1.0f + 4.0f * d * d + 2.0f * d);
}

Vec3f basin_shade(float x, float y, float z) {
  const float to_floor = y - floor_y(x);
  const float s = crease(kHalfX - std::fabs(x), 0.5f, 0.28f) * crease(kHalfZ - std::fabs(z), 0.5f, 0.28f);
  return Vec3f{0.97f, 1.0f, 1.0f} * (s * (0.94f + 0.06f * clamp01(1.0f - to_floor)));
}

Vec3f floor_shade(float x, float z) {
  Vec3f c = basin_shade(x, floor_y(x), z);
  // Objects on the floor, and the foot of the steps.
  const float spots[3][3] = {{0.85f, 0.95f, 0.22f}, {-0.35f, -1.0f, 0.42f}, {2.6f, -0.55f, 0.2f}};
  for (const auto& s : spots) {
    const float dx = x - s[0], dz = z - s[1];
    c = c * (1.0f - 0.42f * smooth_step(1.7f, 0.3f, std::sqrt(dx * dx + dz * dz) / s[2]));
  }
  const float dx = x + kHalfX, from_steps = std::sqrt(dx * dx + z * z) - 1.8f;
  return c * crease(from_steps, 0.4f, 0.25f);
}

Vec3f wall_shade(float x, float y, float z) {
  return Vec3f{0.97f, 1.0f, 1.0f} *
         (crease(y - floor_y(x), 0.5f, 0.28f) * crease(0.02f + kDeckY - y, 0.12f, 0.25f) *
          crease(std::fabs(x) > kHalfX - 1e-3f ? kHalfZ - std::fabs(z) : kHalfX - std::fabs(x), 0.45f, 0.25f));
}

void basin_floor(PartBuilder& b, float step, bool lanes) {
  const auto cell = [&](float x0, float x1, int nx, float z0, float z1, int nz, int material) {
    b.surface(material, nx, nz, [&](float u, float v) {
      // v runs towards -z, so that the front is up.
      const float x = snap(mix(x0, x1, u)), z = snap(mix(z1, z0, v));
      const Vec3f n = normalize({(kDeep - kShallow) / (2 * kHalfX), 1, 0});
      return SurfacePoint{{x, floor_y(x), z}, n, {x / 1.6f, z / 1.6f}, floor_shade(x, z)};
    });
  };
  if (!lanes) {
    cell(-kHalfX, kHalfX, segments(0, 2 * kHalfX, step), -kHalfZ, kHalfZ, segments(0, 2 * kHalfZ, step), kTiles);
    return;
  }
  // Two lanes with a bar across the deep end of each, on the tiles' lattice of 0.1 m.
  constexpr std::array<float, 5> xs = {-kHalfX, -2.4f, 3.6f, 3.9f, kHalfX};
  constexpr std::array<float, 10> zs = {-kHalfZ, -1.7f, -1.3f, -1.0f, -0.6f, 0.6f, 1.0f, 1.3f, 1.7f, kHalfZ};
  for_each_cell(xs, zs, step,
                [&](float x0, float x1, int nx, float z0, float z1, int nz, std::size_t i, std::size_t j) {
                  const bool line = (i == 1 || i == 2) && (j == 2 || j == 6);
                  const bool bar = i == 2 && ((j >= 1 && j <= 3) || (j >= 5 && j <= 7));
                  cell(x0, x1, nx, z0, z1, nz, line || bar ? kLane : kTiles);
                });
}

void basin_walls(PartBuilder& b, float step, bool lanes) {
  for (const Side& side : kSides) {
    const bool is_long = side.half_along == kHalfX;
    // The same lines as the floor's, so that its border and theirs have the same vertices.
    std::vector<float> lines = {-side.half_along, side.half_along};
    if (lanes && is_long) lines = {-kHalfX, -2.4f, 3.6f, 3.9f, kHalfX};
    if (lanes && !is_long) lines = {-kHalfZ, -1.7f, -1.3f, -1.0f, -0.6f, 0.6f, 1.0f, 1.3f, 1.7f, kHalfZ};
    const bool mirrored = side.along.x < 0 || side.along.z < 0;
    for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
      // Lines are world coordinates; a wall that runs backwards takes them from the far end.
      const float w0 = mirrored ? lines[i + 1] : lines[i], w1 = mirrored ? lines[i] : lines[i + 1];
      const int n = segments(lines[i], lines[i + 1], step);
      const auto place = [&](float u, float y_share, bool band) {
        const float w = snap(mix(w0, w1, u));
        const Vec3f axis = is_long ? Vec3f{1, 0, 0} : Vec3f{0, 0, 1};
        const Vec3f p = axis * w + side.out * side.half_out;
        const float y = band ? mix(kBandBottom, kDeckY, y_share) : mix(floor_y(p.x), kBandBottom, y_share);
        const Vec2f uv = band ? Vec2f{w / 0.5f, (kDeckY - y) / 0.25f} : Vec2f{w / 1.6f, -y / 1.6f};
        return SurfacePoint{{p.x, y, p.z}, -side.out, uv, wall_shade(p.x, y, p.z)};
      };
      b.surface(kTiles, n, segments(0, 1.7f, step), [&](float u, float v) { return place(u, v, false); });
      b.surface(kBand, n, segments(0, 0.25f, step), [&](float u, float v) { return place(u, v, true); });
    }
  }
}

}  // namespace

void basin(PartBuilder& b, int level) {
  const bool lanes = level > 4;
  const float step = lanes ? 4.0f / static_cast<float>(level - 4) : 10.0f / static_cast<float>(level);
  basin_floor(b, step, lanes);
  basin_walls(b, step, lanes);
}

void steps(PartBuilder& b, int level) {
  // Half discs against the shallow wall, a navy nosing on each.
  constexpr int kSteps = 4;
  const int around = 2 * level, across = std::max(1, level / 3);
  const float nosing = level >= 3 ? 0.06f : 0.0f;
  for (int i = 0; i < kSteps; ++i) {
    const float outer = 0.75f + 0.35f * static_cast<float>(i), inner = i == 0 ? 0.0f : outer - 0.35f;
    const float top = -0.22f - 0.26f * static_cast<float>(i);
    const float bottom = i + 1 < kSteps ? top - 0.26f : floor_y(-kHalfX + outer) - 0.02f;
    const auto at = [&](float u, float radius, float y) {
      const Vec2f c = turn(0.5f * u - 0.25f);
      // The turn's cosine at a quarter is not exactly zero: never behind the wall.
      return Vec3f{-kHalfX + radius * std::max(0.0f, c.x), y, radius * c.y};
    };
    const auto tread = [&](int material, int n, float r0, float r1, bool pole) {
      b.surface(
          material, around, n,
          [&](float u, float v) {
            const float r = mix(r0, r1, v);
            const Vec3f p = at(u, r, top);
            const float shade = crease(r - inner, 0.15f, i == 0 ? 0.0f : 0.25f) * crease(p.x + kHalfX, 0.3f, 0.2f);
            return SurfacePoint{p, {0, 1, 0}, {p.x / 1.6f, p.z / 1.6f}, Vec3f{1, 1, 1} * shade};
          },
          Normals::kGiven, pole ? Poles::kV0 : Poles::kOpen);
    };
    tread(kTiles, across, inner, outer - nosing, i == 0);
    if (nosing > 0) tread(kLane, 1, outer - nosing, outer, false);
    b.surface(kTiles, around, std::max(1, across / 2), [&](float u, float v) {
      const Vec3f p = at(u, outer, mix(top, bottom, v));
      const Vec2f c = turn(0.5f * u - 0.25f);
      const float shade = crease(p.y - bottom, 0.15f, 0.3f);
      return SurfacePoint{p, {c.x, 0, c.y}, {u * 3.1415927f * outer / 1.6f, -p.y / 1.6f}, Vec3f{1, 1, 1} * shade};
    });
  }
}

void coping(PartBuilder& b, int level) {
  constexpr float kNose = 0.03f, kOver = 0.04f;
  const int along = level, nose = std::max(2, level / 2);
  for (const Side& side : kSides) {
    // A point of the profile: d outward from the wall, mitred at the corners.
    const auto at = [&](float u, float d, float y, Vec3f n, float v_metres) {
      const float w = mix(-(side.half_along + d), side.half_along + d, u);
      Vec3f p = side.along * w + side.out * (side.half_out + d);
      p.y = y;
      return SurfacePoint{p, n, {w / 0.6f, v_metres / 0.6f}};
    };
    b.surface(kCoping, along, nose, [&](float u, float v) {
      const Vec2f c = turn(0.5f * v + 0.75f);  // from straight down, over the front, to straight up
      const float y = kCopingTop - kNose + kNose * c.y;
      const Vec3f n = side.out * -c.x + Vec3f{0, c.y, 0};
      return at(u, -kOver - kNose * c.x, y, n, -0.1f * (1.0f - v));
    });
    b.surface(kCoping, along, std::max(1, level / 8), [&](float u, float v) {
      return at(u, mix(-kOver, kCopingOut, v), kCopingTop, {0, 1, 0}, 0.4f * v);
    });
    if (level < 2) continue;
    b.surface(kCoping, along, 1, [&](float u, float v) {
      return at(u, mix(0.0f, -kOver, v), kCopingTop - 2 * kNose, {0, -1, 0}, 0.04f * v);
    });
    b.surface(kCoping, along, 1, [&](float u, float v) {
      return at(u, kCopingOut, mix(kCopingTop, kDeckY, v), side.out, 0.4f + 0.02f * v);
    });
  }
}

// A soft shade on the deck below an object: centre, half size, width of the soft edge, strength.
struct Blob {
  float x, z, half_x, half_z, soft, depth;
};
constexpr Blob kBlobs[] = {{-3.4f, -4.3f, 0.30f, 0.90f, 0.25f, 0.55f}, {-2.0f, -4.3f, 0.30f, 0.90f, 0.25f, 0.55f},
                           {2.0f, -4.3f, 0.30f, 0.90f, 0.25f, 0.55f},  {3.4f, -4.3f, 0.30f, 0.90f, 0.25f, 0.55f},
                           {-2.7f, -4.4f, 0.2f, 0.2f, 1.6f, 0.30f},    {2.7f, -4.4f, 0.2f, 0.2f, 1.6f, 0.30f},
                           {-6.3f, -3.6f, 0.12f, 0.12f, 0.35f, 0.5f},  {6.3f, -3.6f, 0.12f, 0.12f, 0.35f, 0.5f},
                           {-6.3f, 3.6f, 0.12f, 0.12f, 0.35f, 0.5f},   {6.3f, 3.6f, 0.12f, 0.12f, 0.35f, 0.5f},
                           {0.0f, -5.2f, 0.12f, 0.12f, 0.35f, 0.5f},   {-3.1f, 3.5f, 0.03f, 0.03f, 0.25f, 0.55f}};

void deck(PartBuilder& b, int level) {
  constexpr std::array<float, 4> xs = {-kDeckX, -kHalfX - kCopingOut, kHalfX + kCopingOut, kDeckX};
  constexpr std::array<float, 4> zs = {kDeckBack, -kHalfZ - kCopingOut, kHalfZ + kCopingOut, kDeckFront};
  const auto shade = [](float x, float z) {
    float s = 1;
    for (const Blob& k : kBlobs) {
      const float dx = std::max(0.0f, std::fabs(x - k.x) - k.half_x),
                  dz = std::max(0.0f, std::fabs(z - k.z) - k.half_z);
      s *= 1.0f - k.depth * smooth_step(k.soft, 0.0f, std::sqrt(dx * dx + dz * dz));
    }
    // The gallery behind the columns, and the foot of the garden walls.
    s *= mix(0.48f, 1.0f, smooth_step(kArcadeBack - 0.5f, kArcadeFront + 0.35f, z));
    return s * crease(kDeckX - std::fabs(x), 0.35f, 0.35f);
  };
  const float step = 16.0f / static_cast<float>(level);
  for_each_cell(xs, zs, step,
                [&](float x0, float x1, int nx, float z0, float z1, int nz, std::size_t i, std::size_t j) {
                  if (i == 1 && j == 1) return;
                  b.surface(kPavers, nx, nz, [&](float u, float v) {
                    const float x = mix(x0, x1, u), z = mix(z1, z0, v);
                    return SurfacePoint{{x, kDeckY, z}, {0, 1, 0}, {x / 2.4f, z / 2.4f}, Vec3f{1, 1, 1} * shade(x, z)};
                  });
                });
  if (level < 4) return;
  b.quad(kCoping, 1, 1, {-kDeckX, kDeckY - 0.3f, kDeckFront}, {2 * kDeckX, 0, 0}, {0, 0.3f, 0}, 0.6f);
}

}  // namespace shoal::pool
