// Light from all directions as plain data: built by shading/environment/build.h, sampled by
// shading/environment/sample.h.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace shoal {

// Level k is the environment filtered by a GGX lobe of roughness k / (kEnvironmentLevels - 1); level 0 is the picture.
inline constexpr int kEnvironmentLevels = 9;
inline constexpr int kMaxEnvironmentSize = 2048;  // texels a side, of level 0
// The lobe's table: roughness down, square root of the cosine to the view along, both from 0 to 1.
inline constexpr int kLobeTableSize = 32;

// Octahedral maps of the whole sphere, one a level, and the tables of diffuse and specular reflection.
//
// The octahedron |x| + |y| + |z| = 1 is projected along y, its lower half folded out over the corners: a direction
// becomes a texel by one division, and bilinear filtering has no seam, for every level has a border of one texel, which
// repeats the texels across the edge. A texel is two words, R | G << 16 and B: each channel a float of 5 bits of
// exponent and 11 of mantissa, in units of `scale`. Error: 2^-11 of a channel, and 2^-31 of the brightest; along the
// octahedron's creases, the planes x = 0, y = 0 and z = 0, the picture is shifted by up to half a texel.
struct Environment {
  // By level, sixteen entries for a lookup a lane; those past the last repeat it.
  alignas(64) std::int32_t size[16] = {};         // texels a side, without the border
  alignas(64) std::int32_t first_texel[16] = {};  // texel (x, y), from -1 on, is first + (y + 1) * (size + 2) + x + 1
  std::vector<std::uint32_t> texels;
  float scale = 0;  // a power of two; 0 where all is black
  // Irradiance over pi, in the order 1, y, z, x, xy, yz, 3 yy - 1, xz, xx - zz, factors included.
  Vec3f irradiance[9] = {};
  // The share of a uniform environment that the specular lobe reflects (shading/environment/build.h): for f0 = 1 in the
  // lower 16 bits, for f0 = 0 in the upper; 65535 is 1. Rows of kLobeTableSize.
  std::vector<std::uint32_t> lobe;
};

}  // namespace shoal
