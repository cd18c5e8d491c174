// Embree 3 over a scene's triangles: the peer that our BVH is measured against, and an oracle of the tests.
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

struct alignas(64) RayPacket {
  float origin_x[16], origin_y[16], origin_z[16];           // world, m
  float direction_x[16], direction_y[16], direction_z[16];  // any length
  float t_near[16], t_far[16];                              // in the direction's lengths
  std::int32_t id[16];                                      // result of first_hits: the triangle, kNoId where none
  AlphaTestHits alpha_test = nullptr;                       // null: alpha-tested triangles are opaque
  const void* context = nullptr;
};

// Sixteen rays from arrays of components, from t_near 0.
RayPacket make_packet(const float (&origin_world)[3][16], const float (&direction_world)[3][16],
                      const float (&t_far)[16]);

// The same triangles as ours: Embree's robust mode, one geometry for each of the four kinds of opaque triangles, with
// filters where a kind needs one.
class EmbreeQueries {
 public:
  //   scene    outlives this; its vertices are shared, not copied
  //   threads  that build
  //   moves    build for vertices that change
  // Throws Error where memory is short.
  EmbreeQueries(const RenderScene& scene, int threads, bool moves);
  ~EmbreeQueries();
  EmbreeQueries(const EmbreeQueries&) = delete;
  EmbreeQueries& operator=(const EmbreeQueries&) = delete;

  // The nearest opaque triangle of each ray, as the rasterizer draws them: one-sided materials from their front alone,
  // alpha-tested ones where `alpha_test` keeps the hit, blended ones not.
  //   coherent  the rays lie near each other: Embree's hint, which changes its way, not its results
  void first_hits(RayPacket& rays, std::uint32_t lanes, bool coherent) const;
  // The same by one query for each ray.
  void first_hit_of_each(RayPacket& rays, std::uint32_t lanes) const;
  // The lanes whose rays are blocked by something that casts shadows: both sides of everything drawn that is neither
  // unlit nor blended (docs/scenes.md).
  std::uint32_t blocked(const RayPacket& rays, std::uint32_t lanes) const;
  // Follows the scene's vertices after they have moved.
  void refit();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace shoal
