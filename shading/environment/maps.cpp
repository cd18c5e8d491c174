// Octahedral maps of floats: resampling, halving and sampling them; and make_environment, which runs all steps.
#include <algorithm>
#include <bit>
#include <cmath>

#include "core/math.h"
#include "core/thread_pool.h"
#include "shading/environment/build.h"
#include "shading/environment/sample.h"

namespace shoal {
namespace environment_parts {

CirclePoint circle_point(std::uint64_t i, std::uint64_t n) {
  const std::uint64_t eighths = 8 * i;
  const auto octant = static_cast<unsigned>(eighths / n) & 7u;
  const std::uint64_t rest = eighths % n, turned = (octant & 1u) != 0 ? n - rest : rest;
  const double x = static_cast<double>(turned) / static_cast<double>(n) * 0.78539816339744830962;
  const double x2 = x * x;
  double sine = 0, cosine = 0;
  for (int k = 18; k >= 2; k -= 2) {
    sine = 1 - sine * x2 / static_cast<double>(k * (k + 1));
    cosine = 1 - cosine * x2 / static_cast<double>(k * (k - 1));
  }
  sine *= x;
  switch (octant) {
    case 0:
      return {cosine, sine};
    case 1:
      return {sine, cosine};
    case 2:
      return {-sine, cosine};
    case 3:
      return {-cosine, sine};
    case 4:
      return {-cosine, -sine};
    case 5:
      return {-sine, -cosine};
    case 6:
      return {sine, -cosine};
    default:
      return {cosine, -sine};
  }
}

void FloatMap::resize(int texels) {
  size = texels;
  const auto side = static_cast<std::size_t>(texels) + 2;
  rgb.assign(side * side * 3, 0.0f);
}

void wrap_border(FloatMap& map) {
  const int n = map.size;
  const auto copy = [&](int x, int y, int from_x, int from_y) {
    std::copy_n(&map.rgb[map.at(from_x, from_y)], 3, &map.rgb[map.at(x, y)]);
  };
  for (int i = 0; i < n; ++i) {
    copy(i, -1, n - 1 - i, 0), copy(i, n, n - 1 - i, n - 1);
    copy(-1, i, 0, n - 1 - i), copy(n, i, n - 1, n - 1 - i);
  }
  copy(-1, -1, n - 1, n - 1), copy(n, -1, 0, n - 1), copy(-1, n, n - 1, 0), copy(n, n, 0, 0);
}

Vec3f sample_map(const FloatMap& map, Vec3f direction) {
  const Vec2f at = environment_detail::octahedral_of(direction);
  const float half = static_cast<float>(map.size) * 0.5f;
  const float x = at.x * half + (half + 0.5f), y = at.y * half + (half + 0.5f);
  const int column = static_cast<int>(x), row = static_cast<int>(y);
  const float tx = x - static_cast<float>(column), ty = y - static_cast<float>(row);
  const float* top = &map.rgb[map.at(column - 1, row - 1)];
  const float* bottom = &map.rgb[map.at(column - 1, row)];
  float out[3];
  for (int c = 0; c < 3; ++c) {
    const float above = top[c] + (top[c + 3] - top[c]) * tx, below = bottom[c] + (bottom[c + 3] - bottom[c]) * tx;
    out[c] = above + (below - above) * ty;
  }
  return {out[0], out[1], out[2]};
}

namespace {

// Bilinear; the picture repeats horizontally, and beyond a pole the row continues on its other half.
Vec3f look_up(const EquirectImage& image, Vec3f direction) {
  const auto width = static_cast<float>(image.width), height = static_cast<float>(image.height);
  const float turn = det_atan2(direction.z, direction.x) * (0.5f / kPi) + 0.5f;
  const float ring = sqrt(direction.x * direction.x + direction.z * direction.z);
  const float fall = det_atan2(ring, direction.y) / kPi;
  const float x = turn * width - 0.5f, y = min(max(fall * height - 0.5f, -0.5f), height - 0.5f);
  const float left = floor(x), top = floor(y);
  const float tx = x - left, ty = y - top;
  const int column = static_cast<int>(left), row = static_cast<int>(top);  // -1 to width - 1, -1 to height - 1
  const auto texel = [&](int texel_x, int texel_y) {
    const bool beyond = texel_y < 0 || texel_y >= image.height;
    const int turned = (texel_x + image.width + (beyond ? image.width / 2 : 0)) % image.width;
    const int clamped = min(max(texel_y, 0), image.height - 1);
    return &image.rgb[(static_cast<std::size_t>(clamped) * static_cast<std::size_t>(image.width) +
                       static_cast<std::size_t>(turned)) *
                      3];
  };
  const float *a = texel(column, row), *b = texel(column + 1, row);
  const float *c = texel(column, row + 1), *d = texel(column + 1, row + 1);
  float out[3];
  for (int i = 0; i < 3; ++i) {
    const float above = a[i] + (b[i] - a[i]) * tx, below = c[i] + (d[i] - c[i]) * tx;
    out[i] = above + (below - above) * ty;
  }
  return {out[0], out[1], out[2]};
}

// Of any length: only the ratios of its components matter.
Vec3f direction_at(int size, float x, float y) {
  const float scale = 2.0f / static_cast<float>(size);
  return environment_detail::direction_of(Vec2f{x * scale - 1.0f, y * scale - 1.0f});
}

}  // namespace

FloatMap resample(const EquirectImage& image, int size, ThreadPool& pool) {
  FloatMap map;
  map.resize(size);
  pool.for_each(static_cast<std::size_t>(size), [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < size; ++x) {
      Vec3f sum{0, 0, 0};
      for (int k = 0; k < 4; ++k) {
        const float at_x = static_cast<float>(x) + (k % 2 != 0 ? 0.75f : 0.25f);
        const float at_y = static_cast<float>(y) + (k / 2 != 0 ? 0.75f : 0.25f);
        sum = sum + look_up(image, direction_at(size, at_x, at_y));
      }
      float* texel = &map.rgb[map.at(x, y)];
      texel[0] = sum.x * 0.25f, texel[1] = sum.y * 0.25f, texel[2] = sum.z * 0.25f;
    }
  });
  wrap_border(map);
  return map;
}

FloatMap halved(const FloatMap& map) {
  FloatMap half;
  half.resize(map.size / 2);
  // A texel of the octahedron's face at distance r has a solid angle in proportion to 1 / r^3.
  const auto weight = [&](int x, int y) {
    const Vec3f d = direction_at(map.size, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
    const float r2 = dot(d, d);
    return 1.0f / (r2 * sqrt(r2));
  };
  for (int y = 0; y < half.size; ++y) {
    for (int x = 0; x < half.size; ++x) {
      float total = 0, sum[3] = {0, 0, 0};
      for (int k = 0; k < 4; ++k) {
        const int from_x = 2 * x + k % 2, from_y = 2 * y + k / 2;
        const float w = weight(from_x, from_y);
        const float* texel = &map.rgb[map.at(from_x, from_y)];
        total += w;
        for (int c = 0; c < 3; ++c) sum[c] += texel[c] * w;
      }
      for (int c = 0; c < 3; ++c) half.rgb[half.at(x, y) + static_cast<std::size_t>(c)] = sum[c] / total;
    }
  }
  wrap_border(half);
  return half;
}

}  // namespace environment_parts

namespace {

using environment_parts::FloatMap;

// Texels a side, at most, and sample points a texel of each filtered level: the wider the lobe, the fewer texels and
// the more points.
struct LevelPlan {
  int size, samples;
};
constexpr LevelPlan kPlans[kEnvironmentLevels] = {{kMaxEnvironmentSize, 0},
                                                  {256, 256},
                                                  {128, 512},
                                                  {64, 1024},
                                                  {64, 1024},
                                                  {64, 1024},
                                                  {64, 1024},
                                                  {64, 1024},
                                                  {64, 1024}};

int level_0_size(int height) {
  const auto texels = std::bit_ceil(static_cast<unsigned>(std::min(height, kMaxEnvironmentSize)) * 2u);
  return std::clamp(static_cast<int>(texels), 64, kMaxEnvironmentSize);
}

// The largest power of two not above the brightest channel; 0 for black.
float unit_of(const std::vector<FloatMap>& levels) {
  float most = 0;
  for (const FloatMap& map : levels) {
    for (const float v : map.rgb) most = v > most ? v : most;
  }
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(most) & 0xFF800000u);
}

// Rounds to nearest; 0 below 2^-31.
std::uint32_t encode(float value, float unit) {
  const float v = value / unit;
  if (!(v >= environment_detail::kCodeZero)) return 0;
  const auto rounded = static_cast<std::int32_t>((std::bit_cast<std::uint32_t>(v) + 0x800u) >> 12);
  return static_cast<std::uint32_t>(std::clamp(rounded - (environment_detail::kCodeExponent >> 12), 0, 0xFFFF));
}

void store_level(Environment& e, std::size_t level, const FloatMap& map) {
  const std::size_t count = map.rgb.size() / 3;
  e.size[level] = map.size;
  e.first_texel[level] = static_cast<std::int32_t>(e.texels.size() / 2);
  const std::size_t first = e.texels.size();
  e.texels.resize(first + 2 * count);
  if (e.scale == 0) return;
  for (std::size_t i = 0; i < count; ++i) {
    const float* v = &map.rgb[3 * i];
    e.texels[first + 2 * i] = encode(v[0], e.scale) | encode(v[1], e.scale) << 16;
    e.texels[first + 2 * i + 1] = encode(v[2], e.scale);
  }
}

}  // namespace

Environment make_environment(const EquirectImage& image, ThreadPool& pool) {
  using namespace environment_parts;
  // 1 The picture and its halves
  std::vector<FloatMap> mips;
  mips.push_back(resample(image, level_0_size(image.height), pool));
  while (mips.back().size > 4) mips.push_back(halved(mips.back()));

  // 2 Levels of roughness
  std::vector<FloatMap> levels(kEnvironmentLevels);
  for (std::size_t k = 1; k < levels.size(); ++k) {
    const double roughness = static_cast<double>(k) / (kEnvironmentLevels - 1);
    levels[k] = filter_by_roughness(mips, roughness, std::min(kPlans[k].size, mips[0].size), kPlans[k].samples, pool);
  }
  levels[0] = std::move(mips[0]);

  // 3 Packed
  Environment e;
  e.scale = unit_of(levels);
  for (std::size_t k = 0; k < 16; ++k) {
    if (k < levels.size()) {
      store_level(e, k, levels[k]);
    } else {
      e.size[k] = e.size[levels.size() - 1];
      e.first_texel[k] = e.first_texel[levels.size() - 1];
    }
  }

  // 4 Diffuse, and the lobe's table
  const std::array<Vec3f, 9> harmonics = irradiance_harmonics(image, pool);
  std::copy(harmonics.begin(), harmonics.end(), e.irradiance);
  e.lobe = lobe_table(pool);
  return e;
}

}  // namespace shoal
