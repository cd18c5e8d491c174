// Front end: meshlets of the scene through a vertex program, clipping and setup into bins.
//
// A vertex program takes a world position to a clip vertex, templated on the lane type:
//
//   struct Program {
//     template <class F> ClipVertex<F> vertex(Vec3<F> position_world) const;
//     bool meshlet_outside(const Meshlet&) const;            // conservative: true only if no pixel can show any of it
//   };
//
// A program that bends straight edges (a broad phase) sets `static constexpr bool kWarped = true;` and has the further
// members that raster/tessellate.h lists. Other programs set it to false.
#pragma once

#include <cstdint>

#include "core/wide/lanes.h"
#include "core/wide/lookup.h"
#include "raster/clip.h"
#include "raster/geometry_view.h"
#include "raster/setup.h"
#include "raster/tessellate.h"

namespace shoal::inline SHOAL_ISA_NS {

template <class Program>
class FrontEnd {
 public:
  SHOAL_INLINE FrontEnd(const GeometryView& geometry, const Program& program, const PassSettings& pass,
                        WorkItemBins& bins)
      : geometry_(geometry), program_(program), sink_(pass, bins), tessellator_(program, sink_) {}

  // Meshlets [first, last) of the scene, in order. id_override replaces the triangle ids (a water outline's), or is
  // kNoId.
  void run(std::uint32_t first, std::uint32_t last, std::int32_t id_override) {
    sink_.bins().clear();
    for (std::uint32_t c = first; c < last; ++c) {
      const Meshlet& meshlet = geometry_.meshlets[c];
      if (program_.meshlet_outside(meshlet)) continue;
      if (sink_.pass().skip_blended && geometry_.draw_states[meshlet.material].blended) continue;
      draw_meshlet(meshlet, id_override);
    }
    sink_.finish();
  }

  // Meshlets of a list, in its order.
  void run(const std::uint32_t* meshlets, std::size_t count) {
    sink_.bins().clear();
    for (std::size_t i = 0; i < count; ++i) {
      const Meshlet& meshlet = geometry_.meshlets[meshlets[i]];
      if (!program_.meshlet_outside(meshlet)) draw_meshlet(meshlet, kNoId);
    }
    sink_.finish();
  }

 private:
  // A meshlet's vertices on the pixel grid.
  struct alignas(64) MeshletVertices {
    std::int32_t x[kMeshletVertices], y[kMeshletVertices];
    float depth[kMeshletVertices];
  };

  __attribute__((noinline)) void draw_meshlet(const Meshlet& meshlet, std::int32_t id_override) {
    const DrawState& state = geometry_.draw_states[meshlet.material];
    const bool alpha_tested = state.alpha_tested, two_sided = state.double_sided;
    sink_.bins().triangles_in += meshlet.triangle_count;

    // Triangles that reach through the world plane or bend too much leave the fast path.
    bool through_plane = false, bends = false;
    if constexpr (Program::kWarped) {
      through_plane = !program_.meshlet_inside(meshlet);
      bends = program_.meshlet_bends(meshlet);
    }
    const float* wx = geometry_.x_world + meshlet.first_vertex;
    const float* wy = geometry_.y_world + meshlet.first_vertex;
    const float* wz = geometry_.z_world + meshlet.first_vertex;

    MeshletVertices v;
    std::uint64_t needs_clip = 0;
    for (int i = 0; i < meshlet.vertex_count; i += 16) {
      const ClipVertex<WideF> clip =
          program_.vertex(Vec3<WideF>{WideF::load(wx + i), WideF::load(wy + i), WideF::load(wz + i)});
      needs_clip |= std::uint64_t(~to_bits(inside_guard(clip)) & 0xFFFFu) << i;
      const SnappedLanes s = snap(clip, sink_.pass().centre_px);
      s.x.store(v.x + i), s.y.store(v.y + i), s.depth.store(v.depth + i);
    }

    const bool all_fast = needs_clip == 0 && !through_plane && !bends;
    // Corners are read from tables of full length; the geometry ends with its last meshlet's vertices.
    alignas(64) float world[3][kMeshletVertices];
    if (through_plane || bends)
      for (int i = 0; i < meshlet.vertex_count; i += 16) {
        WideF::load(wx + i).store(world[0] + i), WideF::load(wy + i).store(world[1] + i);
        WideF::load(wz + i).store(world[2] + i);
      }
    for (int t = 0; t < meshlet.triangle_count; t += 16) {
      const WideI i0 = load_u8(geometry_.corner[0] + meshlet.first_index + static_cast<std::uint32_t>(t));
      const WideI i1 = load_u8(geometry_.corner[1] + meshlet.first_index + static_cast<std::uint32_t>(t));
      const WideI i2 = load_u8(geometry_.corner[2] + meshlet.first_index + static_cast<std::uint32_t>(t));
      WideM active = lane_index() < WideI(meshlet.triangle_count - t);
      const WideI id = id_override != kNoId
                           ? WideI(id_override)
                           : WideI(static_cast<std::int32_t>(meshlet.first_triangle) + t) + lane_index();
      if (!all_fast) {
        const WideM slow =
            active & slow_lanes(world[0], world[1], world[2], i0, i1, i2, needs_clip, through_plane, bends);
        add_slow(wx, wy, wz, i0, i1, i2, id, to_bits(slow), two_sided, alpha_tested);
        active = active & !slow;
        if (none(active)) continue;
      }
      sink_.add(corner(v, i0), corner(v, i1), corner(v, i2), id, active, two_sided, alpha_tested);
    }
    tessellator_.flush();
  }

  SHOAL_INLINE static SnappedLanes corner(const MeshletVertices& v, WideI i) {
    return {lookup64(v.x, i), lookup64(v.y, i), lookup64(v.depth, i)};
  }
  SHOAL_INLINE static Vec3<WideF> world_corner(const float* x, const float* y, const float* z, WideI i) {
    return {lookup64(x, i), lookup64(y, i), lookup64(z, i)};
  }

  SHOAL_INLINE WideM slow_lanes(const float* x, const float* y, const float* z, WideI i0, WideI i1, WideI i2,
                                std::uint64_t needs_clip, bool through_plane, bool bends) {
    WideM slow = mask_from_bits(0);
    if (needs_clip != 0) {
      alignas(64) std::int32_t flags[kMeshletVertices];
      for (int i = 0; i < kMeshletVertices; ++i) flags[i] = static_cast<std::int32_t>((needs_clip >> i) & 1u);
      slow = (lookup64(flags, i0) | lookup64(flags, i1) | lookup64(flags, i2)) != WideI(0);
    }
    if constexpr (Program::kWarped) {
      if (!through_plane && !bends) return slow;
      const Vec3<WideF> a = world_corner(x, y, z, i0), b = world_corner(x, y, z, i1), c = world_corner(x, y, z, i2);
      if (through_plane) slow = slow | !(program_.inside(a) & program_.inside(b) & program_.inside(c));
      if (bends) slow = slow | program_.edge_bends(a, b) | program_.edge_bends(b, c) | program_.edge_bends(c, a);
    }
    return slow;
  }

  __attribute__((noinline)) void add_slow(const float* x, const float* y, const float* z, WideI i0, WideI i1, WideI i2,
                                          WideI id, std::uint32_t lanes, bool two_sided, bool alpha_tested) {
    for (; lanes != 0; lanes &= lanes - 1) {
      const int l = __builtin_ctz(lanes);
      const int k[3] = {extract(i0, l), extract(i1, l), extract(i2, l)};
      Vec3f p[3];
      for (int j = 0; j < 3; ++j) p[j] = {x[k[j]], y[k[j]], z[k[j]]};
      tessellator_.add(p[0], p[1], p[2], extract(id, l), two_sided, alpha_tested);
    }
  }

  const GeometryView& geometry_;
  const Program& program_;
  TriangleSink sink_;
  Tessellator<Program> tessellator_;
};

}  // namespace shoal::inline SHOAL_ISA_NS
