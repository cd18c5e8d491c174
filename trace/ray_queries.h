// What the ray tracer and traced shadows ask of a scene: which triangle do sixteen rays meet first, and does anything
// stand in their way? Plain data, so that kernels of every ISA share it; the answers come from Embree, at the edge
// (trace/embree_queries.cpp), and the hit itself is computed anew by our own arithmetic (raster/resolve.h).
#pragma once

#include <cstdint>
#include <memory>

#include "scene/scene.h"

namespace shoal {

struct RayPacket;

// Of alpha-tested triangles: which of the lanes their material keeps where the rays meet them.
//   id  a triangle a lane; lanes: bit i, lane i
using KeepHits = std::uint32_t (*)(const void* context, const RayPacket&, const std::int32_t* id, std::uint32_t lanes);

// Of blended triangles that rays meet, in no order, some perhaps twice.
using VisitHits = void (*)(void* context, const RayPacket&, const std::int32_t* id, std::uint32_t lanes);

struct alignas(64) RayPacket {
  float origin_x[16], origin_y[16], origin_z[16];           // world, m
  float direction_x[16], direction_y[16], direction_z[16];  // any length
  float t_near[16], t_far[16];                              // in the direction's lengths
  std::int32_t id[16];                                      // answer of first_hits: the triangle, kNoId where none
  KeepHits keep = nullptr;
  const void* context = nullptr;
};

class RayQueries {
 public:
  virtual ~RayQueries() = default;
  // The nearest opaque triangle of each ray, as the rasterizer draws them: one-sided materials from their front alone,
  // alpha-tested ones where `keep` says so, blended ones not.
  virtual void first_hits(RayPacket& rays, std::uint32_t lanes) const = 0;
  // Hands every blended triangle that a ray meets between its t_near and t_far to `visit`, from either side.
  virtual void each_blended(const RayPacket& rays, std::uint32_t lanes, VisitHits visit, void* context) const = 0;
  // Lanes whose ray something that casts shadows is in the way of: both sides of everything drawn that is neither unlit
  // nor blended (docs/scenes.md).
  virtual std::uint32_t blocked(const RayPacket& rays, std::uint32_t lanes) const = 0;
  // After the scene's vertices have moved.
  virtual void update() = 0;
};

// Builds the acceleration structure over a scene that outlives it, on that many threads; null where the library was
// built without a ray tracer. Throws Error where memory is short.
std::unique_ptr<RayQueries> make_ray_queries(const RenderScene& scene, int threads);

}  // namespace shoal
