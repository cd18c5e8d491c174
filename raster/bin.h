// Bins: set-up triangles in packets of sixteen, and which tiles each packet touches.
//
// The front end works on fixed runs of meshlets, the work items. Each work item has bins of its own, and a tile reads
// the work items in order, so triangles reach a tile in submission order whichever thread set them up. The tile
// computes the edge functions anew from 40 bytes a triangle instead of reading them from the bins
// (docs/ARCHITECTURE.md, "Bins").
#pragma once

#include <cstdint>

#include "core/pod_vector.h"

namespace shoal {

// Visible ids in buffers: the global id of a triangle; kFirstWaterId + b for body of water b (negative, so that at
// equal depth it is in front of every triangle); kNoId where nothing was drawn.
inline constexpr std::int32_t kNoId = 0x7FFFFFFF;
inline constexpr std::int32_t kFirstWaterId = -0x7FFFFFFF - 1;
inline constexpr std::int32_t kMaxWaterBodies = 65536;

inline constexpr int kSubpixelBits = 8;
inline constexpr int kSubpixel = 1 << kSubpixelBits;
// Triangles up to this extent take the packet path: all their edge arithmetic fits 32 bits.
inline constexpr int kSmallExtent = 64 * kSubpixel;

// Sixteen set-up triangles; positions in 1/256 px, oriented so that the inside is positive (raster/setup.h).
struct alignas(64) TrianglePacket {
  std::int32_t x[3][16];
  std::int32_t y[3][16];
  float depth[3][16];
  std::int32_t id[16];
};

struct LargeTriangle {
  std::int32_t x[3], y[3];
  float depth[3];
  std::int32_t id;
};

enum class BinKind : std::uint32_t { kSmall = 0, kLarge = 1, kSmallAlphaTested = 2, kLargeAlphaTested = 3 };

struct BinEntry {
  std::uint32_t tile;
  std::uint32_t kind_and_index;  // BinKind in the two upper bits, index of packet or large triangle below
  std::uint32_t lanes;           // of the packet that touch the tile
};
inline constexpr std::uint32_t kBinIndexMask = 0x3FFFFFFFu;

struct BinGrid {
  int tile_px = 64, tile_shift = 6;
  int tiles_x = 0, tiles_y = 0;
};
BinGrid make_bin_grid(int width_px, int height_px, int tile_px);

// The bins of one work item.
struct WorkItemBins {
  PodVector<TrianglePacket> packets;
  PodVector<LargeTriangle> large;
  PodVector<BinEntry> entries;          // in the order of their triangles
  PodVector<BinEntry> sorted;           // the same by tile, in that order within a tile
  PodVector<std::uint32_t> tile_first;  // entries of tile t: sorted[tile_first[t] .. tile_first[t + 1])
  // Counts: triangles before culling and after setup, and those left unsplit at the last level of subdivision.
  std::uint64_t triangles_in = 0, triangles_out = 0, subdivision_capped = 0;
  void clear();
  void sort_by_tile(const BinGrid& grid);
};

}  // namespace shoal
