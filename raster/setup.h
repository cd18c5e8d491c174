// Setup: sixteen snapped triangles in, culled, packed and binned.
//
// Cost   about 12 cycles a culled triangle and 25 a surviving one (AVX-512; docs/PERFORMANCE.md).
#pragma once

#include <cstdint>

#include "core/wide/lanes.h"
#include "raster/bin.h"
#include "raster/camera.h"

namespace shoal {

// Half the width of the guard band, which is centred on the frame.
inline constexpr float kGuardPx = 16384.0f;

// Settings of one pass over the geometry.
struct PassSettings {
  int width_px = 0, height_px = 0;
  Vec2f centre_px{0, 0};  // added to x / w and y / w
  BinGrid grid;
  // Bounds of the pixels that the pass may draw, inclusive: the frame, or the refracted region's bounds.
  int x_min = 0, y_min = 0, x_max = -1, y_max = -1;
  const std::int32_t* tile_active = nullptr;  // [tiles] 0: nothing is binned there; null: all are active
  bool flip_facing = false;                   // of a planar reflection pass, which reverses every winding
  bool skip_blended = false;                  // meshlets of blended materials have a pass of their own
  bool back_faces = false;                    // the back faces of one-sided materials are drawn, and nothing else
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

// Sixteen vertices on the 1/256 pixel grid.
struct SnappedLanes {
  WideI x, y;
  WideF depth;
};

// Whether a vertex is finite and inside of near plane and guard band, and so needs no clipping. False for NaN.
SHOAL_INLINE WideM inside_guard(const ClipVertex<WideF>& v) {
  const WideF limit = v.w * WideF(kGuardPx);
  return (v.w > WideF(0.0f)) & (v.z <= v.w) & (abs(v.x) <= limit) & (abs(v.y) <= limit);
}

// The one snapping routine: nearest, ties to even. Values out of the guard band (unused lanes, rounding after clipping)
// are clamped to it; NaN becomes its edge.
SHOAL_INLINE SnappedLanes snap(const ClipVertex<WideF>& v, Vec2f centre_px) {
  const WideF rw = WideF(1.0f) / v.w;
  const WideF guard(kGuardPx);
  const WideF x = clamp(v.x * rw, -guard, guard) + WideF(centre_px.x);
  const WideF y = clamp(v.y * rw, -guard, guard) + WideF(centre_px.y);
  return {to_int_nearest(x * WideF(float(kSubpixel))), to_int_nearest(y * WideF(float(kSubpixel))), v.z * rw};
}

// Culls and bins triangles; they wait here until their packet is full.
class TriangleSink {
 public:
  SHOAL_INLINE TriangleSink(const PassSettings& pass, WorkItemBins& bins) : pass_(pass), bins_(bins) {}

  // Sixteen triangles by corner. Culls back faces (unless two_sided), zero areas and triangles that hold no sample.
  SHOAL_INLINE void add(SnappedLanes a, SnappedLanes b, SnappedLanes c, WideI id, WideM active, bool two_sided,
                        bool alpha_tested) {
    const WideI min_x = min(min(a.x, b.x), c.x), max_x = max(max(a.x, b.x), c.x);
    const WideI min_y = min(min(a.y, b.y), c.y), max_y = max(max(a.y, b.y), c.y);
    // First and last sample (pixel centre) in the box; none: first > last.
    const WideI half(kSubpixel / 2);
    const WideI x0 = max((min_x + (half - WideI(1))) >> kSubpixelBits, WideI(pass_.x_min));
    const WideI y0 = max((min_y + (half - WideI(1))) >> kSubpixelBits, WideI(pass_.y_min));
    const WideI x1 = min((max_x - half) >> kSubpixelBits, WideI(pass_.x_max));
    const WideI y1 = min((max_y - half) >> kSubpixelBits, WideI(pass_.y_max));
    active = active & (x0 <= x1) & (y0 <= y1);
    if (none(active)) return;
    if (pass_.back_faces && two_sided) return;
    if (pass_.flip_facing != pass_.back_faces) {
      const SnappedLanes t = b;
      b = c;
      c = t;
    }
    const WideM small = (max_x - min_x <= WideI(kSmallExtent)) & (max_y - min_y <= WideI(kSmallExtent));
    const WideM is_large = active & !small;
    if (any(is_large)) add_large(a, b, c, id, to_bits(is_large), two_sided, alpha_tested, x0, y0, x1, y1);

    // Twice the area, exact in 32 bits for small triangles. The screen's y points down, so a counter-clockwise triangle
    // has (b - a) x (c - a) < 0 there.
    const WideI area = (c.x - a.x) * (b.y - a.y) - (b.x - a.x) * (c.y - a.y);
    const WideM drawn = active & small & (two_sided ? area != WideI(0) : area > WideI(0));
    const std::uint32_t bits = to_bits(drawn);
    if (bits == 0) return;
    if (two_sided) {
      const WideM back = area < WideI(0);
      const SnappedLanes t = b;
      b = {select(back, c.x, b.x), select(back, c.y, b.y), select(back, c.depth, b.depth)};
      c = {select(back, t.x, c.x), select(back, t.y, c.y), select(back, t.depth, c.depth)};
    }
    if (alpha_tested != staged_alpha_tested_ && staged_ > 0) flush();
    staged_alpha_tested_ = alpha_tested;
    stage(stage_.x[0], a.x, drawn), stage(stage_.y[0], a.y, drawn), stage(stage_.depth[0], a.depth, drawn);
    stage(stage_.x[1], b.x, drawn), stage(stage_.y[1], b.y, drawn), stage(stage_.depth[1], b.depth, drawn);
    stage(stage_.x[2], c.x, drawn), stage(stage_.y[2], c.y, drawn), stage(stage_.depth[2], c.depth, drawn);
    stage(stage_.id, id, drawn);
    const int shift = pass_.grid.tile_shift;
    stage(stage_.tile_x0, x0 >> shift, drawn), stage(stage_.tile_x1, x1 >> shift, drawn);
    stage(stage_.tile_y0, y0 >> shift, drawn), stage(stage_.tile_y1, y1 >> shift, drawn);
    staged_ += __builtin_popcount(bits);
    if (staged_ >= 16) flush();
  }

  // Must be called once at the end of a work item.
  void finish() {
    while (staged_ > 0) flush();
    bins_.sort_by_tile(pass_.grid);
  }

  const PassSettings& pass() const { return pass_; }
  WorkItemBins& bins() { return bins_; }

 private:
  // Room for a full packet and the sixteen that overflow it.
  struct alignas(64) Stage {
    std::int32_t x[3][32], y[3][32];
    float depth[3][32];
    std::int32_t id[32], tile_x0[32], tile_x1[32], tile_y0[32], tile_y1[32];
  };

  SHOAL_INLINE void stage(std::int32_t* to, WideI v, WideM drawn) { compress(v, drawn).store(to + staged_); }
  SHOAL_INLINE void stage(float* to, WideF v, WideM drawn) { compress(v, drawn).store(to + staged_); }

  __attribute__((noinline)) void flush() {
    const int count = staged_ < 16 ? staged_ : 16;
    const std::uint32_t index = static_cast<std::uint32_t>(bins_.packets.size());
    TrianglePacket& p = bins_.packets.push();
    for (int k = 0; k < 3; ++k) {
      move16(p.x[k], stage_.x[k]), move16(p.y[k], stage_.y[k]);
      WideF::load(stage_.depth[k]).store(p.depth[k]);
      WideF::load(stage_.depth[k] + 16).store(stage_.depth[k]);
    }
    move16(p.id, stage_.id);
    WideI tx0 = WideI::load(stage_.tile_x0), tx1 = WideI::load(stage_.tile_x1);
    WideI ty0 = WideI::load(stage_.tile_y0), ty1 = WideI::load(stage_.tile_y1);
    move16(stage_.tile_x0, stage_.tile_x0), move16(stage_.tile_x1, stage_.tile_x1);
    move16(stage_.tile_y0, stage_.tile_y0), move16(stage_.tile_y1, stage_.tile_y1);
    const std::uint32_t filled = count == 16 ? 0xFFFFu : (1u << count) - 1u;
    const WideM valid = mask_from_bits(filled);
    const WideI big(0x7FFFFFFF);
    const int x0 = reduce_min(select(valid, tx0, big)), y0 = reduce_min(select(valid, ty0, big));
    const int x1 = reduce_max(select(valid, tx1, WideI(-1))), y1 = reduce_max(select(valid, ty1, WideI(-1)));
    const std::uint32_t kind =
        static_cast<std::uint32_t>(staged_alpha_tested_ ? BinKind::kSmallAlphaTested : BinKind::kSmall) << 30;
    if (x0 == x1 && y0 == y1) {
      add_entry(x0, y0, kind | index, filled);
    } else if ((x1 - x0 + 1) * (y1 - y0 + 1) <= 32) {
      for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) {
          const WideM here = valid & (tx0 <= WideI(x)) & (tx1 >= WideI(x)) & (ty0 <= WideI(y)) & (ty1 >= WideI(y));
          const std::uint32_t lanes = to_bits(here);
          if (lanes != 0) add_entry(x, y, kind | index, lanes);
        }
    } else {
      // The packet's triangles are far apart: enter the tiles of each.
      for (int lane = 0; lane < count; ++lane)
        for (int y = extract(ty0, lane); y <= extract(ty1, lane); ++y)
          for (int x = extract(tx0, lane); x <= extract(tx1, lane); ++x) add_entry(x, y, kind | index, 1u << lane);
    }
    bins_.triangles_out += static_cast<std::uint64_t>(count);
    staged_ -= count;
  }

  // Copies sixteen to `to` and moves the overflow down.
  SHOAL_INLINE void move16(std::int32_t* to, std::int32_t* staged) {
    WideI::load(staged).store(to);
    WideI::load(staged + 16).store(staged);
  }

  SHOAL_INLINE void add_entry(int tile_x, int tile_y, std::uint32_t kind_and_index, std::uint32_t lanes) {
    const std::uint32_t tile = static_cast<std::uint32_t>(tile_y * pass_.grid.tiles_x + tile_x);
    if (pass_.tile_active != nullptr && pass_.tile_active[tile] == 0) return;
    bins_.entries.push() = {tile, kind_and_index, lanes};
  }

  __attribute__((noinline)) void add_large(SnappedLanes a, SnappedLanes b, SnappedLanes c, WideI id,
                                           std::uint32_t lanes, bool two_sided, bool alpha_tested, WideI x0, WideI y0,
                                           WideI x1, WideI y1) {
    for (; lanes != 0; lanes &= lanes - 1) {
      const int lane = __builtin_ctz(lanes);
      LargeTriangle t;
      t.x[0] = extract(a.x, lane), t.x[1] = extract(b.x, lane), t.x[2] = extract(c.x, lane);
      t.y[0] = extract(a.y, lane), t.y[1] = extract(b.y, lane), t.y[2] = extract(c.y, lane);
      t.depth[0] = extract(a.depth, lane), t.depth[1] = extract(b.depth, lane), t.depth[2] = extract(c.depth, lane);
      t.id = extract(id, lane);
      const std::int64_t area =
          std::int64_t(t.x[2] - t.x[0]) * (t.y[1] - t.y[0]) - std::int64_t(t.x[1] - t.x[0]) * (t.y[2] - t.y[0]);
      if (area == 0 || (area < 0 && !two_sided)) continue;
      if (area < 0) {
        const std::int32_t x = t.x[1], y = t.y[1];
        const float depth = t.depth[1];
        t.x[1] = t.x[2], t.y[1] = t.y[2], t.depth[1] = t.depth[2];
        t.x[2] = x, t.y[2] = y, t.depth[2] = depth;
      }
      const std::uint32_t kind = static_cast<std::uint32_t>(alpha_tested ? BinKind::kLargeAlphaTested : BinKind::kLarge)
                                 << 30;
      const std::uint32_t index = static_cast<std::uint32_t>(bins_.large.size());
      bins_.large.push() = t;
      ++bins_.triangles_out;
      const int shift = pass_.grid.tile_shift;
      const int tx0 = extract(x0, lane) >> shift, tx1 = extract(x1, lane) >> shift;
      const int ty0 = extract(y0, lane) >> shift, ty1 = extract(y1, lane) >> shift;
      for (int y = ty0; y <= ty1; ++y)
        for (int x = tx0; x <= tx1; ++x) {
          if (tile_outside(t, x << shift, y << shift, pass_.grid.tile_px)) continue;
          add_entry(x, y, kind | index, 1u);
        }
    }
  }

  // All of the tile's samples are outside of one edge: exact.
  SHOAL_INLINE static bool tile_outside(const LargeTriangle& t, int x_px, int y_px, int size_px) {
    for (int k = 0; k < 3; ++k) {
      const int n = k == 2 ? 0 : k + 1;
      const std::int64_t step_x = t.y[n] - t.y[k], step_y = t.x[k] - t.x[n];
      // The corner where the edge function is greatest.
      const std::int64_t x = (step_x > 0 ? x_px + size_px - 1 : x_px) * std::int64_t(kSubpixel) + kSubpixel / 2;
      const std::int64_t y = (step_y > 0 ? y_px + size_px - 1 : y_px) * std::int64_t(kSubpixel) + kSubpixel / 2;
      if ((x - t.x[k]) * step_x + (y - t.y[k]) * step_y < 0) return true;
    }
    return false;
  }

  const PassSettings& pass_;
  WorkItemBins& bins_;
  Stage stage_;
  int staged_ = 0;
  bool staged_alpha_tested_ = false;
};

}  // namespace shoal::inline SHOAL_ISA_NS
