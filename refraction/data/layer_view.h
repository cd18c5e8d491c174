// The layers of a body of water as a raster method reads them: ids and depths by pixel, and the opaque triangles that
// are drawn there. No call gives meshlets, bounds or any triangle that no layer shows.
#pragma once

#include "raster/camera.h"
#include "raster/ray_triangle.h"
#include "raster/resolve.h"
#include "raster/visibility.h"
#include "refraction/data/edge_map.h"
#include "refraction/data/frame_grids.h"
#include "refraction/data/water_pass.h"

namespace shoal {

// The two layers of a direction: the nearest triangle at each pixel, and the nearest one behind it.
enum class LayerSlice : std::uint8_t { kNearest, kBehind };

// What a LayerView refers to.
struct LayerBuffers {
  WaterPassKind kind;  // refracted: flat water's view; reflected: the plane's mirror
  const WaterOptics& optics;
  const View& view;
  const LayerGrid& grid;
  const std::int32_t* region_drawn;   // [regions of the grid] not 0: the nearest layer is drawn there
  const std::int32_t* region_behind;  // the same of the layer behind
  const VisibilityBuffer& nearest;
  const VisibilityBuffer* behind;  // null: not drawn
  const EdgeMap* edges;            // of the nearest layer; null: not searched for
  const GeometryView& geometry;
};

// Opaque triangles, one a lane.
template <class F>
struct FetchedTriangle {
  IntOf<F> id;         // kNoId where the layer shows none
  MaskOf<F> shown;     // lanes that have one
  Vec3<F> p0, e1, e2;  // first corner, world; the other corners less it
  MaskOf<F> one_sided;
};

// A place on the frame, in pixels: a pixel's sample is at its index + 0.5.
template <class F>
struct LayerPlace {
  F x_px, y_px;
  F depth_m = F(1.0f);  // of the point along the view axis, where it is known
};

class LayerView {
 public:
  explicit LayerView(const LayerBuffers& buffers) : b_(buffers) {}

  const LayerGrid& grid() const { return b_.grid; }
  const std::int32_t* id() const { return b_.nearest.id.data(); }  // [slots of grid().grid]
  const float* depth() const { return b_.nearest.depth.data(); }   // the same; greater is nearer, 0 where nothing is
  bool has_behind() const { return b_.behind != nullptr; }

  // The triangles at pixels of the frame, or of the layers' margin around it.
  //   x_px, y_px  integers; places where the layers are not drawn show nothing
  //   lanes       that fetch;  fetches  of each lane: one more for each call
  //   known       triangles that count as none, one a lane
  template <class F>
  FetchedTriangle<F> fetch(LayerSlice slice, IntOf<F> x_px, IntOf<F> y_px, MaskOf<F> lanes, IntOf<F>& fetches,
                           IntOf<F> known = IntOf<F>(kNoId)) const {
    const IntOf<F> zero(0);
    fetches = fetches + select(lanes, IntOf<F>(1), zero);
    const FrameGrid& grid = b_.grid.grid;
    const IntOf<F> margin(b_.grid.margin_px);
    IntOf<F> x = x_px + margin, y = y_px + margin;
    MaskOf<F> there =
        lanes & (x >= zero) & (y >= zero) & (x < IntOf<F>(grid.width_px)) & (y < IntOf<F>(grid.height_px));
    x = select(there, x, zero), y = select(there, y, zero);
    const IntOf<F> region = (y >> 6) * IntOf<F>(grid.regions_x) + (x >> 6);
    const bool nearest = slice == LayerSlice::kNearest;
    there = there & (gather(nearest ? b_.region_drawn : b_.region_behind, region, there, zero) != zero);
    const VisibilityBuffer& buffer = nearest ? b_.nearest : *b_.behind;
    FetchedTriangle<F> t;
    t.id = gather(buffer.id.data(), pixel_slots(grid, x, y), there, IntOf<F>(kNoId));
    t.shown = is_triangle(t.id) & (t.id != known);
    t.p0 = t.e1 = t.e2 = broadcast<F>(Vec3f{0, 0, 0});
    t.one_sided = MaskOf<F>(t.id != t.id);
    for_each_distinct(t.id, t.shown, [&](std::int32_t one, MaskOf<F> same) SHOAL_LAMBDA {
      const Geometry::TriangleRecord& r = b_.geometry.triangles[one];
      const Vec3f a = b_.geometry.vertices[r.vertex[0]].position_world;
      const Vec3f e1 = b_.geometry.vertices[r.vertex[1]].position_world - a;
      const Vec3f e2 = b_.geometry.vertices[r.vertex[2]].position_world - a;
      t.p0 = select<F>(same, broadcast<F>(a), t.p0);
      t.e1 = select<F>(same, broadcast<F>(e1), t.e1);
      t.e2 = select<F>(same, broadcast<F>(e2), t.e2);
      if (!b_.geometry.draw_states[r.material].double_sided) t.one_sided = t.one_sided | same;
    });
    return t;
  }

  // Where a world position is seen: through flat water, or mirrored.
  template <class F>
  LayerPlace<F> place_of(const Vec3<F>& position_world) const {
    const Vec3<F> image = b_.kind == WaterPassKind::kReflected ? mirrored_position(b_.optics.exact, position_world)
                                                               : virtual_position(b_.optics.map, position_world);
    const ClipVertex<F> clip = project(b_.view, image);
    const F inverse_w = F(1.0f) / max(clip.w, F(1e-6f));
    return {clip.x * inverse_w + F(b_.view.centre_px.x), clip.y * inverse_w + F(b_.view.centre_px.y), clip.w};
  }
  // Depths along the view axis of what the nearest layer shows in a block of the frame, metres; 1 where it shows
  // nothing.
  template <class F>
  F depth_at(int x_px, int y_px) const {
    const F drawn = F::load(depth() + b_.grid.offset(x_px, y_px));
    const MaskOf<F> shows = drawn > F(0.0f);
    return select(shows, view_depth_m(b_.view, select(shows, drawn, F(1.0f))), F(1.0f));
  }
  // The width of a pixel at a depth.
  template <class F>
  F pixel_m(F depth_m) const {
    const F inverse(1.0f / b_.optics.exact.px_per_unit);
    return b_.optics.exact.orthographic ? inverse : depth_m * inverse;
  }

  // Is there an edge of the nearest layer in a rectangle of the frame (widened to blocks)? True where no edges were
  // searched for.
  bool edge_within(int x0_px, int y0_px, int x1_px, int y1_px) const {
    if (b_.edges == nullptr) return true;
    const int m = b_.grid.margin_px;
    return b_.edges->any_within(x0_px + m, y0_px + m, x1_px + m, y1_px + m);
  }

 private:
  const LayerBuffers& b_;
};

}  // namespace shoal
