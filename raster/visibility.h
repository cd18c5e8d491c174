// Visibility: the nearest triangle at each sample of a tile, and its depth.
//
// Packets of small triangles have their edges set up sixteen triangles at a time and then fill 4 x 4 blocks; large
// triangles descend 64 -> 16 -> 4 with trivial reject and accept. Coverage is exact integer arithmetic at pixel centres
// with the top-left rule; depth is one expression at the absolute pixel, never stepped. The nearer depth wins, at equal
// depth the smaller id, so a tile's result does not depend on the order of its triangles.
//
// Source  Pineda 1988 (edge functions); Abrash 2009 (descent, 64 -> 16 -> 4).
// Cost    small: about 30 cycles a triangle and 12 a block; large: about 10 a block (docs/PERFORMANCE.md).
#pragma once

#include <cstdint>

#include "core/blocked_image.h"
#include "core/wide/lanes.h"
#include "raster/bin.h"
#include "raster/blocks.h"

namespace shoal {

struct VisibilityBuffer {
  FrameGrid grid;
  AlignedArray<float> depth;      // 0 where nothing is
  AlignedArray<std::int32_t> id;  // raster/bin.h: kNoId, triangles, water bodies
  void resize(const FrameGrid& g) {
    grid = g;
    depth.resize(g.pixel_slots());
    id.resize(g.pixel_slots());
  }
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

// Depth plane of a triangle: depth(X, Y) = d0 + (X - x0) dx + (Y - y0) dy, clamped to the range of the corners' depths,
// which slivers and extrapolation could leave.
struct DepthPlane {
  std::int32_t x0, y0;
  float d0, dx, dy, lo, hi;
};

// The alpha test of opaque triangles: keeps every pixel.
struct KeepAll {
  static constexpr bool kTests = false;
  SHOAL_INLINE WideM operator()(std::int32_t, int, int, WideM cover) const { return cover; }
};

// An "alpha test" that receives the covered blocks instead: nothing is written here (raster/fragments.h,
// raster/behind.h).
template <class T>
concept TakesFragments = requires(const T& t, std::int32_t id, int block, WideM cover, WideF depth) {
  t.fragment(id, block, block, cover, depth);
};

// Draws the binned triangles of one tile.
//   AlphaTest  WideM operator()(id, x_px, y_px, cover) of the block at a pixel: the covered pixels that are drawn
template <class AlphaTest>
class TileRaster {
 public:
  SHOAL_INLINE TileRaster(VisibilityBuffer& out, const AlphaTest& alpha, int tile_x0, int tile_y0, int tile_x1,
                          int tile_y1)
      : out_(out), alpha_(alpha), x0_(tile_x0), y0_(tile_y0), x1_(tile_x1), y1_(tile_y1) {}

  // Empties the tile's padded blocks.
  void clear() {
    const int bx1 = (x1_ + 3) >> 2, by1 = (y1_ + 3) >> 2;
    for (int by = y0_ >> 2; by < by1; ++by)
      for (int bx = x0_ >> 2; bx < bx1; ++bx) {
        const std::size_t at = out_.grid.block_offset(bx, by);
        WideF(0.0f).store(out_.depth.data() + at);
        WideI(kNoId).store(out_.id.data() + at);
      }
    start_over();
  }

  // Keeps what is in the tile, to be drawn over.
  void start_over() {
    const int regions = ((x1_ - x0_ + kRegionSize - 1) / kRegionSize) * ((y1_ - y0_ + kRegionSize - 1) / kRegionSize);
    for (int r = 0; r < regions && r < kMaxRegions; ++r)
      for (float& f : farthest_[r]) f = 0.0f;
  }

  void draw(const WorkItemBins& bins, std::uint32_t tile) {
    const std::uint32_t end = bins.tile_first[tile + 1];
    for (std::uint32_t i = bins.tile_first[tile]; i < end; ++i) {
      const BinEntry& e = bins.sorted[i];
      const std::uint32_t index = e.kind_and_index & kBinIndexMask;
      switch (static_cast<BinKind>(e.kind_and_index >> 30)) {
        case BinKind::kSmall:
          draw_packet<false>(bins.packets[index], e.lanes);
          break;
        case BinKind::kSmallAlphaTested:
          draw_packet<true>(bins.packets[index], e.lanes);
          break;
        case BinKind::kLarge:
          draw_large<false>(bins.large[index]);
          break;
        case BinKind::kLargeAlphaTested:
          draw_large<true>(bins.large[index]);
          break;
      }
    }
  }

 private:
  static constexpr int kMaxRegions = 16;  // of a 256-pixel tile

  // Sixteen small triangles: edges and planes of all lanes at once, then one triangle after the other.
  template <bool kAlphaTested>
  __attribute__((noinline)) void draw_packet(const TrianglePacket& p, std::uint32_t lanes) {
    WideI x[3], y[3];
    WideF depth[3];
    for (int k = 0; k < 3; ++k) {
      x[k] = WideI::load(p.x[k]), y[k] = WideI::load(p.y[k]);
      depth[k] = WideF::load(p.depth[k]);
    }
    const WideI half(kSubpixel / 2);
    const WideI px0 = max((min(min(x[0], x[1]), x[2]) + (half - WideI(1))) >> kSubpixelBits, WideI(x0_));
    const WideI py0 = max((min(min(y[0], y[1]), y[2]) + (half - WideI(1))) >> kSubpixelBits, WideI(y0_));
    const WideI px1 = min((max(max(x[0], x[1]), x[2]) - half) >> kSubpixelBits, WideI(x1_ - 1));
    const WideI py1 = min((max(max(y[0], y[1]), y[2]) - half) >> kSubpixelBits, WideI(y1_ - 1));
    // The first block's first sample: where the edge functions start.
    const WideI bx0 = px0 >> 2, by0 = py0 >> 2;
    const WideI sample_x = (bx0 << (kSubpixelBits + 2)) + half, sample_y = (by0 << (kSubpixelBits + 2)) + half;

    alignas(64) PacketEdges s;
    for (int k = 0; k < 3; ++k) {
      const int n = k == 2 ? 0 : k + 1;
      const WideI step_x = y[n] - y[k], step_y = x[k] - x[n];
      const WideM inclusive = (step_x > WideI(0)) | ((step_x == WideI(0)) & (step_y > WideI(0)));
      // At most 2 * 2^14 * (2^14 + 2^10): fits. Then the value at every sample differs by multiples of 256, so the
      // low eight bits decide nothing once the bias is in.
      const WideI e = (sample_x - x[k]) * step_x + (sample_y - y[k]) * step_y + select(inclusive, WideI(0), WideI(-1));
      (e >> kSubpixelBits).store(s.e[k]);
      step_x.store(s.step_x[k]);
      step_y.store(s.step_y[k]);
    }
    const WideF dx1 = to_float(x[1] - x[0]), dy1 = to_float(y[1] - y[0]);
    const WideF dx2 = to_float(x[2] - x[0]), dy2 = to_float(y[2] - y[0]);
    const WideI area = (x[2] - x[0]) * (y[1] - y[0]) - (x[1] - x[0]) * (y[2] - y[0]);
    plane_gradient(depth[0], depth[1], depth[2], dx1, dy1, dx2, dy2, to_float(area), s.depth_dx, s.depth_dy);
    min(min(depth[0], depth[1]), depth[2]).store(s.depth_lo);
    max(max(depth[0], depth[1]), depth[2]).store(s.depth_hi);
    bx0.store(s.bx0), by0.store(s.by0);
    (px1 >> 2).store(s.bx1), (py1 >> 2).store(s.by1);

    for (; lanes != 0; lanes &= lanes - 1) {
      const int l = __builtin_ctz(lanes);
      const DepthPlane plane{p.x[0][l],     p.y[0][l],     p.depth[0][l], s.depth_dx[l],
                             s.depth_dy[l], s.depth_lo[l], s.depth_hi[l]};
      const WideI ax(s.step_x[0][l]), ay(s.step_y[0][l]), bx(s.step_x[1][l]), by(s.step_y[1][l]);
      const WideI cx(s.step_x[2][l]), cy(s.step_y[2][l]);
      const WideI lane_x = block_x(), lane_y = block_y();
      WideI row0 = WideI(s.e[0][l]) + lane_x * ax + lane_y * ay;
      WideI row1 = WideI(s.e[1][l]) + lane_x * bx + lane_y * by;
      WideI row2 = WideI(s.e[2][l]) + lane_x * cx + lane_y * cy;
      const WideI step0 = ax << 2, step1 = bx << 2, step2 = cx << 2;
      const WideI down0 = ay << 2, down1 = by << 2, down2 = cy << 2;
      const std::int32_t id = p.id[l];
      for (int block_row = s.by0[l]; block_row <= s.by1[l]; ++block_row) {
        WideI e0 = row0, e1 = row1, e2 = row2;
        for (int block_col = s.bx0[l]; block_col <= s.bx1[l]; ++block_col) {
          const WideM cover = (e0 | e1 | e2) >= WideI(0);
          if (any(cover)) write_block<kAlphaTested>(block_col, block_row, cover, plane, id);
          e0 = e0 + step0, e1 = e1 + step1, e2 = e2 + step2;
        }
        row0 = row0 + down0, row1 = row1 + down1, row2 = row2 + down2;
      }
    }
  }

  struct PacketEdges {
    std::int32_t e[3][16], step_x[3][16], step_y[3][16];
    std::int32_t bx0[16], by0[16], bx1[16], by1[16];
    float depth_dx[16], depth_dy[16], depth_lo[16], depth_hi[16];
  };

  // Per sub-pixel. area as the edge functions have it (positive).
  SHOAL_INLINE static void plane_gradient(WideF d0, WideF d1, WideF d2, WideF dx1, WideF dy1, WideF dx2, WideF dy2,
                                          WideF area, float* out_dx, float* out_dy) {
    const WideF r = WideF(1.0f) / area;
    const WideF e1 = d1 - d0, e2 = d2 - d0;
    ((e2 * dy1 - e1 * dy2) * r).store(out_dx);
    ((e1 * dx2 - e2 * dx1) * r).store(out_dy);
  }

  template <bool kAlphaTested>
  SHOAL_INLINE void write_block(int block_col, int block_row, WideM cover, const DepthPlane& plane, std::int32_t id) {
    // Offsets from the first corner are exact in float: they are below 2^24.
    const WideF fx =
        to_float((WideI(block_col * 4 * kSubpixel + kSubpixel / 2 - plane.x0)) + (block_x() << kSubpixelBits));
    const WideF fy =
        to_float((WideI(block_row * 4 * kSubpixel + kSubpixel / 2 - plane.y0)) + (block_y() << kSubpixelBits));
    const WideF depth =
        clamp((fx * WideF(plane.dx) + fy * WideF(plane.dy)) + WideF(plane.d0), WideF(plane.lo), WideF(plane.hi));
    if constexpr (TakesFragments<AlphaTest>) {
      if constexpr (kAlphaTested && AlphaTest::kTests) {
        cover = cover & alpha_(id, block_col * 4, block_row * 4, cover);
        if (none(cover)) return;
      }
      alpha_.fragment(id, block_col, block_row, cover, depth);
    } else {
      keep_nearest<kAlphaTested>(block_col, block_row, cover, depth, id);
    }
  }

  template <bool kAlphaTested>
  SHOAL_INLINE void keep_nearest(int block_col, int block_row, WideM cover, WideF depth, std::int32_t id) {
    const std::size_t at = out_.grid.block_offset(block_col, block_row);
    float* depth_at = out_.depth.data() + at;
    std::int32_t* id_at = out_.id.data() + at;
    const WideF old_depth = WideF::load(depth_at);
    const WideI old_id = WideI::load(id_at);
    WideM pass = cover & ((depth > old_depth) | ((depth == old_depth) & (WideI(id) < old_id)));
    if (none(pass)) return;
    if constexpr (kAlphaTested && AlphaTest::kTests) {
      pass = pass & alpha_(id, block_col * 4, block_row * 4, pass);
    }
    store_masked(depth_at, depth, pass);
    store_masked(id_at, WideI(id), pass);
  }

  // One large triangle: 64-pixel blocks in 64-bit arithmetic, then 32-bit descent inside.
  template <bool kAlphaTested>
  __attribute__((noinline)) void draw_large(const LargeTriangle& t) {
    DepthPlane plane;
    plane.x0 = t.x[0], plane.y0 = t.y[0], plane.d0 = t.depth[0];
    plane.lo = min(min(t.depth[0], t.depth[1]), t.depth[2]);
    plane.hi = max(max(t.depth[0], t.depth[1]), t.depth[2]);
    {
      const std::int64_t area =
          std::int64_t(t.x[2] - t.x[0]) * (t.y[1] - t.y[0]) - std::int64_t(t.x[1] - t.x[0]) * (t.y[2] - t.y[0]);
      const float r = 1.0f / static_cast<float>(area);
      const float e1 = t.depth[1] - t.depth[0], e2 = t.depth[2] - t.depth[0];
      const float dx1 = static_cast<float>(t.x[1] - t.x[0]), dy1 = static_cast<float>(t.y[1] - t.y[0]);
      const float dx2 = static_cast<float>(t.x[2] - t.x[0]), dy2 = static_cast<float>(t.y[2] - t.y[0]);
      plane.dx = (e2 * dy1 - e1 * dy2) * r;
      plane.dy = (e1 * dx2 - e2 * dx1) * r;
    }
    for (int y = y0_; y < y1_; y += kRegionSize)
      for (int x = x0_; x < x1_; x += kRegionSize) draw_large_region<kAlphaTested>(t, plane, x, y);
  }

  template <bool kAlphaTested>
  SHOAL_INLINE void draw_large_region(const LargeTriangle& t, const DepthPlane& plane, int x_px, int y_px) {
    // Edge functions at the region's first sample, in units of a pixel step (their low eight bits are the same at every
    // sample and only the sign of the floor matters).
    std::int32_t e[3], step_x[3], step_y[3];
    const int size_x = min(x1_ - x_px, kRegionSize), size_y = min(y1_ - y_px, kRegionSize);
    for (int k = 0; k < 3; ++k) {
      const int n = k == 2 ? 0 : k + 1;
      step_x[k] = t.y[n] - t.y[k];
      step_y[k] = t.x[k] - t.x[n];
      const bool inclusive = step_x[k] > 0 || (step_x[k] == 0 && step_y[k] > 0);
      const std::int64_t x = std::int64_t(x_px) * kSubpixel + kSubpixel / 2 - t.x[k];
      const std::int64_t y = std::int64_t(y_px) * kSubpixel + kSubpixel / 2 - t.y[k];
      const std::int64_t value = (x * step_x[k] + y * step_y[k] - (inclusive ? 0 : 1)) >> kSubpixelBits;
      const std::int64_t reach_x = std::int64_t(step_x[k]) * (kRegionSize - 1),
                         reach_y = std::int64_t(step_y[k]) * (kRegionSize - 1);
      const std::int64_t greatest = value + (reach_x > 0 ? reach_x : 0) + (reach_y > 0 ? reach_y : 0);
      const std::int64_t least = value + (reach_x < 0 ? reach_x : 0) + (reach_y < 0 ? reach_y : 0);
      if (greatest < 0) return;
      if (least >= 0) {  // inside all over the region: the edge need not be evaluated, and might not fit 32 bits
        e[k] = step_x[k] = step_y[k] = 0;
      } else {
        e[k] = static_cast<std::int32_t>(value);
      }
    }
    float* farthest = farthest_[((y_px - y0_) / kRegionSize) * ((x1_ - x0_ + kRegionSize - 1) / kRegionSize) +
                                (x_px - x0_) / kRegionSize];
    // 64 -> 16: the 4 x 4 sub-blocks of 16 pixels, one a lane.
    const SubBlocks by16 = classify(e, step_x, step_y, 16);
    for (std::uint32_t m = by16.touched; m != 0; m &= m - 1) {
      const int i = __builtin_ctz(m);
      const int x16 = (i & 3) * 16, y16 = (i >> 2) * 16;
      if (x16 >= size_x || y16 >= size_y) continue;
      std::int32_t e16[3];
      for (int k = 0; k < 3; ++k) e16[k] = e[k] + step_x[k] * x16 + step_y[k] * y16;
      // 16 -> 4: a block of pixels a lane.
      SubBlocks by4{0xFFFFu, 0xFFFFu};
      if (((by16.inside >> i) & 1u) == 0) by4 = classify(e16, step_x, step_y, 4);
      for (std::uint32_t n = by4.touched; n != 0; n &= n - 1) {
        const int j = __builtin_ctz(n);
        const int x4 = x16 + (j & 3) * 4, y4 = y16 + (j >> 2) * 4;
        WideM cover;
        if (((by4.inside >> j) & 1u) != 0) {
          cover = mask_from_bits(0xFFFFu);
        } else {
          WideI all_edges(0);
          for (int k = 0; k < 3; ++k) {
            const WideI base(e16[k] + step_x[k] * ((j & 3) * 4) + step_y[k] * ((j >> 2) * 4));
            all_edges = all_edges | (base + block_x() * WideI(step_x[k]) + block_y() * WideI(step_y[k]));
          }
          cover = all_edges >= WideI(0);
          if (none(cover)) continue;
        }
        write_block_large<kAlphaTested>((x_px + x4) >> 2, (y_px + y4) >> 2, cover, plane, t.id,
                                        farthest[(y4 >> 2) * 16 + (x4 >> 2)]);
      }
    }
  }

  struct SubBlocks {
    std::uint32_t touched;  // not outside of any edge
    std::uint32_t inside;   // inside of all
  };

  // The sixteen sub-blocks of `size` pixels of a block whose first sample has edge values e.
  SHOAL_INLINE static SubBlocks classify(const std::int32_t e[3], const std::int32_t step_x[3],
                                         const std::int32_t step_y[3], int size) {
    WideI any_outside(0), any_partly(0);
    for (int k = 0; k < 3; ++k) {
      const WideI base = WideI(e[k]) + block_x() * WideI(step_x[k] * size) + block_y() * WideI(step_y[k] * size);
      const std::int32_t reach_x = step_x[k] * (size - 1), reach_y = step_y[k] * (size - 1);
      any_outside = any_outside | (base + WideI((reach_x > 0 ? reach_x : 0) + (reach_y > 0 ? reach_y : 0)));
      any_partly = any_partly | (base + WideI((reach_x < 0 ? reach_x : 0) + (reach_y < 0 ? reach_y : 0)));
    }
    return {to_bits(any_outside >= WideI(0)), to_bits(any_partly >= WideI(0))};
  }

  // As write_block, with early rejection: `farthest` is a lower bound of the block's depths, which may be out of date,
  // for depths only grow.
  template <bool kAlphaTested>
  SHOAL_INLINE void write_block_large(int block_col, int block_row, WideM cover, const DepthPlane& plane,
                                      std::int32_t id, float& farthest) {
    if constexpr (TakesFragments<AlphaTest>) {
      write_block<kAlphaTested>(block_col, block_row, cover, plane, id);
      return;
    }
    if (plane.hi < farthest) return;
    write_block<kAlphaTested>(block_col, block_row, cover, plane, id);
    if (all(cover))
      farthest = reduce_min(WideF::load(out_.depth.data() + out_.grid.block_offset(block_col, block_row)));
  }

  VisibilityBuffer& out_;
  const AlphaTest& alpha_;
  int x0_, y0_, x1_, y1_;                         // pixels; x1, y1 exclusive, inside of the frame
  alignas(64) float farthest_[kMaxRegions][256];  // by 4 x 4 block of each 64-pixel region
};

}  // namespace shoal::inline SHOAL_ISA_NS
