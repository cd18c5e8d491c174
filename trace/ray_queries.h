// Ray queries of the reference and of traced shadows: the first triangle of sixteen rays, and whether anything blocks
// them. The interface is plain data, so that the kernels of every instruction set share it. Embree finds the triangles
// (trace/embree_queries.cpp); our own arithmetic computes the hit itself anew (raster/resolve.h).
#pragma once

#include <cstdint>
#include <memory>

#include "scene/scene.h"

namespace shoal {

struct RayPacket;

// Alpha test: the lanes that the materials of alpha-tested triangles keep where the rays hit them.
//   id  a triangle a lane; lanes: bit i, lane i
using AlphaTestHits = std::uint32_t (*)(const void* context, const RayPacket&, const std::int32_t* id,
                                        std::uint32_t lanes);

// Receives the blended triangles that rays hit, in no order, some perhaps twice.
using VisitHits = void (*)(void* context, const RayPacket&, const std::int32_t* id, std::uint32_t lanes);

struct alignas(64) RayPacket {
  float origin_x[16], origin_y[16], origin_z[16];           // world, m
  float direction_x[16], direction_y[16], direction_z[16];  // any length
  float t_near[16], t_far[16];                              // in the direction's lengths
  std::int32_t id[16];                                      // result of first_hits: the triangle, kNoId where none
  AlphaTestHits alpha_test = nullptr;
  const void* context = nullptr;
};

class RayQueries {
 public:
  virtual ~RayQueries() = default;
  // The nearest opaque triangle of each ray, as the rasterizer draws them: one-sided materials from their front alone,
  // alpha-tested ones where `alpha_test` keeps the hit, blended ones not.
  virtual void first_hits(RayPacket& rays, std::uint32_t lanes) const = 0;
  // Hands every blended triangle that a ray hits between its t_near and t_far to `visit`, from either side.
  virtual void each_blended(const RayPacket& rays, std::uint32_t lanes, VisitHits visit, void* context) const = 0;
  // The lanes whose rays are blocked by something that casts shadows: both sides of everything drawn that is neither
  // unlit nor blended (docs/scenes.md).
  virtual std::uint32_t blocked(const RayPacket& rays, std::uint32_t lanes) const = 0;
  // Follows the scene's vertices after they have moved.
  virtual void update() = 0;
};

// Builds the acceleration structure over a scene that outlives it, on that many threads; null where the library was
// built without a ray tracer. Throws Error where memory is short.
std::unique_ptr<RayQueries> make_ray_queries(const RenderScene& scene, int threads);

}  // namespace shoal
