// Depth at covered pixels, ties, and what resolve interpolates, against double precision.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <vector>

#include "coverage_oracle.h"
#include "raster/resolve.h"
#include "shading/textures/sample.h"

using namespace shoal_test;

namespace {

constexpr double kEps = 1.0 / 16777216.0;  // half a unit in the last place, relative

Vec3d to_double(Vec3f v) { return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)}; }
double norm(Vec3d v) { return std::sqrt(dot(v, v)); }

VisibilityBuffer draw(const Geometry& g, const std::vector<DrawState>& draw_states, const PassSettings& pass,
                      const PixelProgram& program, std::uint32_t per_work_item, bool reversed_items = false) {
  std::vector<WorkItemBins> work_items = bin_geometry(g, draw_states, program, pass, per_work_item);
  std::vector<WorkItemBins> ordered;
  for (std::size_t i = 0; i < work_items.size(); ++i)
    ordered.push_back(std::move(work_items[reversed_items ? work_items.size() - 1 - i : i]));
  VisibilityBuffer out;
  draw_tiles(ordered, pass, KeepAll{}, out);
  return out;
}

std::vector<DrawState> two_sided() { return {{.double_sided = true}}; }

// Depth of a triangle's plane at a pixel in double, and how far float's rounding of the plane's terms can be off.
struct PlaneDepth {
  double depth, scale;
};
PlaneDepth plane_depth(const GridTriangle& t, const float d[3], int x_px, int y_px) {
  const double x1 = static_cast<double>(t.x[1] - t.x[0]), y1 = static_cast<double>(t.y[1] - t.y[0]);
  const double x2 = static_cast<double>(t.x[2] - t.x[0]), y2 = static_cast<double>(t.y[2] - t.y[0]);
  const double e1 = static_cast<double>(d[1]) - static_cast<double>(d[0]),
               e2 = static_cast<double>(d[2]) - static_cast<double>(d[0]);
  const double area = x1 * y2 - y1 * x2;
  const double x = x_px * 256.0 + 128 - static_cast<double>(t.x[0]),
               y = y_px * 256.0 + 128 - static_cast<double>(t.y[0]);
  const double depth = static_cast<double>(d[0]) + (x * (e1 * y2 - e2 * y1) + y * (e2 * x1 - e1 * x2)) / area;
  const double scale =
      std::fabs(static_cast<double>(d[0])) + (std::fabs(x) * (std::fabs(e1 * y2) + std::fabs(e2 * y1)) +
                                              std::fabs(y) * (std::fabs(e2 * x1) + std::fabs(e1 * x2))) /
                                                 std::fabs(area);
  return {depth, scale};
}

// A random camera anywhere round the origin, up to grazing, and its frame.
View random_view(TestRandom& random, bool orthographic) {
  const double yaw = random.real(0, 6.28), pitch = random.real(-1.5, 1.5);
  Camera c;
  c.forward_world = {static_cast<float>(std::cos(pitch) * std::cos(yaw)), static_cast<float>(std::sin(pitch)),
                     static_cast<float>(std::cos(pitch) * std::sin(yaw))};
  c.right_world = {static_cast<float>(-std::sin(yaw)), 0, static_cast<float>(std::cos(yaw))};
  c.up_world = cross(c.right_world, c.forward_world);
  c.position_world = {random.in(-20, 20), random.in(-5, 5), random.in(-20, 20)};
  c.orthographic = orthographic;
  c.xmag_m = 3, c.ymag_m = 2;
  return make_view(c, 1280, 720, {0, 0});
}

// A pixel's hit on a triangle's plane, in double from the view's own numbers.
struct DoubleHit {
  double t, u, v, cosine;
  Vec3d position;
};
DoubleHit double_hit(const View& view, const Vec3d p[3], double x_px, double y_px) {
  const double dx = x_px - static_cast<double>(view.centre_px.x), dy = y_px - static_cast<double>(view.centre_px.y);
  const Vec3d across = to_double(view.ray_dx) * dx + to_double(view.ray_dy) * dy;
  Vec3d o = to_double(view.camera.position_world), d = to_double(view.camera.forward_world);
  if (view.camera.orthographic)
    o = o + across;
  else
    d = d + across;
  const Vec3d n = cross(p[1] - p[0], p[2] - p[0]);
  const double t = dot(p[0] - o, n) / dot(d, n);
  const Vec3d hit = o + d * t, r = hit - p[0];
  const double u = dot(cross(r, p[2] - p[0]), n) / dot(n, n), v = dot(cross(p[1] - p[0], r), n) / dot(n, n);
  return {t, u, v, std::fabs(dot(d, n)) / (norm(d) * norm(n)), hit};
}

}  // namespace

// Error: depth is within 6 x 2^-24 (measured: 4.1) of the sum of the magnitudes of the plane's terms, and never out of
// the corners' range.
TEST_CASE("depth: at covered pixels as the plane of the snapped corners in double") {
  TestRandom random(21);
  double worst = 0;
  long pixels = 0, out_of_range = 0;
  const std::vector<DrawState> draw_states = two_sided();
  for (int round = 0; round < 400; ++round) {
    const int width = round % 7 == 0 ? 16384 : 200, height = round % 7 == 0 ? 4 : 130;
    const Vec2f centre{static_cast<float>(width) * 0.5f, static_cast<float>(height) * 0.5f};
    GridMesh m;
    std::uint32_t v[3];
    const double reach = std::pow(10.0, random.real(0.3, 4.2));
    for (std::uint32_t& k : v) {
      const float depth =
          round % 3 == 0 ? random.in(0.5, 0.50001) : static_cast<float>(std::pow(10.0, random.real(-5, 0)));
      k = m.vertex(
          static_cast<std::int64_t>(random.real(-0.5, 0.5) * std::min(reach, width + 200.0) * 256 + width * 128),
          static_cast<std::int64_t>(random.real(-0.5, 0.5) * reach * 256 + height * 128), depth);
    }
    m.triangle(v[0], v[1], v[2]);
    const GridTriangle t = m.triangles()[0];
    if (side_of(t, 0, 1, t.x[2], t.y[2]) == 0) continue;
    const float d[3] = {m.positions[0].z, m.positions[1].z, m.positions[2].z};
    const Geometry g = geometry_of(m.positions, m.indices);
    const VisibilityBuffer out = draw(g, draw_states, whole_frame(width, height, centre, 64), PixelProgram{centre}, 1);
    const float lo = std::min({d[0], d[1], d[2]}), hi = std::max({d[0], d[1], d[2]});
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const std::size_t slot = out.grid.slot(x, y);
        if (out.id[slot] != 0) continue;
        ++pixels;
        const float depth = out.depth[slot];
        out_of_range += depth < lo || depth > hi;
        const PlaneDepth expected = plane_depth(t, d, x, y);
        worst = std::max(worst, std::fabs(static_cast<double>(depth) - expected.depth) / expected.scale);
      }
  }
  CAPTURE(pixels, worst / kEps);
  CHECK(pixels > 100000);
  CHECK(out_of_range == 0);
  CHECK(worst < 6 * kEps);
}

TEST_CASE(
    "depth: the nearest triangle shows, the smaller id where depths are equal, whatever order, tile or work item") {
  TestRandom random(22);
  const int width = 131, height = 77;
  const Vec2f centre{65.5f, 38.5f};
  GridMesh m;
  // Few depths, so that many pixels are ties between several triangles, small and large.
  for (int i = 0; i < 1500; ++i) {
    const float depth = 0.25f * static_cast<float>(random.integer(1, 3));
    const std::int64_t reach = i % 4 == 0 ? 60000 : 4000, x = random.integer(0, width * 256),
                       y = random.integer(0, height * 256);
    std::uint32_t v[3];
    for (std::uint32_t& k : v)
      k = m.vertex(x + random.integer(-reach, reach), y + random.integer(-reach, reach), depth);
    m.triangle(v[0], v[1], v[2]);
  }
  const std::vector<GridTriangle> triangles = m.triangles();
  std::vector<std::int32_t> expected(static_cast<std::size_t>(width * height), kNoId);
  std::vector<float> depth(expected.size(), 0.0f);
  for (const GridTriangle& t : triangles) {
    const float d = m.positions[static_cast<std::size_t>(t.id) * 3].z;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const std::size_t at = static_cast<std::size_t>(y * width + x);
        if (d > depth[at] && covers(t, x, y)) expected[at] = t.id, depth[at] = d;  // the first of the deepest stays
      }
  }
  Geometry g = geometry_of(m.positions, m.indices);
  const std::vector<DrawState> draw_states = two_sided();
  for (int order = 0; order < 4; ++order) {
    // Meshlets keep their ids wherever they stand.
    if (order == 1) std::reverse(g.meshlets.begin(), g.meshlets.end());
    if (order >= 2)
      for (std::size_t i = g.meshlets.size(); i > 1; --i)
        std::swap(g.meshlets[i - 1],
                  g.meshlets[static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(i) - 1))]);
    for (const int tile : {16, 32, 64, 128, 256})
      for (const std::uint32_t per_work_item : {1u, 5u, 1000u}) {
        const VisibilityBuffer out = draw(g, draw_states, whole_frame(width, height, centre, tile),
                                          PixelProgram{centre}, per_work_item, order == 3);
        long wrong = 0;
        for (int y = 0; y < height; ++y)
          for (int x = 0; x < width; ++x) {
            const std::size_t slot = out.grid.slot(x, y), at = static_cast<std::size_t>(y * width + x);
            wrong += out.id[slot] != expected[at] || out.depth[slot] != depth[at];
          }
        CHECK(wrong == 0);
      }
  }
}

// Error, with c the cosine between ray and normal, s the sine of the corner at the first vertex, L the coordinates'
// size (distance, eye, edges) and e the shorter edge at that vertex: position and distance 2.5e-7 L / (c s); uv in [-4,
// 4] 1e-6 L / (c s e), colours and normals 2.5e-7 L / (c s e); derivatives 3e-5 of the largest over c^2 s; level of
// detail 1e-4 + 2e-5 / (c^2 s). Measured: about half of each.
TEST_CASE("resolve: position, uv, normal, colour, derivatives and level of detail as in double") {
  TestRandom random(23);
  Texture texture;
  texture.level_count = 12;
  texture.width[0] = 1024, texture.height[0] = 512;
  double position = 0, uv = 0, normal = 0, color = 0, derivative = 0, level = -1, distance = 0;
  long hits = 0;
  for (int round = 0; round < 60000; ++round) {
    const View view = random_view(random, round % 8 == 7);
    const double px = random.real(0, 1280), py = random.real(0, 720);
    const float x_px = std::floor(static_cast<float>(px)) + 0.5f, y_px = std::floor(static_cast<float>(py)) + 0.5f;
    // A triangle round a point on the pixel's ray, from a hand's breadth to a field, from facing to grazing.
    const Ray<float> ray = pixel_ray<float>(view, x_px, y_px);
    const double along = std::pow(10.0, random.real(-0.5, 2)), size = std::pow(10.0, random.real(-2, 2));
    const Vec3f at = ray.origin_world + ray.direction_world * static_cast<float>(along);
    std::vector<Vec3f> p(3);
    for (Vec3f& q : p) q = at + Vec3f{random.in(-size, size), random.in(-size, size), random.in(-size, size)};
    const Vec3d pd[3] = {to_double(p[0]), to_double(p[1]), to_double(p[2])};
    const Vec3d e1 = pd[1] - pd[0], e2 = pd[2] - pd[0];
    const double sine = norm(cross(e1, e2)) / (norm(e1) * norm(e2));
    const DoubleHit hit = double_hit(view, pd, static_cast<double>(x_px), static_cast<double>(y_px));
    const double w = 1 - hit.u - hit.v;
    if (!(hit.t > 0.05) || hit.u < 0 || hit.v < 0 || w < 0 || hit.cosine < 0.02 || sine < 0.05) continue;
    ++hits;

    Geometry g;
    std::vector<Vec3f> normals(3);
    std::vector<Vec2f> uvs(3);
    std::vector<Vec4f> colors(3);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d n{random.real(-1, 1), random.real(-1, 1), random.real(1.2, 2)};
      normals[k] = {static_cast<float>(n.x / norm(n)), static_cast<float>(n.y / norm(n)),
                    static_cast<float>(n.z / norm(n))};
      uvs[k] = {random.in(-4, 4), random.in(-4, 4)};
      colors[k] = {random.in(0, 1), random.in(0, 1), random.in(0, 1), random.in(0, 1)};
    }
    const std::uint32_t indices[3] = {0, 1, 2};
    MeshView mesh;
    mesh.positions_world = p.data(), mesh.normals_world = normals.data(), mesh.uvs = uvs.data(),
    mesh.colors = colors.data();
    mesh.indices = indices, mesh.vertex_count = mesh.index_count = 3;
    append_mesh(g, mesh);
    const std::vector<DrawState> draw_states = two_sided();
    PixelAttributes<WideF> a;
    const Ray<WideF> wide = pixel_ray<WideF>(view, WideF(x_px), WideF(y_px));
    resolve_attributes(view_of(g, draw_states.data()), wide, pixel_ray_differential<WideF>(view), WideI(0),
                       mask_from_bits(0xFFFFu), a);
    const auto lane = [](WideF v) { return static_cast<double>(extract(v, 5)); };

    const double reach = norm(pd[0] - to_double(view.camera.position_world)) +
                         norm(to_double(view.camera.position_world)) + norm(e1) + norm(e2);
    const double scale = hit.cosine * sine / reach, edge = std::min(norm(e1), norm(e2));
    const Vec3d off =
        Vec3d{lane(a.position_world.x), lane(a.position_world.y), lane(a.position_world.z)} - hit.position;
    position = std::max(position, norm(off) * scale);
    distance = std::max(distance, std::fabs(lane(a.t) - hit.t) * scale);
    // What varies over the triangle moves by its slope times the position's error.
    const auto mix = [&](auto get) { return get(0) * w + get(1) * hit.u + get(2) * hit.v; };
    const double u = mix([&](std::size_t k) { return static_cast<double>(uvs[k].x); });
    const double v = mix([&](std::size_t k) { return static_cast<double>(uvs[k].y); });
    uv = std::max(uv, std::max(std::fabs(lane(a.uv.x) - u), std::fabs(lane(a.uv.y) - v)) * scale * edge);
    const double red = mix([&](std::size_t k) { return static_cast<double>(colors[k].x); });
    color = std::max(color, std::fabs(lane(a.color.x) - red) * scale * edge);
    Vec3d n = to_double(normals[0]) * w + to_double(normals[1]) * hit.u + to_double(normals[2]) * hit.v;
    const Vec3d flat = cross(e1, e2),
                view_d{static_cast<double>(ray.direction_world.x), static_cast<double>(ray.direction_world.y),
                       static_cast<double>(ray.direction_world.z)};
    n = n * ((dot(flat, view_d) > 0 ? -1.0 : 1.0) / norm(n));
    normal = std::max(
        normal, norm(Vec3d{lane(a.normal_world.x), lane(a.normal_world.y), lane(a.normal_world.z)} - n) * scale * edge);

    // Derivatives: central differences of the double hit over a hundredth of a pixel, exact to 1e-8.
    const auto uv_at = [&](double dx, double dy) {
      const DoubleHit h = double_hit(view, pd, static_cast<double>(x_px) + dx, static_cast<double>(y_px) + dy);
      const double hw = 1 - h.u - h.v;
      return Vec2<double>{static_cast<double>(uvs[0].x) * hw + static_cast<double>(uvs[1].x) * h.u +
                              static_cast<double>(uvs[2].x) * h.v,
                          static_cast<double>(uvs[0].y) * hw + static_cast<double>(uvs[1].y) * h.u +
                              static_cast<double>(uvs[2].y) * h.v};
    };
    constexpr double kStep = 0.01;
    const Vec2<double> dx = (uv_at(kStep, 0) - uv_at(-kStep, 0)) * (0.5 / kStep),
                       dy = (uv_at(0, kStep) - uv_at(0, -kStep)) * (0.5 / kStep);
    const double largest = std::max({std::fabs(dx.x), std::fabs(dx.y), std::fabs(dy.x), std::fabs(dy.y)});
    const double wrong = std::max({std::fabs(lane(a.duv_dx.x) - dx.x), std::fabs(lane(a.duv_dx.y) - dx.y),
                                   std::fabs(lane(a.duv_dy.x) - dy.x), std::fabs(lane(a.duv_dy.y) - dy.y)});
    const double steep = hit.cosine * hit.cosine * sine;
    derivative = std::max(derivative, wrong / largest * steep);
    const auto lod = level_of_detail<WideF>(texture, a.duv_dx, a.duv_dy);
    const double shown = extract(lod.level, 5) + extract(lod.fraction, 5) / 32768.0;
    const double rho = std::max(std::hypot(dx.x * 1024, dx.y * 512), std::hypot(dy.x * 1024, dy.y * 512));
    level = std::max(level, std::fabs(shown - std::clamp(std::log2(rho), 0.0, 14.0)) - 2e-5 / steep);
  }
  CAPTURE(hits, position, distance, uv, color, normal, derivative, level);
  CHECK(hits > 2000);
  CHECK(position < 2.5e-7);
  CHECK(distance < 2.5e-7);
  CHECK(uv < 1e-6);
  CHECK(color < 2.5e-7);
  CHECK(normal < 2.5e-7);
  CHECK(derivative < 3e-5);
  CHECK(level < 1e-4);
}
