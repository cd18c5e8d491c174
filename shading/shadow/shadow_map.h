// The sun's shadow maps: depth from the first directional light, one map for the air and one for each plane of water.
//
// Under flat water the sun's rays are parallel still, only steeper. Everything below the plane is therefore sheared
// along it, p + shear * depth, so that a straight ray from the sun reaches the sheared point where the bent ray reaches
// the true one: exact for a flat surface. Points in a body's water look up its map, points in the air the first.
//
// The maps hold the whole scene, so that they do not depend on the camera: nothing crawls when it moves, and they are
// built once for a scene whose geometry and sun stand still. Where a few things stand far out (hills round a garden), a
// map has two levels: a fine one of the scene's dense part and its water, and a coarse one of all.
//
// Source  the shear: bowfishing-blitz (2022), which scales heights below the water in the light's view.
#pragma once

#include <cstdint>
#include <vector>

#include "core/blocked_image.h"
#include "core/thread_pool.h"
#include "raster/clip.h"
#include "raster/front_end.h"

namespace shoal {

// How sunlight goes on under one plane.
struct SunBend {
  bool bent = false;      // false: straight on
  Vec3f origin, normal;   // of the plane; the sun is on the normal's side
  Vec3f shear;            // metres along the plane a metre of depth
  Vec3f refracted_world;  // unit, the way that the light travels below
};

struct ShadowMap {
  View view;  // orthographic, from the sun
  FrameGrid grid;
  SunBend bend;
  float texel_m = 1;
  float bias = 0;             // of depths, in their own unit
  AlignedArray<float> depth;  // blocked; greater is nearer to the sun, 0 where nothing is
  // By cell of kShadowCell texels a side, in rows: how far any depth of a look-up that begins there can be from its
  // middle tap's. Small on smooth surfaces, where one tap then decides for all.
  AlignedArray<float> steepness;
};
inline constexpr int kShadowCell = 8;

// The levels of one medium's map, fine to coarse.
struct SunMap {
  std::vector<ShadowMap> levels;
};

struct SunShadows {
  std::vector<SunMap> maps;               // [0]: straight rays; empty where nothing casts
  std::vector<std::int32_t> map_of_body;  // [bodies]
  SHOAL_INLINE const SunMap* air() const { return maps.empty() ? nullptr : &maps[0]; }
  SHOAL_INLINE const SunMap* of_body(std::size_t body) const {
    return maps.empty() ? nullptr : &maps[static_cast<std::size_t>(map_of_body[body])];
  }
};

// Part of the scene drawn into a map: all of it, or what lies on one side of the water.
struct ShadowPass {
  GeometryView geometry;  // materials seen from both sides
  const ShadowMap* map = nullptr;
  PassSettings pass;
  bool clipped = false;
  Plane keep{{0, 0, 0}, 0};  // where clipped
  bool sheared = false;      // the part below the plane
};

// Bodies beyond this many planes count as air for shadows: a map is big.
inline constexpr std::size_t kMaxSunMaps = 8;
// Planes that the sun grazes more than this (cosine) bend nothing: their shear would have no bound.
inline constexpr float kMinSunCosine = 0.05f;

struct FrameData;
struct FrameKernels;
struct WaterBody;

// Sunlight along `direction` (unit, the way it travels) at a body's plane.
SunBend bend_of(const WaterBody& body, Vec3f direction);

// Draws the maps of frame.scene into frame.shadows: none for `--shadows off`, or without a directional light. What is
// unlit or blended casts no shadow; all else does from both sides.
void build_shadows(FrameData& frame, const FrameKernels& kernels, ThreadPool& pool);

}  // namespace shoal
