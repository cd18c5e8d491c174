// Vertex programs of the passes: direct, refracted and planar reflection; and a work item of meshlets through one.
#pragma once

#include "raster/cull.h"
#include "raster/front_end.h"
#include "raster/pass_bins.h"
#include "raster/plane_clip.h"
#include "refraction/broad/broad_phase.h"
#include "refraction/data/water_pass.h"

namespace shoal::inline SHOAL_ISA_NS {

// Straight through: the direct pass.
struct DirectProgram {
  static constexpr bool kWarped = false;
  const View& view;
  const Frustum& frustum;

  template <class F>
  SHOAL_INLINE ClipVertex<F> vertex(Vec3<F> position_world) const {
    return project(view, position_world);
  }
  SHOAL_INLINE bool meshlet_outside(const Meshlet& meshlet) const {
    return box_outside(frustum, meshlet.bounds_min_world, meshlet.bounds_max_world);
  }
};

// What the passes of a body of water share: they clip geometry at a plane in the world.
struct LayerProgram : PlaneClip {
  const WaterPass& water;
  const View& view;

  LayerProgram(const WaterPass& of_water, const View& of_view)
      : PlaneClip{of_water.clip_plane}, water(of_water), view(of_view) {}
};

// The broad phase as a vertex program: every vertex at its virtual position, edges split until they are straight to
// kEdgeThresholdPx.
struct RefractedProgram : LayerProgram {
  using LayerProgram::LayerProgram;
  // Out of line, because the solver is long and the front end has several callers.
  __attribute__((noinline)) ClipVertex<WideF> vertex(Vec3<WideF> position_world) const {
    return project(view, virtual_position(water.optics->map, position_world));
  }
  SHOAL_INLINE bool box_outside_view(Vec3f lo, Vec3f hi) const {
    Vec3f virtual_lo, virtual_hi;
    virtual_bounds(water.optics->map, lo, hi, virtual_lo, virtual_hi);
    return box_outside(water.frustum, virtual_lo, virtual_hi);
  }
  bool meshlet_outside(const Meshlet& meshlet) const {
    return all_clipped(meshlet.bounds_min_world, meshlet.bounds_max_world) ||
           box_outside_view(meshlet.bounds_min_world, meshlet.bounds_max_world);
  }
  bool meshlet_bends(const Meshlet& meshlet) const {
    return meshlet_deviation_bound_px(water.optics->map, view, meshlet.bounds_min_world, meshlet.bounds_max_world,
                                      meshlet.longest_edge_m) > kEdgeThresholdPx;
  }
  __attribute__((noinline)) WideM edge_bends(Vec3<WideF> a, Vec3<WideF> b) const {
    return edge_deviation_px(water.optics->map, view, a, b) > WideF(kEdgeThresholdPx);
  }
};

// A method's own map in place of the broad phase.
//
//   Map  template <class F> Vec3<F> position(Vec3<F> world) const;     where a world position is drawn
//        void bounds(Vec3f lo, Vec3f hi, Vec3f& out_lo, Vec3f& out_hi) const;   of a world box's images
// Edges are split where the exact map (WaterOptics::exact) needs it, or nowhere.
template <class Map>
struct MappedProgram : LayerProgram {
  const Map& map;
  bool splits;

  //   splits_edges  false: bent edges stay straight
  MappedProgram(const WaterPass& of_water, const View& of_view, const Map& of_map, bool splits_edges)
      : LayerProgram(of_water, of_view), map(of_map), splits(splits_edges) {}

  __attribute__((noinline)) ClipVertex<WideF> vertex(Vec3<WideF> position_world) const {
    return project(view, map.position(position_world));
  }
  SHOAL_INLINE bool box_outside_view(Vec3f lo, Vec3f hi) const {
    Vec3f image_lo, image_hi;
    map.bounds(lo, hi, image_lo, image_hi);
    return box_outside(water.frustum, image_lo, image_hi);
  }
  bool meshlet_outside(const Meshlet& meshlet) const {
    return all_clipped(meshlet.bounds_min_world, meshlet.bounds_max_world) ||
           box_outside_view(meshlet.bounds_min_world, meshlet.bounds_max_world);
  }
  bool meshlet_bends(const Meshlet& meshlet) const {
    return splits && meshlet_deviation_bound_px(water.optics->exact, view, meshlet.bounds_min_world,
                                                meshlet.bounds_max_world, meshlet.longest_edge_m) > kEdgeThresholdPx;
  }
  __attribute__((noinline)) WideM edge_bends(Vec3<WideF> a, Vec3<WideF> b) const {
    if (!splits) return mask_from_bits(0);
    return edge_deviation_px(water.optics->exact, view, a, b) > WideF(kEdgeThresholdPx);
  }
};

// The planar reflection pass: the scene mirrored in the plane.
struct ReflectedProgram : LayerProgram {
  using LayerProgram::LayerProgram;
  template <class F>
  SHOAL_INLINE ClipVertex<F> vertex(Vec3<F> position_world) const {
    return project(view, mirrored_position(water.optics->exact, position_world));
  }
  SHOAL_INLINE bool box_outside_view(Vec3f lo, Vec3f hi) const {
    const Vec3f centre = mirrored_position(water.optics->exact, (lo + hi) * 0.5f), half = (hi - lo) * 0.5f,
                n = water.optics->exact.normal;
    // Rows of I - 2 n n^T, absolute.
    auto reach = [&](float a, float b, float c) { return abs(a) * half.x + abs(b) * half.y + abs(c) * half.z; };
    const Vec3f extent{reach(1.0f - 2.0f * n.x * n.x, 2.0f * n.x * n.y, 2.0f * n.x * n.z),
                       reach(2.0f * n.y * n.x, 1.0f - 2.0f * n.y * n.y, 2.0f * n.y * n.z),
                       reach(2.0f * n.z * n.x, 2.0f * n.z * n.y, 1.0f - 2.0f * n.z * n.z)};
    const float pad = 1e-5f * (length(centre) + length(half));
    return box_outside(water.frustum, centre - extent - Vec3f{pad, pad, pad}, centre + extent + Vec3f{pad, pad, pad});
  }
  bool meshlet_outside(const Meshlet& meshlet) const {
    return all_clipped(meshlet.bounds_min_world, meshlet.bounds_max_world) ||
           box_outside_view(meshlet.bounds_min_world, meshlet.bounds_max_world);
  }
  SHOAL_INLINE bool meshlet_bends(const Meshlet&) const { return false; }
  SHOAL_INLINE WideM edge_bends(Vec3<WideF>, Vec3<WideF>) const { return mask_from_bits(0); }
};

// One work item of a pass: a run of the scene's meshlets by the pass's vertex program into its bins.
template <class Program>
SHOAL_INLINE void run_work_item(const GeometryView& geometry, const Program& program, const PassSettings& pass,
                                PassBins& bins, std::size_t work_item) {
  const std::uint32_t first = static_cast<std::uint32_t>(work_item) * bins.meshlets_per_work_item;
  const std::uint32_t end = first + bins.meshlets_per_work_item;
  FrontEnd<Program>(geometry, program, pass, bins.work_items[work_item])
      .run(first, end < bins.meshlet_count ? end : bins.meshlet_count, kNoId);
}

// The same of a list of meshlets.
//   meshlets  [bins.meshlet_count]
template <class Program>
void run_work_item(const GeometryView& geometry, const Program& program, const PassSettings& pass,
                   const std::uint32_t* meshlets, PassBins& bins, std::size_t work_item) {
  const std::uint32_t first = static_cast<std::uint32_t>(work_item) * bins.meshlets_per_work_item;
  const std::uint32_t left = bins.meshlet_count - first;
  const std::uint32_t count = left < bins.meshlets_per_work_item ? left : bins.meshlets_per_work_item;
  FrontEnd<Program>(geometry, program, pass, bins.work_items[work_item]).run(meshlets + first, count);
}

}  // namespace shoal::inline SHOAL_ISA_NS
