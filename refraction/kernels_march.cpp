// Narrow phase under waves (refraction/narrow/march_hit.h).
#include "refraction/narrow/march_hit.h"
#include "refraction/narrow/triangle_plane.h"
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

class March {
 public:
  March(const FrameData& frame, const Layer& through, const Ray<WideF>& along, WideM lanes)
      : f(frame), layer(through), ray(along), open(lanes) {}

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

  WideI result() const { return select(!open, found, select(hidden, select(seen, last_seen, hider), WideI(kNoId))); }
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
      if (any(met)) occluders(x_px, y_px, drawn, met);
      hider = select(entered, id, hider);
      open = open & !met;
    }
    if (any(in_front)) {
      const WideI id = gather(layer.visibility.id.data(), slots, in_front, WideI(kNoId));
      last_seen = select(in_front, id, last_seen);
      seen = seen | in_front;
    }
  }

  // Edges are drawn where pixels' centres say: of what is met, a neighbour may show something nearer that the ray meets
  // first.
  void occluders(WideI x_px, WideI y_px, WideF drawn, WideM met) {
    constexpr float kNearer = 1.001f;
    const FrameGrid& grid = layer.visibility.grid;
    const WideI x_last(grid.width_px - 1), y_last(grid.height_px - 1);
    WideF found_t(-1.0f);
    for (int i = 0; i < 9; ++i) {
      if (i == 4) continue;
      const WideI x = min(max(x_px + WideI(i % 3 - 1), WideI(0)), x_last);
      const WideI y = min(max(y_px + WideI(i / 3 - 1), WideI(0)), y_last);
      const WideI slots = pixel_slots(grid, x, y);
      const WideF depth = gather(layer.visibility.depth.data(), slots, met, WideF(0.0f));
      const WideM nearer = met & (depth > drawn * WideF(kNearer));
      if (none(nearer)) continue;
      const WideI id = gather(layer.visibility.id.data(), slots, nearer, WideI(kNoId));
      const TriangleTest test = test_triangles(f.geometry, ray, id, nearer & (id != found));
      if (none(test.inside)) continue;
      if (all(found_t == WideF(-1.0f))) found_t = test_triangles(f.geometry, ray, found, met).t;
      const WideM first = test.inside & (test.t < found_t);
      found = select(first, id, found);
      found_t = select(first, test.t, found_t);
    }
  }

  const FrameData& f;
  const Layer& layer;
  const Ray<WideF>& ray;
  WideM open;                        // lanes that have met nothing yet
  WideM seen = mask_from_bits(0);    // in front of something, or of nothing, at some time
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
  WideF middle = any(drawn) ? triangle_plane_distance(f.geometry, ray, own, drawn) : WideF(-1.0f);
  middle = select((middle > WideF(0.0f)) & (middle < end), middle, end * WideF(0.25f));
  const LayerPoint start = layer_point(f, layer, ray, WideF(0.0f));
  const LayerPoint between = layer_point(f, layer, ray, middle);
  March march(f, layer, ray, lanes);
  march.advance(start, between);
  if (any(march.unfinished())) march.advance(between, layer_point(f, layer, ray, end));
  return march.result();
}

}  // namespace shoal::inline SHOAL_ISA_NS
