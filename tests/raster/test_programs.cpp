// A user's own vertex and pixel programs (docs/tutorials/programs.md), and what they draw against double precision.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/math.h"
#include "raster/resolve.h"
#include "raster_driver.h"

using namespace shoal_test;

namespace {

// --- The user's programs: two structs, templated on the lane type
// -----------------------------------------------------

// Turns a tower round its axis, the more the higher.
struct Twist {
  static constexpr bool kWarped = false;  // edges stay as straight as the mesh has them
  const View& view;
  float turn_per_m;

  template <class F>
  Vec3<F> turn(Vec3<F> v, F height) const {
    F sine, cosine;
    det_sincos(height * F(turn_per_m), sine, cosine);
    return {cosine * v.x - sine * v.z, v.y, sine * v.x + cosine * v.z};
  }
  template <class F>
  ClipVertex<F> vertex(Vec3<F> position_world) const {
    return project(view, turn(position_world, position_world.y));
  }
  bool meshlet_outside(const Meshlet&) const { return false; }
};

// A checkerboard in texture space, its white squares coloured by the normal.
struct Checker {
  template <class F>
  Vec3<F> pixel(const PixelAttributes<F>& a) const {
    const F u = floor(a.uv.x * F(8.0f)), v = floor(a.uv.y * F(8.0f));
    const F half = (u + v) * F(0.5f);
    const MaskOf<F> white = half == floor(half);
    const Vec3<F> normal = a.normal_world * F(0.5f) + Vec3<F>{F(0.5f), F(0.5f), F(0.5f)};
    return {select(white, normal.x, F(0.1f)), select(white, normal.y, F(0.1f)), select(white, normal.z, F(0.1f))};
  }
};

// --- The frame: visible ids, then the pixel program once for each visible pixel
// ---------------------------------------

struct Picture {
  std::vector<Vec3f> color;  // rows top to bottom
  std::vector<std::int32_t> id;
};

template <class VertexProgram, class PixelProgram>
Picture draw_picture(Geometry geometry, const std::vector<DrawState>& draw_states, const VertexProgram& vertex,
                     const PixelProgram& pixel, const View& view, int tile_px) {
  const PassSettings pass = whole_frame(view.width_px, view.height_px, view.centre_px, tile_px);
  VisibilityBuffer seen;
  draw_tiles(bin_geometry(geometry, draw_states, vertex, pass, 4), pass, KeepAll{}, seen);

  // The pixel stages read positions and normals from the vertex records: there, too, they are where the program puts
  // them.
  for (VertexRecord& v : geometry.vertices) {
    const float height = v.position_world.y;
    v.position_world = vertex.turn(v.position_world, height);
    v.normal_world = vertex.turn(v.normal_world, height);
  }
  const GeometryView records = view_of(geometry, draw_states.data());
  const RayDifferential<WideF> differential = pixel_ray_differential<WideF>(view);
  Picture out;
  out.color.resize(static_cast<std::size_t>(view.width_px * view.height_px), Vec3f{0, 0, 0});
  out.id.resize(out.color.size(), kNoId);
  for (int y = 0; y < view.height_px; y += kBlockSize)
    for (int x = 0; x < view.width_px; x += kBlockSize) {
      const WideI column = WideI(x) + block_x(), row = WideI(y) + block_y();
      const WideI id = WideI::load(seen.id.data() + seen.grid.block_offset(x >> 2, y >> 2));
      const WideM shown = (column < WideI(view.width_px)) & (row < WideI(view.height_px)) & (id != WideI(kNoId));
      if (none(shown)) continue;
      const Ray<WideF> ray = pixel_ray(view, to_float(column) + WideF(0.5f), to_float(row) + WideF(0.5f));
      PixelAttributes<WideF> a;
      resolve_attributes(records, ray, differential, id, shown, a);
      const Vec3<WideF> color = pixel.pixel(a);
      for (std::uint32_t lanes = to_bits(shown); lanes != 0; lanes &= lanes - 1) {
        const int lane = __builtin_ctz(lanes);
        const std::size_t at = static_cast<std::size_t>(extract(row, lane) * view.width_px + extract(column, lane));
        out.color[at] = {extract(color.x, lane), extract(color.y, lane), extract(color.z, lane)};
        out.id[at] = extract(id, lane);
      }
    }
  return out;
}

// --- What it should be, in double
// --------------------------------------------------------------------------------------

// A square tower, 1 m wide and 3 m high.
Geometry tower(int rows) {
  Geometry g;
  const float corner[5][2] = {{-0.5f, 0.5f}, {0.5f, 0.5f}, {0.5f, -0.5f}, {-0.5f, -0.5f}, {-0.5f, 0.5f}};
  for (int side = 0; side < 4; ++side) {
    std::vector<Vec3f> p, n;
    std::vector<Vec2f> uv;
    std::vector<std::uint32_t> indices;
    const float nx = corner[side + 1][1] - corner[side][1], nz = corner[side + 1][0] - corner[side][0];
    for (int j = 0; j <= rows; ++j)
      for (int i = 0; i < 2; ++i) {
        const float v = static_cast<float>(j) / static_cast<float>(rows);
        p.push_back({corner[side + i][0], 3 * v, corner[side + i][1]});
        n.push_back({-nx, 0, nz});
        uv.push_back({static_cast<float>(i) * 0.5f, v * 1.5f});
      }
    for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(rows); ++j) {
      const std::uint32_t a = 2 * j;
      indices.insert(indices.end(), {a, a + 1, a + 3, a, a + 3, a + 2});
    }
    MeshView mesh;
    mesh.positions_world = p.data(), mesh.normals_world = n.data(), mesh.uvs = uv.data(), mesh.indices = indices.data();
    mesh.vertex_count = static_cast<std::uint32_t>(p.size()),
    mesh.index_count = static_cast<std::uint32_t>(indices.size());
    append_mesh(g, mesh);
  }
  return g;
}

Vec3d as_double(Vec3f v) { return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)}; }
Vec3d twisted(Vec3f v, float height, float turn_per_m) {
  const double angle = static_cast<double>(height) * static_cast<double>(turn_per_m), s = std::sin(angle),
               c = std::cos(angle);
  const Vec3d d = as_double(v);
  return {c * d.x - s * d.z, d.y, s * d.x + c * d.z};
}

struct Expected {
  std::int32_t id = kNoId;
  Vec3d color{0, 0, 0};
  double from_edge = 1;  // of the checkerboard, in squares
};

Expected shade_in_double(const Geometry& g, float turn_per_m, const View& view, int x, int y) {
  const double dx = x + 0.5 - static_cast<double>(view.centre_px.x),
               dy = y + 0.5 - static_cast<double>(view.centre_px.y);
  const Vec3d o = as_double(view.camera.position_world);
  const Vec3d d = as_double(view.camera.forward_world) + as_double(view.ray_dx) * dx + as_double(view.ray_dy) * dy;
  double nearest = std::numeric_limits<double>::infinity();
  Expected out;
  for (std::size_t i = 0; i < g.triangles.size(); ++i) {
    const VertexRecord* v[3];
    Vec3d p[3], n[3];
    for (int k = 0; k < 3; ++k) {
      v[k] = &g.vertices[g.triangles[i].vertex[k]];
      p[k] = twisted(v[k]->position_world, v[k]->position_world.y, turn_per_m);
      n[k] = twisted(v[k]->normal_world, v[k]->position_world.y, turn_per_m);
    }
    const Vec3d e1 = p[1] - p[0], e2 = p[2] - p[0], flat = cross(e1, e2);
    const double t = dot(p[0] - o, flat) / dot(d, flat);
    const Vec3d r = o + d * t - p[0];
    const double b = dot(cross(r, e2), flat) / dot(flat, flat), c = dot(cross(e1, r), flat) / dot(flat, flat),
                 a = 1 - b - c;
    if (!(t > 0) || dot(d, flat) > 0 || a < 0 || b < 0 || c < 0 || t >= nearest) continue;
    nearest = t;
    out.id = static_cast<std::int32_t>(i);
    const double su = 8 * (a * static_cast<double>(v[0]->uv.x) + b * static_cast<double>(v[1]->uv.x) +
                           c * static_cast<double>(v[2]->uv.x));
    const double sv = 8 * (a * static_cast<double>(v[0]->uv.y) + b * static_cast<double>(v[1]->uv.y) +
                           c * static_cast<double>(v[2]->uv.y));
    const Vec3d m = n[0] * a + n[1] * b + n[2] * c, unit = m / std::sqrt(dot(m, m));
    const bool white = (static_cast<long>(std::floor(su)) + static_cast<long>(std::floor(sv))) % 2 == 0;
    out.color = white ? unit * 0.5 + Vec3d{0.5, 0.5, 0.5} : Vec3d{0.1, 0.1, 0.1};
    out.from_edge = std::min(std::fabs(su - std::round(su)), std::fabs(sv - std::round(sv)));
  }
  return out;
}

}  // namespace

TEST_CASE("programs: a user's twist and checkerboard draw what double precision says") {
  const Geometry geometry = tower(40);
  const std::vector<DrawState> draw_states(1);
  Camera camera;
  camera.position_world = {0.3f, 1.6f, 5};
  const int width = 99, height = 122;
  const View view = make_view(camera, width, height, {0, 0});
  const Twist twist{view, 0.7f};
  const Picture picture = draw_picture(geometry, draw_states, twist, Checker{}, view, 64);

  long drawn = 0, same = 0, close = 0, whites = 0, next_to_edge = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::size_t at = static_cast<std::size_t>(y * width + x);
      const Expected expected = shade_in_double(geometry, twist.turn_per_m, view, x, y);
      drawn += expected.id != kNoId;
      if (picture.id[at] != expected.id) continue;  // at edges, within the grid's 1/512 px; counted below
      same += expected.id != kNoId;
      whites += expected.id != kNoId && expected.color.x != 0.1;
      const Vec3d off = as_double(picture.color[at]) - expected.color;
      const bool right = std::fabs(off.x) < 1e-5 && std::fabs(off.y) < 1e-5 && std::fabs(off.z) < 1e-5;
      next_to_edge += expected.id != kNoId && expected.from_edge < 1e-4;
      close += expected.id != kNoId && (right || expected.from_edge < 1e-4);
    }
  CAPTURE(drawn, same, close, whites, next_to_edge);
  CHECK(drawn > 1500);
  CHECK(whites > drawn / 3);
  CHECK(same > drawn * 99 / 100);
  CHECK(close == same);
  CHECK(next_to_edge < 20);

  // The same bytes from other tiles.
  const Picture other = draw_picture(geometry, draw_states, twist, Checker{}, view, 16);
  CHECK(other.id == picture.id);
  CHECK(std::equal(other.color.begin(), other.color.end(), picture.color.begin(),
                   [](Vec3f a, Vec3f b) { return a.x == b.x && a.y == b.y && a.z == b.z; }));
}
