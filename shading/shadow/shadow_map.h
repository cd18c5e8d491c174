// The sun's shadow maps: depth from the first directional light, one map for the air and one for each plane of water.
//
// Under flat water the sun's rays are parallel still, only steeper. Everything below the plane is therefore sheared
// along it, p + shear * depth, so that a straight ray from the sun reaches the sheared point where the bent ray reaches
// the true one: exact for a flat surface. The body's map shades points in its water, the first map points in the air.
//
// The maps hold the whole scene, so they do not depend on the camera: shadow edges do not crawl when it moves, and maps
// are built once for a scene whose geometry and sun stand still. Where a few meshlets stand far out (hills round a
// garden), a map has two levels: a fine one of the scene's dense part and its water, and a coarse one of all.
//
// Source  the shear: bowfishing-blitz (2022), which scales heights below the water in the light's view.
#pragma once

#include <cstdint>
#include <vector>

#include "core/blocked_image.h"
#include "core/thread_pool.h"
#include "raster/camera.h"
#include "shading/light_medium.h"
#include "shading/shading_view.h"

namespace shoal {

struct ShadowMap {
  View view;  // orthographic, from the sun
  FrameGrid grid;
  SunBend bend;
  float texel_m = 1;
  float bias = 0;             // of depths, in their own unit
  AlignedArray<float> depth;  // blocked; greater is nearer to the sun, 0 where nothing is
  // By cell of kShadowCell texels a side, in rows: the greatest difference between the depths of nine taps that begin
  // there and their middle tap's depth. Small on smooth surfaces, where one tap then decides for all.
  AlignedArray<float> steepness;
};
inline constexpr int kShadowCell = 8;

// The levels of one medium's map, fine to coarse.
struct SunMap {
  std::vector<ShadowMap> levels;
};

struct SunShadows {
  std::vector<SunMap> maps;               // [0]: straight rays; empty where nothing casts
  std::vector<std::int32_t> map_of_body;  // [bodies] into maps; empty where build_shadows drew none
  // The map of a body's water: LightMedium::sun_map.
  SHOAL_INLINE std::int32_t map_index(std::size_t body) const {
    return body < map_of_body.size() ? map_of_body[body] : 0;
  }
};

// Bodies beyond this many planes count as air for shadows: a map is big.
inline constexpr std::size_t kMaxSunMaps = 8;

// What the maps are drawn from. Everything that it refers to outlives the call.
struct SunShadowIn {
  const ShadingView& view;                  // geometry, materials, textures and lights; its own shadows are not read
  const std::vector<Meshlet>& meshlets;     // of the geometry
  std::size_t material_count;               // of view.materials
  const std::vector<SunBend>& bends;        // one a body of water, for the first directional light
  const std::vector<Vec3f>& water_outline;  // world: all vertices of all bodies' outlines, in any order
  int size_px;                              // texels a side of a map's finest level: a multiple of 64
};

struct ShadowKernels;

// Draws the sun's maps.
//   in       see there; without a directional light, or without any meshlet, there are no maps
//   out      replaced: one map for the air and one for each different plane of water, and the map of each body
//   kernels  of one instruction set (shading/shadow/shadow_pass.h); the result does not depend on which
// Every triangle casts, from both sides, but those of unlit and of blended materials.
void build_shadows(const SunShadowIn& in, SunShadows& out, ThreadPool& pool, const ShadowKernels& kernels);

}  // namespace shoal
