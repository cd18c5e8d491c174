// The scenes that the suites measure on.
#pragma once

#include <cstdint>
#include <string>

#include "scene/scene.h"

namespace shoal::bench {

inline constexpr int kWidth = 1920, kHeight = 1080;

struct SizedScene {
  const char* size;
  std::uint64_t triangles;
};
inline constexpr SizedScene kPoolSizes[] = {{"128k", 128'000}, {"2.4M", 2'400'000}};

// `pool` as `shoal render pool --triangles N` draws it; made once a program.
const RenderScene& pool_scene(std::uint64_t triangles);
const Camera& first_camera(const RenderScene& scene);

// The camera of frame k of `shoal render --repeat`: turned left k tenths of a degree about world up.
Camera turned_left(const Camera& camera, std::int64_t k);

// Two textured triangles that fill the frame. A texel is 2^-0.5 px: level of detail 0.5.
//   texture_size  texels a side
RenderScene make_quad(int texture_size);

// A square of cells x cells x 2 triangles, cell_px pixels a cell, seen from its front or its back.
RenderScene make_grid(int cells, float cell_px, bool front);

// sRGB noise, size x size texels and all levels.
Texture make_noise(int size);

}  // namespace shoal::bench
