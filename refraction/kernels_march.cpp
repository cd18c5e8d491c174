// Narrow phase under waves (refraction/narrow/march_hit.h).
#include "refraction/narrow/march_hit.h"
#include "refraction/pixel_stage.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

// Longest step across the layer, and the most steps for one part of the way.
constexpr float kStepPx = 1.0f;
constexpr int kMostSteps = 48;

// A point of the ray in the layer: pixels (sample positions) and depth as drawn. Straight lines in virtual space are
// straight and evenly deep between two of these.
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

// Where the ray leaves the scene's box.
WideF exit_distance(const RenderScene& scene, const Ray<WideF>& ray) {
  const auto axis = [](WideF origin, WideF direction, float lo, float hi) {
    const WideF far_side = select(direction > WideF(0.0f), WideF(hi), WideF(lo)) - origin;
    const WideM moves = abs(direction) > WideF(1e-9f);
    return select(moves, max(far_side / select(moves, direction, WideF(1.0f)), WideF(0.0f)), WideF(1e9f));
  };
  const Vec3f lo = scene.bounds_min_world, hi = scene.bounds_max_world;
  const Vec3<WideF>&o = ray.origin_world, &d = ray.direction_world;
  return min(min(axis(o.x, d.x, lo.x, hi.x), axis(o.y, d.y, lo.y, hi.y)), axis(o.z, d.z, lo.z, hi.z));
}

// Where the ray meets the planes of some triangles; -1 where it does not.
WideF plane_distance(const GeometryView& g, const Ray<WideF>& ray, WideI id, WideM lanes) {
  WideF t(-1.0f);
  for_each_distinct(id, lanes, [&](std::int32_t one, WideM same) SHOAL_LAMBDA {
    const Geometry::TriangleRecord& r = g.triangles[one];
    const Vec3f a = g.vertices[r.vertex[0]].position_world;
    const Vec3f e1 = g.vertices[r.vertex[1]].position_world - a, e2 = g.vertices[r.vertex[2]].position_world - a;
    const TriangleHit<WideF> hit =
        intersect_triangle(ray, broadcast<WideF>(a), broadcast<WideF>(e1), broadcast<WideF>(e2));
    t = select(same & hit.valid, hit.t, t);
  });
  return t;
}

class March {
 public:
  March(const FrameData& frame, const Layer& seen, const Ray<WideF>& along, WideM lanes)
      : f(frame), layer(seen), ray(along), open(lanes) {}

  // Follows the open lanes from one point of the layer to another.
  void advance(const LayerPoint& from, const LayerPoint& to) {
    const WideF dx = to.x - from.x, dy = to.y - from.y, dz = to.depth - from.depth;
    const WideF length_px = select(open, max(abs(dx), abs(dy)), WideF(0.0f));
    const WideF wanted = min(length_px * WideF(1.0f / kStepPx), WideF(static_cast<float>(kMostSteps)));
    const WideI steps = to_int_trunc(wanted) + WideI(1);
    const WideF share = WideF(1.0f) / to_float(steps);
    for (int i = 1; i <= kMostSteps + 1; ++i) {
      const WideM going = open & (WideI(i) <= steps);
      if (none(going)) return;
      const WideF u = WideF(static_cast<float>(i)) * share;
      step(from.x + dx * u, from.y + dy * u, from.depth + dz * u, going);
    }
  }

  WideI result() const {
    const WideM drawn = is_triangle(last_seen);
    return select(!open, found, select(hidden, select(drawn, last_seen, hider), WideI(kNoId)));
  }
  WideM unfinished() const { return open; }
  WideI found = WideI(kNoId);

 private:
  void step(WideF x, WideF y, WideF depth, WideM going) {
    const FrameGrid& grid = layer.visibility.grid;
    const WideF x_floor = floor(clamp(x, WideF(-8.0f), WideF(20000.0f))),
                y_floor = floor(clamp(y, WideF(-8.0f), WideF(20000.0f)));
    const WideI x_px = to_int_trunc(x_floor), y_px = to_int_trunc(y_floor);
    const WideM inside = going & (x_px >= WideI(0)) & (y_px >= WideI(0)) & (x_px < WideI(grid.width_px)) &
                         (y_px < WideI(grid.height_px));
    const WideI slots = pixel_slots(grid, x_px, y_px);
    const WideF drawn = gather(layer.visibility.depth.data(), slots, inside, WideF(0.0f));
    const WideM behind = inside & (drawn >= depth);
    const WideM entered = behind & !hidden;
    const WideM in_front = inside & !behind;
    hidden = (hidden & !in_front) | entered;
    if (any(entered)) {
      const WideI id = gather(layer.visibility.id.data(), slots, entered, WideI(kNoId));
      const ConfirmedHit hit = confirm_hit(f.geometry, layer.visibility, ray, id, x_px, y_px, entered);
      const WideM met = entered & hit.held;
      found = select(met, hit.id, found);
      hider = select(entered, id, hider);
      open = open & !met;
    }
    if (any(in_front)) {
      const WideI id = gather(layer.visibility.id.data(), slots, in_front, WideI(kNoId));
      last_seen = select(in_front, id, last_seen);
    }
  }

  const FrameData& f;
  const Layer& layer;
  const Ray<WideF>& ray;
  WideM open;                        // lanes that have met nothing yet
  WideM hidden = mask_from_bits(0);  // behind something in the layer
  WideI last_seen = WideI(kNoId);    // what the layer showed where the ray was last in front
  WideI hider = WideI(kNoId);
};

}  // namespace

WideI march_hit(const FrameData& f, const Layer& layer, const Ray<WideF>& ray, WideI own, WideM lanes) {
  if (none(lanes)) return WideI(kNoId);
  const WideF end = exit_distance(*f.scene, ray);
  // The way bends most evenly in two parts, at about where the ray will meet something.
  const WideM drawn = lanes & is_triangle(own);
  WideF middle = any(drawn) ? plane_distance(f.geometry, ray, own, drawn) : WideF(-1.0f);
  middle = select((middle > WideF(0.0f)) & (middle < end), middle, end * WideF(0.25f));
  const LayerPoint start = layer_point(f, layer, ray, WideF(0.0f));
  const LayerPoint between = layer_point(f, layer, ray, middle);
  March march(f, layer, ray, lanes);
  march.advance(start, between);
  if (any(march.unfinished())) march.advance(between, layer_point(f, layer, ray, end));
  return march.result();
}

}  // namespace shoal::inline SHOAL_ISA_NS
