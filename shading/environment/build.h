// From an equirectangular picture to an Environment.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "shading/environment/environment.h"

namespace shoal {

class ThreadPool;

// A picture of all directions: rows from +y down to -y; its centre column is +x, its right edge (which is its left
// edge) -x, and +z is a quarter of the width right of the centre. three.js, the Khronos Sample Viewer and Blender use
// the same orientation.
struct EquirectImage {
  int width = 0, height = 0;
  std::vector<float> rgb;  // width x height x 3, linear radiance, finite and not negative
};

// Part of the key of caches: must be raised with every change of the result of make_environment for the same picture.
inline constexpr std::uint32_t kEnvironmentVersion = 1;

// Resamples the picture to octahedral maps, filters them by roughness, and integrates it for diffuse light.
//   image  at least 1 x 1; rgb not negative and at most 1e9
//   pool   its threads share the work
// Level 0 has a power of two of at least twice the picture's height in texels a side, 64 to kMaxEnvironmentSize. The
// result depends on the picture alone: + - * / sqrt in a fixed order for any threads.
// Source: see the parts below.
Environment make_environment(const EquirectImage& image, ThreadPool& pool);

namespace environment_parts {

// Cosine and sine of 2 pi i / n, i <= n, within 1e-15: reduced in integers, then Taylor's series to x^17.
struct CirclePoint {
  double cosine, sine;
};
CirclePoint circle_point(std::uint64_t i, std::uint64_t n);

// An octahedral map of floats while it is built: (size + 2)^2 texels of three, border included.
struct FloatMap {
  int size = 0;
  std::vector<float> rgb;

  void resize(int texels);
  std::size_t at(int x, int y) const {  // from -1 to size
    return (static_cast<std::size_t>(y + 1) * static_cast<std::size_t>(size + 2) + static_cast<std::size_t>(x + 1)) * 3;
  }
};
// Fills the border with the texels across the edges.
void wrap_border(FloatMap& map);
Vec3f sample_map(const FloatMap& map, Vec3f direction);

// The picture, bilinear, averaged over 2 x 2 points a texel. shading/environment/maps.cpp
FloatMap resample(const EquirectImage& image, int size, ThreadPool& pool);
// Half the size: 2 x 2 texels weighted by their solid angles.
FloatMap halved(const FloatMap& map);

// Irradiance over pi: the picture's first nine spherical harmonics, each texel integrated exactly as a constant.
// Source: Ramamoorthi and Hanrahan 2001, eq. 3 and 8. shading/environment/irradiance.cpp
std::array<Vec3f, 9> irradiance_harmonics(const EquirectImage& image, ThreadPool& pool);

// The environment filtered by a GGX lobe, by importance sampling: Hammersley points, each sampled in the mip whose
// texels have the point's solid angle.
//   mips  level 0 and its halves, in order
// Source: Karis 2013 (n = v = r); Krivanek and Colbert 2008, "Real-time Shading with Filtered Importance Sampling".
// shading/environment/filter.cpp
FloatMap filter_by_roughness(const std::vector<FloatMap>& mips, double roughness, int size, int samples,
                             ThreadPool& pool);

// The directional albedo of GGX with the height-correlated Smith term, for a reflectance of 1 and, by Schlick, of 0.
//   cosine  to the view, more than 0
// Source: Heitz 2018, "Sampling the GGX Distribution of Visible Normals". shading/environment/lobe.cpp
struct LobeShare {
  double white, grazing;
};
LobeShare lobe_share(double roughness, double cosine);
// The table of Environment::lobe.
std::vector<std::uint32_t> lobe_table(ThreadPool& pool);

}  // namespace environment_parts

}  // namespace shoal
