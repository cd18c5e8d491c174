// The environment filtered by GGX lobes.
#include <algorithm>
#include <cmath>

#include "core/math.h"
#include "core/thread_pool.h"
#include "shading/environment/build.h"
#include "shading/environment/sample.h"

namespace shoal::environment_parts {
namespace {

// One light direction of the lobe round +z, and the mip that it is sampled in.
struct LobeSample {
  Vec3f direction;
  float weight;  // its cosine
  std::size_t mip;
};

// 2^-32 times the bits of i in reverse.
double radical_inverse(std::uint32_t i) {
  std::uint32_t bits = i;
  bits = (bits << 16) | (bits >> 16);
  bits = ((bits & 0x00FF00FFu) << 8) | ((bits >> 8) & 0x00FF00FFu);
  bits = ((bits & 0x0F0F0F0Fu) << 4) | ((bits >> 4) & 0x0F0F0F0Fu);
  bits = ((bits & 0x33333333u) << 2) | ((bits >> 2) & 0x33333333u);
  bits = ((bits & 0x55555555u) << 1) | ((bits >> 1) & 0x55555555u);
  return static_cast<double>(bits) * 0x1p-32;
}

std::vector<LobeSample> lobe_samples(double roughness, int count, int map_size, std::size_t mip_count) {
  const double alpha = roughness * roughness, alpha2 = alpha * alpha;
  const double texels = static_cast<double>(map_size) * static_cast<double>(map_size);
  std::vector<LobeSample> samples;
  for (int i = 0; i < count; ++i) {
    // The half vector is distributed by GGX times its cosine.
    const double u = radical_inverse(static_cast<std::uint32_t>(i)) + 0x1p-33;
    const double cosine2 = (1 - u) / (1 + (alpha2 - 1) * u);
    const double cosine = std::sqrt(cosine2), sine = std::sqrt(1 - cosine2);
    const CirclePoint turn = circle_point(2 * static_cast<std::uint64_t>(i) + 1, 2 * static_cast<std::uint64_t>(count));
    const double z = 2 * cosine2 - 1;
    if (!(z > 0)) continue;
    // The solid angle of the light direction, 4 / (count D), in texels of level 0, which have 4 pi / texels each; one
    // mip more, so that neighbouring samples overlap.
    const double spread = 1 + (alpha2 - 1) * cosine2;
    const double texels_covered = spread * spread / (alpha2 * static_cast<double>(count)) * texels;
    const float level = 0.5f * det_log2(static_cast<float>(texels_covered)) + 1.0f;
    const int last = static_cast<int>(mip_count) - 1;
    const auto mip = static_cast<std::size_t>(std::clamp(static_cast<int>(floor(level + 0.5f)), 0, last));
    samples.push_back({{static_cast<float>(2 * cosine * sine * turn.cosine),
                        static_cast<float>(2 * cosine * sine * turn.sine), static_cast<float>(z)},
                       static_cast<float>(z),
                       mip});
  }
  return samples;
}

}  // namespace

FloatMap filter_by_roughness(const std::vector<FloatMap>& mips, double roughness, int size, int samples,
                             ThreadPool& pool) {
  const std::vector<LobeSample> lobe = lobe_samples(roughness, samples, mips[0].size, mips.size());
  float total = 0;
  for (const LobeSample& s : lobe) total += s.weight;
  FloatMap map;
  map.resize(size);
  pool.for_each(static_cast<std::size_t>(size), [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    const float scale = 2.0f / static_cast<float>(size);
    for (int x = 0; x < size; ++x) {
      const Vec3f n = normalize(environment_detail::direction_of(
          Vec2f{(static_cast<float>(x) + 0.5f) * scale - 1.0f, (static_cast<float>(y) + 0.5f) * scale - 1.0f}));
      const Vec3f across = normalize(cross(abs(n.y) < 0.9f ? Vec3f{0, 1, 0} : Vec3f{1, 0, 0}, n));
      const Vec3f along = cross(n, across);
      Vec3f sum{0, 0, 0};
      for (const LobeSample& s : lobe) {
        const Vec3f l = across * s.direction.x + along * s.direction.y + n * s.direction.z;
        sum = sum + sample_map(mips[s.mip], l) * s.weight;
      }
      float* texel = &map.rgb[map.at(x, y)];
      texel[0] = sum.x / total, texel[1] = sum.y / total, texel[2] = sum.z / total;
    }
  });
  wrap_border(map);
  return map;
}

}  // namespace shoal::environment_parts
