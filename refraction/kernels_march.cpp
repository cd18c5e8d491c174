// Narrow phase under waves (refraction/narrow/march_hit.h).
#include "refraction/narrow/march_hit.h"

#include "refraction/narrow/nearest_hit.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

// Planes tried for one ray. Of 305,000 mirrored rays of `pool` (slope 0.05) eight rounds left 42,560 open, four 42,817.
constexpr int kMostRounds = 4;
// Steps on the way to it, at most: more than any layer is wide.
constexpr int kMostSteps = 1 << 15;
// An edge is in the way where it is nearer than the ray by more than this share of the depth.
constexpr float kInFront = 1.001f;

// A point of the ray in the layer: pixels (sample positions) and depth as drawn.
struct LayerPoint {
  WideF x, y, depth;
};

__attribute__((noinline)) LayerPoint layer_point(const FrameData& f, const Layer& layer, const Ray<WideF>& ray,
                                                 WideF t) {
  const Vec3<WideF> p = ray.origin_world + ray.direction_world * t;
  const Vec3<WideF> image =
      layer.mirrored ? mirrored_position(layer.water.optics, p) : virtual_position(layer.water.map, p);
  const ClipVertex<WideF> clip = project(f.view, image);
  // Never behind the eye: what is refracted or mirrored is beyond the plane.
  const WideF inverse_w = WideF(1.0f) / max(clip.w, WideF(1e-6f));
  const float margin = static_cast<float>(f.layers.margin_px);
  return {clip.x * inverse_w + WideF(f.view.centre_px.x + margin),
          clip.y * inverse_w + WideF(f.view.centre_px.y + margin), clip.z * inverse_w};
}

// Where the ray leaves the scene's box, and some pixels beyond: it is behind what lies on the very side only where it
// is behind the depth at that pixel's centre.
WideF exit_distance(const RenderScene& scene, const Ray<WideF>& ray) {
  const auto axis = [](WideF origin, WideF direction, float lo, float hi) {
    const WideF far_side = select(direction > WideF(0.0f), WideF(hi), WideF(lo)) - origin;
    const WideM moves = abs(direction) > WideF(1e-9f);
    return select(moves, max(far_side / select(moves, direction, WideF(1.0f)), WideF(0.0f)), WideF(1e9f));
  };
  const Vec3f lo = scene.bounds_min_world, hi = scene.bounds_max_world;
  const Vec3<WideF>&o = ray.origin_world, &d = ray.direction_world;
  const WideF leaves = min(min(axis(o.x, d.x, lo.x, hi.x), axis(o.y, d.y, lo.y, hi.y)), axis(o.z, d.z, lo.z, hi.z));
  return leaves * WideF(1.25f);
}

// The pixel that holds a place; far outside counts as just outside.
SHOAL_INLINE WideI pixel_of(WideF at) { return to_int_trunc(floor(clamp(at, WideF(-8.0f), WideF(20000.0f)))); }

class March {
 public:
  March(const FrameData& frame, const Layer& through, const Ray<WideF>& along)
      : f(frame), layer(through), ray(along), end(exit_distance(*frame.scene, along)) {}

  MarchedHit run(WideI own, WideM lanes) {
    const WideM met = find(own, lanes);
    return {found, found_t, any(met) ? met & clear_way(met) : met};
  }

 private:
  WideM inside(WideI x_px, WideI y_px) const {
    const FrameGrid& grid = layer.visibility.grid;
    return (x_px >= WideI(0)) & (y_px >= WideI(0)) & (x_px < WideI(grid.width_px)) & (y_px < WideI(grid.height_px));
  }

  // Goes from plane to plane. Returns the lanes that meet what their point shows, with `found` and `place` set.
  WideM find(WideI own, WideM lanes) {
    const GeometryView& g = f.geometry;
    const VisibilityBuffer& shown = layer.visibility;
    WideI id = own, x_px(0), y_px(0);
    WideM open = lanes, met = mask_from_bits(0);
    for (int round = 0; round < kMostRounds && any(open); ++round) {
      const WideM drawn = open & is_triangle(id);
      TriangleTest test{WideF(0.0f), mask_from_bits(0)};
      if (any(drawn)) test = test_triangles(g, ray, id, drawn);
      const WideM hits = test.inside, misses = drawn & !hits;
      const WideF t = select(hits | (misses & (test.t > WideF(0.0f)) & (test.t < end)), test.t, end);
      const LayerPoint at = layer_point(f, layer, ray, t);
      x_px = pixel_of(at.x), y_px = pixel_of(at.y);
      const WideM within = open & inside(x_px, y_px);
      const WideI next = gather(shown.id.data(), pixel_slots(shown.grid, x_px, y_px), within, WideI(0));
      // A ray that leaves the scene where the layer shows nothing meets nothing.
      const WideM leaves = open & !drawn & within & (next == WideI(kNoId));
      const WideM done = (hits & within) | leaves;
      take(id, select(hits, t, WideF(kEndless)), at, done);
      met = met | done;
      open = open & within & !done;
      id = select(open, next, id);
    }
    // Edges are drawn where pixels' centres say: the triangle may be a neighbour's.
    const WideM beside = open & is_triangle(id);
    if (any(beside)) {
      const ConfirmedHit hit = confirm_hit(g, shown, ray, id, x_px, y_px, beside);
      if (any(hit.held)) {
        const WideF t = triangle_distance(g, ray, hit.id, hit.held);
        take(hit.id, t, layer_point(f, layer, ray, t), hit.held);
        met = met | hit.held;
      }
    }
    return met;
  }

  void take(WideI id, WideF t, const LayerPoint& at, WideM lanes) {
    found = select(lanes, id, found);
    found_t = select(lanes, t, found_t);
    place.x = select(lanes, at.x, place.x);
    place.y = select(lanes, at.y, place.y);
    place.depth = select(lanes, at.depth, place.depth);
  }

  // The lanes whose way from the water to their place stays in front of every edge: by blocks, and where that fails
  // by pixels.
  WideM clear_way(WideM lanes) {
    const LayerPoint start = layer_point(f, layer, ray, WideF(0.0f));
    const LayerEdges& edges = layer.edges;
    WideM hidden = hidden_on_way(start, lanes, 3.0f, [&](WideI x_px, WideI y_px, WideM going) SHOAL_LAMBDA {
      return gather(edges.block.data(), (y_px >> 2) * WideI(edges.blocks_x) + (x_px >> 2), going, WideF(0.0f));
    });
    if (any(hidden))
      hidden = hidden_on_way(start, hidden, 1.0f, [&](WideI x_px, WideI y_px, WideM going) SHOAL_LAMBDA {
        return gather(edges.pixel.data(), y_px * WideI(edges.stride) + x_px, going, WideF(0.0f));
      });
    return lanes & !hidden;
  }

  template <class NearestEdge>
  SHOAL_INLINE WideM hidden_on_way(const LayerPoint& start, WideM lanes, float step_px, NearestEdge edge_at) {
    const WideF dx = place.x - start.x, dy = place.y - start.y, dz = place.depth - start.depth;
    const WideF length_px = select(lanes, max(abs(dx), abs(dy)), WideF(0.0f));
    const WideF wanted = min(length_px * WideF(1.0f / step_px), WideF(static_cast<float>(kMostSteps - 1)));
    const WideI steps = to_int_trunc(wanted) + WideI(1);
    const WideF share = WideF(1.0f) / to_float(steps);
    WideM hidden = mask_from_bits(0);
    for (int i = 0; i <= kMostSteps; ++i) {
      const WideM going = lanes & !hidden & (WideI(i) <= steps);
      if (none(going)) break;
      const WideF u = WideF(static_cast<float>(i)) * share;
      // As far as it gets until the next step.
      const WideF depth = min(start.depth + dz * u, start.depth + dz * min(u + share, WideF(1.0f)));
      const WideI x_px = pixel_of(start.x + dx * u), y_px = pixel_of(start.y + dy * u);
      const WideF nearest = edge_at(x_px, y_px, going & inside(x_px, y_px));
      hidden = hidden | (going & (nearest > depth * WideF(kInFront)));
    }
    return hidden;
  }

  const FrameData& f;
  const Layer& layer;
  const Ray<WideF>& ray;
  const WideF end;  // beyond the scene, along the rays
  WideI found = WideI(kNoId);
  WideF found_t = WideF(kEndless);
  LayerPoint place{WideF(0.0f), WideF(0.0f), WideF(0.0f)};  // of what is met
};

}  // namespace

MarchedHit march_hit(const FrameData& f, const Layer& layer, const Ray<WideF>& ray, WideI own, WideM lanes) {
  if (none(lanes)) return {WideI(kNoId), WideF(kEndless), lanes};
  return March(f, layer, ray).run(own, lanes);
}

}  // namespace shoal::inline SHOAL_ISA_NS
