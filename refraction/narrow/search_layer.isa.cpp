// Rays against the triangles of a layer (refraction/narrow/search_layer.h).
#include "refraction/narrow/search_layer.h"

#include "raster/blocks.h"
#include "raster/triangle_test.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

// The point that stands for the end of a ray that hits nothing, metres along it.
constexpr float kFar_m = 1e4f;
// Two points along a ray that are farther from each other than this are of two surfaces, in pixels' widths there.
constexpr float kApart_px = 4.0f;
// A ray that passes a triangle no farther than this may hit the surface that the triangle belongs to.
constexpr float kNear_px = 3.0f;
// A triangle smaller than this may be the only one of its surface that has a sample.
constexpr float kSmall_px = 2.0f;
// A point farther than this from a pixel's centre lies towards the neighbour on that side.
constexpr float kToward_px = 0.2f;

struct Pixels {
  WideI x, y;
};

// Places far outside of any frame are brought to where integers can hold them.
Pixels pixels_at(const LayerPlace<WideF>& place) {
  const auto whole = [](WideF v)
                         SHOAL_LAMBDA { return to_int_trunc(floor(clamp(v, WideF(-30000.0f), WideF(30000.0f)))); };
  return {whole(place.x_px), whole(place.y_px)};
}
Pixels select_pixels(WideM m, const Pixels& a, const Pixels& b) { return {select(m, a.x, b.x), select(m, a.y, b.y)}; }

// A triangle that rays may hit.
struct Candidate {
  WideI id = WideI(kNoId);
  WideF t = WideF(3e38f);     // of its plane
  WideF size2 = WideF(0.0f);  // square of its longest edge at the first corner
  Pixels at{WideI(0), WideI(0)};
  void replace(WideM m, WideI other_id, WideF other_t, WideF other_size2, const Pixels& other_at) {
    id = select(m, other_id, id), t = select(m, other_t, t), size2 = select(m, other_size2, size2);
    at = select_pixels(m, other_at, at);
  }
  void replace(WideM m, const Candidate& c) { replace(m, c.id, c.t, c.size2, c.at); }
};

// The triangles at sixteen pixels, and where the rays hit their planes.
struct Tested {
  WideM shown = mask_from_bits(0);  // there is a triangle
  WideM ahead = mask_from_bits(0);  // and the ray goes to its plane
  WideM hit = mask_from_bits(0);    // and hits it
  WideI id = WideI(kNoId);
  WideF t = WideF(0.0f), size2 = WideF(0.0f);
};

class Search {
 public:
  //   pixel_m  the width of a pixel about where the rays go
  Search(const LayerView& layer, const Ray<WideF>& ray, WideI& fetches, WideF pixel_m)
      : layer_(layer), ray_(ray), fetches_(fetches), passed_by2_(pixel_m * pixel_m * WideF(kNear_px * kNear_px)) {}

  // Fetches and tests. The nearest hit so far is kept, and, of the nearest layer, the nearest triangle that is passed
  // closely.
  Tested test(LayerSlice slice, const Pixels& at, WideM lanes) {
    const FetchedTriangle<WideF> f = layer_.fetch<WideF>(slice, at.x, at.y, lanes, fetches_, hit.id);
    Tested r;
    r.shown = f.shown, r.id = f.id;
    if (none(f.shown)) return r;
    const TriangleHit<WideF> plane = intersect_triangle(ray_, f.p0, f.e1, f.e2);
    const Vec3<WideF> normal = cross(f.e1, f.e2);
    // One-sided triangles are hit from their front alone.
    const WideM faces = (!f.one_sided) | (dot(ray_.direction_world, normal) < WideF(0.0f));
    r.t = plane.t;
    r.ahead = f.shown & faces & plane.valid & (plane.t > WideF(0.0f)) & (plane.t < WideF(kFar_m));
    const WideF outside = max(max(-plane.u, -plane.v), plane.u + plane.v - WideF(1.0f));
    r.hit = r.ahead & (outside <= WideF(kSlack));
    const WideM nearer = r.hit & ((r.t < hit.t) | ((r.t == hit.t) & (f.id < hit.id)));
    r.size2 = max(dot(f.e1, f.e1), dot(f.e2, f.e2));
    hit.replace(nearer, f.id, r.t, r.size2, at);
    if (slice == LayerSlice::kNearest) {
      const WideF by2 = outside * outside * r.size2;
      const WideM close = r.ahead & !r.hit & (by2 < passed_by2_) & (r.t < hit.t);
      passed.replace(close, f.id, r.t, r.size2, at);
      passed_by2_ = select(close, by2, passed_by2_);
    }
    return r;
  }

  Vec3<WideF> point(WideF t) const { return ray_.origin_world + ray_.direction_world * t; }
  LayerPlace<WideF> place(WideF t) const { return layer_.place_of(point(t)); }

  // The lanes whose ray passes between the samples of a surface: it hits the plane of the triangle at a pixel in a
  // point that the same pixel shows, and the surface goes on to the neighbours on that side.
  WideM passes_between(const Candidate& c, WideM lanes) {
    const Pixels& at = c.at;
    const WideF t = c.t;
    const LayerPlace<WideF> point_at = place(t);
    const Pixels own = pixels_at(point_at);
    WideM there = lanes & (own.x == at.x) & (own.y == at.y);
    if (none(there)) return there;
    const WideF off_x = point_at.x_px - to_float(at.x) - WideF(0.5f),
                off_y = point_at.y_px - to_float(at.y) - WideF(0.5f);
    const WideI dx = select(off_x > WideF(0.0f), WideI(1), WideI(-1)),
                dy = select(off_y > WideF(0.0f), WideI(1), WideI(-1));
    const WideM toward_x = abs(off_x) > WideF(kToward_px), toward_y = abs(off_y) > WideF(kToward_px);
    const WideF pixel_m = layer_.pixel_m(point_at.depth_m), apart = pixel_m * WideF(kApart_px);
    const WideM large = c.size2 > pixel_m * pixel_m * WideF(kSmall_px * kSmall_px);
    const auto check = [&](const Pixels& neighbour, WideM concerned) SHOAL_LAMBDA {
      concerned = concerned & there & large;
      if (none(concerned)) return;
      const Tested n = test(LayerSlice::kNearest, neighbour, concerned);
      there = there & !(concerned & !(n.ahead & (abs(n.t - t) < apart)));
    };
    check({at.x + dx, at.y}, toward_x);
    check({at.x, at.y + dy}, toward_y);
    check({at.x + dx, at.y + dy}, toward_x & toward_y);
    return there;
  }

  WideM found() const { return hit.id != WideI(kNoId); }

  Candidate hit;     // the nearest hit
  Candidate passed;  // the triangle of the nearest layer that is passed most closely before the hit

 private:
  static constexpr float kSlack = 1e-5f;  // as test_triangle's
  const LayerView& layer_;
  const Ray<WideF>& ray_;
  WideI& fetches_;
  WideF passed_by2_;  // squared distance of the ray from that triangle
};

// Is there an edge of the layer in the bounds of the block and of its lanes' places?
bool way_has_edge(const LayerView& layer, int x_px, int y_px, const Pixels& end, WideM lanes) {
  const int x0 = reduce_min(select(lanes, end.x, WideI(x_px))), x1 = reduce_max(select(lanes, end.x, WideI(x_px)));
  const int y0 = reduce_min(select(lanes, end.y, WideI(y_px))), y1 = reduce_max(select(lanes, end.y, WideI(y_px)));
  constexpr int kLast = kBlockSize - 1;
  return layer.edge_within(min(x0, x_px), min(y0, y_px), max(x1, x_px + kLast), max(y1, y_px + kLast));
}

}  // namespace

LayerHits search_layer(const LayerView& layer, const LayerSearch& how, int x_px, int y_px, const Ray<WideF>& ray,
                       WideM lanes, WideI& fetches) {
  LayerHits out;
  if (none(lanes)) return out;
  const Pixels own{WideI(x_px) + block_x(), WideI(y_px) + block_y()};
  Search search(layer, ray, fetches, layer.pixel_m(layer.depth_at<WideF>(x_px, y_px)));
  Pixels at = own;

  // 1 Planes.
  Candidate last;     // the last triangle whose plane the ray goes to
  Candidate between;  // the triangle between whose samples and its neighbours' the ray passes
  WideM open = lanes, vanished = mask_from_bits(0);  // nothing is shown where the ray vanishes
  WideM at_end = mask_from_bits(0);                  // the place is that of the ray's end
  for (int step = 0;; ++step) {
    const Tested tested = search.test(LayerSlice::kNearest, at, open);
    last.replace(open & tested.ahead, tested.id, tested.t, tested.size2, at);
    open = open & !tested.hit;
    vanished = vanished | (open & at_end & !tested.shown);
    open = open & !vanished;
    if (none(open)) break;
    at_end = !tested.ahead;
    const Pixels next = pixels_at(search.place(select(tested.ahead, tested.t, WideF(kFar_m))));
    const WideM stays = open & (next.x == at.x) & (next.y == at.y);
    if (step == how.planes || none(open & !stays)) break;
    at = select_pixels(open, next, at);
  }
  if (any(open)) between.replace(search.passes_between(last, open & (last.id != WideI(kNoId))), last);

  // A triangle may be hit at a place where the layer shows another.
  if (any(search.found())) at = select_pixels(search.found(), pixels_at(search.place(search.hit.t)), at);

  // 2 Neighbours, of all rays where an edge is near.
  const bool edges = how.beside_edges && way_has_edge(layer, x_px, y_px, at, lanes);
  const WideM around = edges ? lanes : open;
  if (how.neighbours && any(around))
    for (int i = 0; i < 9; ++i)
      search.test(LayerSlice::kNearest, {at.x + WideI(i % 3 - 1), at.y + WideI(i / 3 - 1)}, around);

  // 3, 4 The way, from the far end, and what is behind.
  open = lanes & !search.found() & !vanished;
  const WideM along = edges ? lanes : open;
  const bool behind = how.behind && layer.has_behind();
  if (any(along)) {
    if (behind) search.test(LayerSlice::kBehind, at, along);
    const WideF dx = to_float(at.x - own.x), dy = to_float(at.y - own.y);
    const WideM tests = along & (max(abs(dx), abs(dy)) >= WideF(1.0f));
    for (int i = how.way; i > 0 && any(tests); --i) {
      const WideF share(static_cast<float>(i) / static_cast<float>(how.way + 1));
      const Pixels there{own.x + to_int_trunc(floor(dx * share + WideF(0.5f))),
                         own.y + to_int_trunc(floor(dy * share + WideF(0.5f)))};
      search.test(LayerSlice::kNearest, there, tests);
      if (behind && (i & 3) == 0) search.test(LayerSlice::kBehind, there, tests);
    }
  }

  // 5 Surfaces that were passed closely before the hit: two more planes from there.
  {
    const Candidate passed = search.passed;
    const auto before = [&](const Candidate& c) SHOAL_LAMBDA {
      const WideF apart = layer.pixel_m(layer.depth_at<WideF>(x_px, y_px)) * WideF(kApart_px);
      return along & (c.t + apart < search.hit.t) & (c.t + apart < between.t);
    };
    WideM closer = before(passed);
    if (any(closer)) {
      Pixels there = pixels_at(search.place(passed.t));
      Tested tested = search.test(LayerSlice::kNearest, there, closer);
      closer = closer & !tested.hit & tested.ahead;
      const Pixels next = pixels_at(search.place(tested.t));
      const WideM moves = closer & !((next.x == there.x) & (next.y == there.y));
      if (any(moves)) {
        const Tested second = search.test(LayerSlice::kNearest, next, moves);
        closer = closer & !(moves & !(second.ahead & !second.hit));
        tested.t = select(moves, second.t, tested.t), tested.id = select(moves, second.id, tested.id);
        tested.size2 = select(moves, second.size2, tested.size2);
        there = select_pixels(moves, next, there);
      }
      Candidate c;
      c.replace(closer, tested.id, tested.t, tested.size2, there);
      closer = closer & before(c);
      if (any(closer)) between.replace(search.passes_between(c, closer), c);
    }
  }

  // 6 Between samples; and what is left: the background, or the last candidate.
  const WideF apart = layer.pixel_m(layer.depth_at<WideF>(x_px, y_px)) * WideF(kApart_px);
  out.approximate = lanes & (between.t + apart < search.hit.t);
  search.hit.replace(out.approximate, between);
  open = lanes & !search.found() & !vanished;
  if (any(open)) {
    const Tested beyond = search.test(LayerSlice::kNearest, pixels_at(search.place(WideF(kFar_m))), open);
    open = open & beyond.shown & !beyond.hit;
    search.hit.replace(open, select(last.id == WideI(kNoId), beyond.id, last.id), last.t, last.size2, at);
    out.approximate = out.approximate | open;
  }
  out.id = search.hit.id, out.t = search.hit.t;
  return out;
}

}  // namespace shoal::inline SHOAL_ISA_NS
