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

// A built-in scene as `shoal render NAME --triangles N` draws it; made once a program.
const RenderScene& built_in_scene(const std::string& name, std::uint64_t triangles);
const RenderScene& pool_scene(std::uint64_t triangles);
const Camera& first_camera(const RenderScene& scene);

// Two textured triangles that fill the frame. A texel is 2^-0.5 px: level of detail 0.5.
//   texture_size  texels a side
RenderScene make_quad(int texture_size);

// Gives each textured material all that it can have: normal, metallic-roughness, occlusion and emissive maps (512 x 512
// noise; gentle bumps), and every vertex a tangent.
void add_maps(RenderScene& scene);

// Point lights above the scene's middle, in rows of four; every one reaches every point.
void add_point_lights(RenderScene& scene, int count);

// A square of cells x cells x 2 triangles, cell_px pixels a cell, seen from its front or its back.
RenderScene make_grid(int cells, float cell_px, bool front);

// sRGB noise, size x size texels and all levels.
Texture make_noise(int size);

}  // namespace shoal::bench
