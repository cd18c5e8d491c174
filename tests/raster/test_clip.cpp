// Clipping: what the clipper makes, in double; the exact oracle on the clipped, snapped vertices; and no hole or double
// hit along the edges of meshes that go through near plane, guard band, a world plane and the tessellator.
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "coverage_oracle.h"

using namespace shoal_test;

namespace {

Vec3d to_double(Vec3f v) { return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)}; }

// The camera's transform as a plain vertex program.
struct CameraProgram {
  static constexpr bool kWarped = false;
  const View& view;
  template <class F>
  ClipVertex<F> vertex(Vec3<F> p) const {
    return project(view, p);
  }
  bool meshlet_outside(const Meshlet&) const { return false; }
};

// The same, clipped by a world plane and split to a length: what a broad phase does, without bending anything.
struct SplitProgram {
  static constexpr bool kWarped = true;
  const View& view;
  Plane plane;
  float longest_m;
  template <class F>
  ClipVertex<F> vertex(Vec3<F> p) const {
    return project(view, p);
  }
  bool meshlet_outside(const Meshlet&) const { return false; }
  Plane clip_plane() const { return plane; }
  WideM inside(Vec3<WideF> p) const {
    return dot(broadcast<WideF>(plane.normal_world), p) + WideF(plane.offset_m) >= WideF(0.0f);
  }
  WideM edge_bends(Vec3<WideF> a, Vec3<WideF> b) const { return dot(b - a, b - a) > WideF(longest_m * longest_m); }
  bool meshlet_inside(const Meshlet&) const { return false; }
  bool meshlet_bends(const Meshlet&) const { return true; }
  bool box_outside_view(Vec3f, Vec3f) const { return false; }
};

Camera random_camera(TestRandom& random, Vec3f eye, double pitch_lo, double pitch_hi) {
  const double yaw = random.real(0, 6.28), pitch = random.real(pitch_lo, pitch_hi), roll = random.real(-0.6, 0.6);
  const Vec3d f{std::cos(pitch) * std::cos(yaw), std::sin(pitch), std::cos(pitch) * std::sin(yaw)};
  const Vec3d r{-std::sin(yaw), 0, std::cos(yaw)}, u = cross(r, f);
  const Vec3d right = r * std::cos(roll) + u * std::sin(roll), up = cross(right, f);
  const auto to_float = [](Vec3d v) {
    return Vec3f{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
  };
  Camera c;
  c.position_world = eye;
  c.forward_world = to_float(f), c.right_world = to_float(right), c.up_world = to_float(up);
  return c;
}

// A level sheet [-40, 40]^2 at y = -1 as a jittered grid.
constexpr double kSheet_m = 40.0;
Geometry level_sheet(int cells, TestRandom& random) {
  std::vector<Vec3f> p;
  std::vector<std::uint32_t> indices;
  const double cell = 2 * kSheet_m / cells;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      const bool rim = i == 0 || j == 0 || i == cells || j == cells;
      const double jitter = rim ? 0.0 : 0.3 * cell;
      p.push_back({random.in(-jitter, jitter) + static_cast<float>(i * cell - kSheet_m), -1.0f,
                   random.in(-jitter, jitter) + static_cast<float>(j * cell - kSheet_m)});
    }
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const std::uint32_t a = static_cast<std::uint32_t>(j * (cells + 1) + i), b = a + 1,
                          c = a + static_cast<std::uint32_t>(cells) + 1, d = c + 1;
      indices.insert(indices.end(), {a, b, d, a, d, c});
    }
  return geometry_of(p, indices);
}

// Does the line of sight through a point of the frame meet the part of the sheet that is kept, in front of the near
// plane?
bool sees_sheet(const View& view, double x_px, double y_px, const Plane* keep) {
  const double dx = x_px - static_cast<double>(view.centre_px.x), dy = y_px - static_cast<double>(view.centre_px.y);
  const Vec3d across = to_double(view.ray_dx) * dx + to_double(view.ray_dy) * dy;
  Vec3d origin = to_double(view.camera.position_world), direction = to_double(view.camera.forward_world);
  (view.camera.orthographic ? origin : direction) = (view.camera.orthographic ? origin : direction) + across;
  const double t = (-1.0 - origin.y) / direction.y;
  if (!(t >= static_cast<double>(view.camera.near_m))) return false;
  const Vec3d hit = origin + direction * t;
  if (std::fabs(hit.x) > kSheet_m || std::fabs(hit.z) > kSheet_m) return false;
  return keep == nullptr || dot(to_double(keep->normal_world), hit) + static_cast<double>(keep->offset_m) >= 0;
}

struct SheetCount {
  long inside = 0, outside = 0, holes = 0, doubles = 0, strays = 0;
};

// Pixels that are in or out by more than the snapping's reach must be covered once or not at all; none ever twice.
void check_sheet(const Coverage& seen, const View& view, const Plane* keep, SheetCount& total) {
  constexpr double kMargin_px = 0.02;
  for (int y = 0; y < seen.height_px; ++y)
    for (int x = 0; x < seen.width_px; ++x) {
      const std::uint32_t count = seen.count[seen.at(x, y)];
      int hits = 0;
      for (int k = 0; k < 9; ++k)
        hits += sees_sheet(view, x + 0.5 + (k % 3 - 1) * kMargin_px, y + 0.5 + (k / 3 - 1) * kMargin_px, keep);
      total.inside += hits == 9, total.outside += hits == 0;
      total.holes += hits == 9 && count == 0;
      total.doubles += count > 1;
      total.strays += hits == 0 && count != 0;
    }
}

// The grid position of a clip vertex, its division in float and its rounding to even by the library.
std::array<std::int64_t, 2> on_grid(const ClipVertex<float>& v, Vec2f centre) {
  const float rw = 1.0f / v.w, limit = 16384.0f;
  const float x = std::clamp(v.x * rw, -limit, limit) + centre.x, y = std::clamp(v.y * rw, -limit, limit) + centre.y;
  return {static_cast<std::int64_t>(std::nearbyint(static_cast<double>(x) * 256.0)),
          static_cast<std::int64_t>(std::nearbyint(static_cast<double>(y) * 256.0))};
}

bool in_guard(const ClipVertex<float>& v) {
  return v.w > 0 && v.z <= v.w && std::fabs(v.x) <= 16384.0f * v.w && std::fabs(v.y) <= 16384.0f * v.w;
}

}  // namespace

TEST_CASE("clip: the clipped polygon is the triangle's part inside of near plane and guard band") {
  TestRandom random(11);
  double worst = 0, lost = 0;
  int clipped = 0;
  for (int round = 0; round < 4000; ++round) {
    const float near_m = 0.05f;
    ClipVertex<float> v[3];
    const double reach = std::pow(10.0, random.real(0, 6));
    for (auto& c : v) c = {random.in(-reach, reach), random.in(-reach, reach), near_m, random.in(-2, 20)};
    const Polygon<ClipVertex<float>> p = clip_to_guard(v[0], v[1], v[2]);
    clipped += p.count > 0;
    for (int i = 0; i < p.count; ++i) {
      const ClipVertex<float>& q = p.vertex[i];
      const double x = q.x, y = q.y, w = q.w;
      CHECK(w > 0);
      // Inside up to rounding...
      lost = std::max({lost, (static_cast<double>(near_m) - w) / 20, (std::fabs(x) / 16384 - w) / 20,
                       (std::fabs(y) / 16384 - w) / 20});
      // ... and on the triangle: the distance from its plane in (x, y, w), scaled to the unit cube.
      const auto scaled = [&](const ClipVertex<float>& c) {
        return Vec3d{static_cast<double>(c.x) / reach, static_cast<double>(c.y) / reach, static_cast<double>(c.w) / 20};
      };
      const Vec3d a = scaled(v[0]), n = cross(scaled(v[1]) - a, scaled(v[2]) - a);
      const double length = std::sqrt(dot(n, n));
      if (length > 1e-2) worst = std::max(worst, std::fabs(dot(scaled(q) - a, n)) / length);
    }
  }
  CHECK(clipped > 1000);
  CAPTURE(worst, lost);
  CHECK(worst < 1e-6);
  CHECK(lost < 1e-6);
}

TEST_CASE("clip: a triangle cut by a world plane keeps its area on the kept side") {
  TestRandom random(12);
  double worst = 0;
  for (int round = 0; round < 2000; ++round) {
    Vec3f p[3];
    for (Vec3f& v : p) v = {random.in(-5, 5), random.in(-5, 5), random.in(-5, 5)};
    const Plane plane{{0.6f, 0.0f, 0.8f}, random.in(-3, 3)}, other{{-0.6f, 0.0f, -0.8f}, -plane.offset_m};
    const auto area = [](const Polygon<Vec3f>& q) {
      Vec3d sum{0, 0, 0};
      for (int i = 2; i < q.count; ++i)
        sum = sum + cross(to_double(q.vertex[i - 1]) - to_double(q.vertex[0]),
                          to_double(q.vertex[i]) - to_double(q.vertex[0]));
      return sum;
    };
    const Vec3d whole = cross(to_double(p[1]) - to_double(p[0]), to_double(p[2]) - to_double(p[0]));
    const Vec3d parts = area(clip_to_plane(p[0], p[1], p[2], plane)) + area(clip_to_plane(p[0], p[1], p[2], other));
    const Vec3d gap = whole - parts;
    worst = std::max(worst, std::sqrt(dot(gap, gap)));
  }
  CHECK(worst < 3e-5);
}

TEST_CASE("clip: two triangles that share an edge get the same bits where it is cut") {
  TestRandom random(16);
  long shared = 0, different = 0;
  const auto same = [](const ClipVertex<float>& a, const ClipVertex<float>& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w;
  };
  for (int round = 0; round < 20000; ++round) {
    ClipVertex<float> v[4];
    const double reach = std::pow(10.0, random.real(3, 6));
    for (auto& c : v) c = {random.in(-reach, reach), random.in(-reach, reach), 0.05f, random.in(-5, 20)};
    const Polygon<ClipVertex<float>> p = clip_to_guard(v[0], v[1], v[2]), q = clip_to_guard(v[1], v[0], v[3]);
    // New corners of p on the shared edge, by their distance from it in (x, y, w) scaled to the unit cube.
    const auto scaled = [&](const ClipVertex<float>& c) {
      return Vec3d{static_cast<double>(c.x) / reach, static_cast<double>(c.y) / reach, static_cast<double>(c.w) / 20};
    };
    const Vec3d a = scaled(v[0]), edge = scaled(v[1]) - a;
    for (int i = 0; i < p.count; ++i) {
      const Vec3d r = scaled(p.vertex[i]) - a;
      const double along = dot(r, edge) / dot(edge, edge);
      const Vec3d off = r - edge * along;
      if (along < 0.01 || along > 0.99 || std::sqrt(dot(off, off)) > 1e-6) continue;
      ++shared;
      different += std::none_of(q.vertex, q.vertex + q.count, [&](const auto& c) { return same(c, p.vertex[i]); });
    }
    Vec3f w[4];
    for (Vec3f& c : w) c = {random.in(-5, 5), random.in(-5, 5), random.in(-5, 5)};
    const Plane plane{{0.6f, 0.0f, 0.8f}, random.in(-3, 3)};
    const Polygon<Vec3f> s = clip_to_plane(w[0], w[1], w[2], plane), t = clip_to_plane(w[1], w[0], w[3], plane);
    const bool cut = (plane_distance(plane, w[0]) >= 0) != (plane_distance(plane, w[1]) >= 0);
    int equal = 0;
    for (int i = 0; i < s.count; ++i)
      for (int j = 0; j < t.count; ++j)
        equal += s.vertex[i].x == t.vertex[j].x && s.vertex[i].y == t.vertex[j].y && s.vertex[i].z == t.vertex[j].z;
    shared += cut;
    different += cut && equal != 2;  // the edge's inner end, and the cut
  }
  CAPTURE(shared, different);
  CHECK(shared > 10000);
  CHECK(different == 0);
}

TEST_CASE("clip: coverage equals the exact oracle on the clipped and snapped vertices") {
  TestRandom random(13);
  for (int round = 0; round < 30; ++round) {
    const int width = round % 3 == 0 ? 64 : 131, height = round % 3 == 0 ? 64 : 77;
    Camera camera = random_camera(random, {0, 0, 0}, -1.2, 1.2);
    camera.orthographic = round % 10 == 9;
    camera.xmag_m = 0.002f, camera.ymag_m = 0.001f;  // 40 m are far beyond the guard band
    const View view = make_view(camera, width, height, {0, 0});
    std::vector<Vec3f> p;
    std::vector<std::uint32_t> indices;
    for (std::uint32_t i = 0; i < 120; ++i) {
      const double reach = std::pow(10.0, random.real(-2, 4));
      p.push_back({random.in(-reach, reach), random.in(-reach, reach), random.in(-reach, reach)});
      indices.push_back(i);
    }
    std::vector<GridTriangle> expected;
    int cut = 0;
    for (std::size_t t = 0; t < indices.size(); t += 3) {
      ClipVertex<float> v[3];
      for (std::size_t k = 0; k < 3; ++k) v[k] = project(view, p[t + k]);
      Polygon<ClipVertex<float>> q{{v[0], v[1], v[2]}, 3};
      if (!(in_guard(v[0]) && in_guard(v[1]) && in_guard(v[2]))) {
        q = clip_to_guard(v[0], v[1], v[2]);
        cut += q.count > 2;
      }
      for (int i = 2; i < q.count; ++i) {
        GridTriangle g{};
        g.id = static_cast<std::int32_t>(t / 3);
        const int corners[3] = {0, i - 1, i};
        for (int k = 0; k < 3; ++k) {
          const auto at = on_grid(q.vertex[corners[k]], view.centre_px);
          g.x[k] = at[0], g.y[k] = at[1];
        }
        expected.push_back(g);
      }
    }
    const Geometry geometry = geometry_of(p, indices);
    for (const bool two_sided : {true, false}) {
      const PassSettings pass = whole_frame(width, height, view.centre_px, round % 2 == 0 ? 16 : 64);
      const Coverage seen = raster_coverage(geometry, CameraProgram{view}, pass, two_sided, 1);
      INFO("round " << round << ", " << cut << " of 40 triangles cut");
      CHECK(seen == oracle_coverage(expected, width, height, two_sided));
    }
    CHECK(cut > 5);
  }
}

TEST_CASE("clip: a sheet through the eye's plane and the guard band has no hole and no double hit") {
  TestRandom random(14);
  SheetCount total;
  for (int round = 0; round < 60; ++round) {
    // From far above the sheet to closer than the near plane.
    const float height = std::pow(10.0f, random.in(-3, 1));
    Camera camera = random_camera(random, {random.in(-5, 5), height - 1.0f, random.in(-5, 5)}, -1.5, 0.3);
    camera.tan_half_yfov = random.in(0.2, 1.5);
    const View view = make_view(camera, 131, 77, {0, 0});
    const Geometry g = level_sheet(round % 2 == 0 ? 1 : 7, random);
    const PassSettings pass = whole_frame(131, 77, view.centre_px, 32);
    check_sheet(raster_coverage(g, CameraProgram{view}, pass, true, 1), view, nullptr, total);
  }
  CHECK(total.inside > 100000);
  CHECK(total.outside > 10000);
  CHECK(total.holes == 0);
  CHECK(total.doubles == 0);
  CHECK(total.strays == 0);
}

TEST_CASE("clip: a sheet cut by a world plane and split into small triangles has no hole and no double hit") {
  TestRandom random(15);
  SheetCount total;
  for (int round = 0; round < 40; ++round) {
    Camera camera = random_camera(random, {random.in(-5, 5), random.in(-0.9, 4), random.in(-5, 5)}, -1.5, 0.0);
    camera.orthographic = round % 8 == 7;
    camera.xmag_m = 6, camera.ymag_m = 4;
    const View view = make_view(camera, 131, 77, {0, 0});
    const double angle = random.real(0, 6.28);
    const Plane keep{{static_cast<float>(std::cos(angle)), 0, static_cast<float>(std::sin(angle))}, random.in(-1, 8)};
    const SplitProgram program{view, keep, random.in(4, 20)};
    const Geometry g = level_sheet(round % 2 == 0 ? 2 : 7, random);
    const PassSettings pass = whole_frame(131, 77, view.centre_px, 64);
    check_sheet(raster_coverage(g, program, pass, true, 2), view, &keep, total);
  }
  CHECK(total.inside > 80000);
  CHECK(total.outside > 10000);
  CHECK(total.holes == 0);
  CHECK(total.doubles == 0);
  CHECK(total.strays == 0);
}
