// Prefetches of the triangles that blocks to come will read, while a block is worked on. Prefetched addresses depend on
// ids alone; a useless one costs next to nothing, and no result depends on any.
#pragma once

#include "refraction/data/region_hits.h"
#include "scene/scene_view.h"

namespace shoal {

inline constexpr int kPrefetchedLanes[] = {0, 3, 6, 9, 12, 14};

inline void prefetch_record(const SceneView& scene, std::int32_t id) {
  if (id >= 0 && id < scene.triangle_count) __builtin_prefetch(scene.geometry().triangles + id);
}

// The vertices of a triangle whose record has been prefetched before; not again for the triangle of the last call.
inline void prefetch_vertices(const SceneView& scene, std::int32_t id, std::int32_t& last) {
  if (id < 0 || id >= scene.triangle_count || id == last) return;
  last = id;
  const GeometryView& g = scene.geometry();
  for (const std::uint32_t vertex : g.triangles[id].vertex) {
    __builtin_prefetch(g.vertices + vertex);
    if (g.colors != nullptr) __builtin_prefetch(g.colors + vertex);
  }
}

// Records of the visibility buffer's block two ahead in its row, vertices of the block one ahead.
//   id  [size] the buffer's ids;  offset  of the block that is worked on
inline void prefetch_triangles(const SceneView& scene, const std::int32_t* id, std::size_t size, std::size_t offset) {
  if (offset + 3 * kBlockPixels > size) return;
  std::int32_t last = kNoId;
  for (const int lane : kPrefetchedLanes) {
    prefetch_record(scene, id[offset + 2 * kBlockPixels + static_cast<std::size_t>(lane)]);
    prefetch_vertices(scene, id[offset + kBlockPixels + static_cast<std::size_t>(lane)], last);
  }
}

// The same of the refracted hits of a region.
//   at_block  of the region, row by row
inline void prefetch_block_triangles(const SceneView& scene, const HitBlock* hits, std::size_t at_block) {
  if (at_block + 3 > static_cast<std::size_t>(RegionScratch::kBlocks)) return;
  std::int32_t last = kNoId;
  for (const int lane : kPrefetchedLanes) {
    prefetch_record(scene, hits[at_block + 2].refracted_id[lane]);
    prefetch_vertices(scene, hits[at_block + 1].refracted_id[lane], last);
  }
}

}  // namespace shoal
