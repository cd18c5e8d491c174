// The slow path of the front end: triangles that are clipped by a world plane, bend under the vertex program, or reach
// through near plane or guard band. Sixteen at a time, breadth first.
//
// A warped program (kWarped) bends straight edges, so its triangles are split until their edges are straight enough. It
// has (raster/plane_clip.h has the part about the plane)
//
//   Plane clip_plane() const;                                   // its inside is drawn; before the vertex program
//   WideM inside(Vec3<WideF> p) const;                          // the same test of sixteen points
//   WideM edge_bends(Vec3<WideF> a, Vec3<WideF> b) const;       // symmetric in a and b, bit for bit
//   bool meshlet_inside(const Meshlet&) const;                      // whole meshlet inside of the plane
//   bool meshlet_bends(const Meshlet&) const;                       // false: no edge of it bends (a bound)
//   bool box_outside_view(Vec3f lo, Vec3f hi) const;            // true only if no pixel can show any of a world box
//
// An edge's split is decided from its end points alone and the new vertex is their midpoint (a + b) / 2, the same bits
// from both sides, so neighbours stay watertight.
#pragma once

#include <cstdint>

#include "core/pod_vector.h"
#include "core/vec_lanes.h"
#include "raster/clip.h"
#include "raster/setup.h"

namespace shoal {

inline constexpr int kMaxSubdivisionLevel = 16;

// A world-space triangle waiting for the tessellator.
struct WorldTriangle {
  Vec3f p[3];
  std::int32_t id;
  std::int32_t flags;  // level | two_sided << 8 | alpha_tested << 9
};
inline constexpr std::int32_t kFlagTwoSided = 1 << 8, kFlagAlphaTested = 1 << 9, kLevelMask = 0xFF;

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

template <class Program>
class Tessellator {
 public:
  SHOAL_INLINE Tessellator(const Program& program, TriangleSink& sink) : program_(program), sink_(sink) {}

  void add(Vec3f a, Vec3f b, Vec3f c, std::int32_t id, bool two_sided, bool alpha_tested) {
    const std::int32_t flags = (two_sided ? kFlagTwoSided : 0) | (alpha_tested ? kFlagAlphaTested : 0);
    if constexpr (Program::kWarped) {
      const Polygon<Vec3f> polygon = clip_to_plane(a, b, c, program_.clip_plane());
      for (int i = 2; i < polygon.count; ++i)
        push(polygon.vertex[0], polygon.vertex[i - 1], polygon.vertex[i], id, flags);
    } else {
      push(a, b, c, id, flags);
    }
    if (queue_.size() >= kBatch) flush();
  }

  // Draws all waiting triangles.
  __attribute__((noinline)) void flush() {
    while (queue_.size() > 0) {
      const std::size_t count = queue_.size() < 16 ? queue_.size() : 16;
      const std::size_t first = queue_.size() - count;
      WorldTriangle batch[16];
      for (std::size_t i = 0; i < 16; ++i) batch[i] = queue_[i < count ? first + i : first];
      for (std::size_t i = 0; i < count; ++i) queue_.pop();
      draw_batch(batch, static_cast<int>(count));
    }
  }

 private:
  static constexpr std::size_t kBatch = 512;

  SHOAL_INLINE void push(Vec3f a, Vec3f b, Vec3f c, std::int32_t id, std::int32_t flags) {
    queue_.push() = {{a, b, c}, id, flags};
  }

  SHOAL_INLINE static Vec3<WideF> load_corner(const WorldTriangle batch[16], int k) {
    alignas(64) float x[16], y[16], z[16];
    for (int i = 0; i < 16; ++i) x[i] = batch[i].p[k].x, y[i] = batch[i].p[k].y, z[i] = batch[i].p[k].z;
    return {WideF::load(x), WideF::load(y), WideF::load(z)};
  }

  __attribute__((noinline)) void draw_batch(const WorldTriangle batch[16], int count) {
    const Vec3<WideF> a = load_corner(batch, 0), b = load_corner(batch, 1), c = load_corner(batch, 2);
    WideM active = lane_index() < WideI(count);
    if constexpr (Program::kWarped) {
      const std::uint32_t split_ab = to_bits(program_.edge_bends(a, b) & active);
      const std::uint32_t split_bc = to_bits(program_.edge_bends(b, c) & active);
      const std::uint32_t split_ca = to_bits(program_.edge_bends(c, a) & active);
      std::uint32_t split = split_ab | split_bc | split_ca, dropped = 0;
      for (std::uint32_t m = split; m != 0; m &= m - 1) {
        const int l = __builtin_ctz(m);
        if (out_of_view(batch[l])) {
          dropped |= 1u << l;
          continue;
        }
        if ((batch[l].flags & kLevelMask) >= kMaxSubdivisionLevel) {
          split &= ~(1u << l);
          ++sink_.bins().subdivision_capped;
          continue;
        }
        subdivide(batch[l], ((split_ab >> l) & 1u) | (((split_bc >> l) & 1u) << 1) | (((split_ca >> l) & 1u) << 2));
      }
      active = active & !mask_from_bits(split | dropped);
      if (none(active)) return;
    }
    draw_lanes(batch, a, b, c, active);
  }

  // A triangle that bends and that no pixel can show is dropped: behind the eye it would never become straight.
  SHOAL_INLINE bool out_of_view(const WorldTriangle& t) const {
    const Vec3f lo = min(min(t.p[0], t.p[1]), t.p[2]), hi = max(max(t.p[0], t.p[1]), t.p[2]);
    return program_.box_outside_view(lo, hi);
  }

  // Red-green: the pattern depends on which edges split, never on the neighbours.
  __attribute__((noinline)) void subdivide(const WorldTriangle& t, std::uint32_t edges) {
    const std::int32_t flags = t.flags + 1;
    // Rotate so that the pattern starts at corner 0.
    int r = 0;
    if (edges == 2 || edges == 6) r = 1;
    if (edges == 4 || edges == 5) r = 2;
    const Vec3f a = t.p[r], b = t.p[(r + 1) % 3], c = t.p[(r + 2) % 3];
    const std::uint32_t rotated = ((edges >> r) | (edges << (3 - r))) & 7u;
    const Vec3f ab = (a + b) * 0.5f, bc = (b + c) * 0.5f, ca = (c + a) * 0.5f;
    if (rotated == 1) {  // one edge
      push(a, ab, c, t.id, flags);
      push(ab, b, c, t.id, flags);
    } else if (rotated == 3) {  // two edges
      push(ab, b, bc, t.id, flags);
      push(a, ab, bc, t.id, flags);
      push(a, bc, c, t.id, flags);
    } else {  // all three
      push(a, ab, ca, t.id, flags);
      push(ab, b, bc, t.id, flags);
      push(ca, bc, c, t.id, flags);
      push(ab, bc, ca, t.id, flags);
    }
  }

  __attribute__((noinline)) void draw_lanes(const WorldTriangle batch[16], const Vec3<WideF>& a, const Vec3<WideF>& b,
                                            const Vec3<WideF>& c, WideM active) {
    const ClipVertex<WideF> va = program_.vertex(a), vb = program_.vertex(b), vc = program_.vertex(c);
    const WideM inside = inside_guard(va) & inside_guard(vb) & inside_guard(vc);
    for (std::uint32_t m = to_bits(active & !inside); m != 0; m &= m - 1)
      draw_clipped(batch[__builtin_ctz(m)], va, vb, vc, __builtin_ctz(m));
    active = active & inside;
    if (none(active)) return;
    alignas(64) std::int32_t ids[16], flags[16];
    for (int i = 0; i < 16; ++i) ids[i] = batch[i].id, flags[i] = batch[i].flags;
    const Vec2f centre = sink_.pass().centre_px;
    add_by_flags(snap(va, centre), snap(vb, centre), snap(vc, centre), WideI::load(ids), WideI::load(flags), active);
  }

  SHOAL_INLINE void add_by_flags(const SnappedLanes& a, const SnappedLanes& b, const SnappedLanes& c, WideI id,
                                 WideI flags, WideM active) {
    const WideM two_sided = (flags & WideI(kFlagTwoSided)) != WideI(0),
                alpha_tested = (flags & WideI(kFlagAlphaTested)) != WideI(0);
    for (int kind = 0; kind < 4; ++kind) {
      const bool two = (kind & 1) != 0, tested = (kind & 2) != 0;
      const WideM lanes = active & (two ? two_sided : !two_sided) & (tested ? alpha_tested : !alpha_tested);
      if (any(lanes)) sink_.add(a, b, c, id, lanes, two, tested);
    }
  }

  SHOAL_INLINE static ClipVertex<float> lane(const ClipVertex<WideF>& v, int l) {
    return {extract(v.x, l), extract(v.y, l), extract(v.z, l), extract(v.w, l)};
  }

  __attribute__((noinline)) void draw_clipped(const WorldTriangle& t, const ClipVertex<WideF>& va,
                                              const ClipVertex<WideF>& vb, const ClipVertex<WideF>& vc, int l) {
    const ClipVertex<float> a = lane(va, l), b = lane(vb, l), c = lane(vc, l);
    const Polygon<ClipVertex<float>> p = clip_to_guard(a, b, c);
    const Vec2f centre = sink_.pass().centre_px;
    auto snapped = [&](const ClipVertex<float>& v) {
      return snap(ClipVertex<WideF>{WideF(v.x), WideF(v.y), WideF(v.z), WideF(v.w)}, centre);
    };
    for (int i = 2; i < p.count; ++i) {
      sink_.add(snapped(p.vertex[0]), snapped(p.vertex[i - 1]), snapped(p.vertex[i]), WideI(t.id), mask_from_bits(1u),
                (t.flags & kFlagTwoSided) != 0, (t.flags & kFlagAlphaTested) != 0);
    }
  }

  const Program& program_;
  TriangleSink& sink_;
  PodVector<WorldTriangle> queue_;
};

}  // namespace shoal::inline SHOAL_ISA_NS
