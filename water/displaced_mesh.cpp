#include "water/displaced_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "water/surface.h"

namespace shoal {
namespace {

constexpr int kMaxBlocks = 256;  // a side
constexpr int kUnits = 8;        // lattice units a block: two a cell of the finest band, for cells' middles
constexpr std::uint32_t kNone = 0xFFFFFFFFu;

struct Builder {
  const WaterSurface& surface;
  const PlaneExtent& extent;
  const DisplacedMeshView& view;
  int blocks_x, blocks_z;
  std::vector<std::int8_t> bands;        // of each block: 0 far, 1, 2 near; -1 left out by the range
  std::vector<std::uint32_t> vertex_at;  // of each lattice point
  DisplacedMesh mesh;

  int band(int i, int j) const {
    if (i < 0 || j < 0 || i >= blocks_x || j >= blocks_z) return -1;
    return bands[static_cast<std::size_t>(j * blocks_x + i)];
  }
  // Of a lattice point, the same expression for all.
  float x_of(int u) const {
    const float share = static_cast<float>(u) / static_cast<float>(kUnits * blocks_x);
    return extent.min_x_m + (extent.max_x_m - extent.min_x_m) * share;
  }
  float z_of(int v) const {
    const float share = static_cast<float>(v) / static_cast<float>(kUnits * blocks_z);
    return extent.min_z_m + (extent.max_z_m - extent.min_z_m) * share;
  }
  std::uint32_t vertex(int u, int v) {
    std::uint32_t& at = vertex_at[static_cast<std::size_t>(v) * static_cast<std::size_t>(kUnits * blocks_x + 1) +
                                  static_cast<std::size_t>(u)];
    if (at == kNone) {
      at = static_cast<std::uint32_t>(mesh.positions.size());
      const float x = x_of(u), z = z_of(v);
      const SurfacePoint<float> p = surface_at(surface, x, z);
      mesh.positions.push_back({x, p.height_m, z});
      mesh.slopes.push_back({p.slope_x, p.slope_z});
    }
    return at;
  }
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.indices.insert(mesh.indices.end(), {a, b, c});
  }

  void find_bands();
  bool culled(int i, int j) const;
  void add_block(int i, int j);
  void add_cell(int u, int v, int side, const std::array<int, 4>& parts);
};

void Builder::find_bands() {
  for (int j = 0; j < blocks_z; ++j) {
    for (int i = 0; i < blocks_x; ++i) {
      const float dx = x_of(kUnits * i + kUnits / 2) - view.eye.x, dz = z_of(kUnits * j + kUnits / 2) - view.eye.z;
      const float distance = std::sqrt((dx * dx + dz * dz) + view.eye.y * view.eye.y);
      const int band = distance < 0.25f * view.range_m ? 2 : distance < 0.5f * view.range_m ? 1 : 0;
      bands.push_back(static_cast<std::int8_t>(distance > view.range_m ? -1 : band));
    }
  }
}

// Is the block's box wholly behind one of the planes? Its corner farthest along the plane's normal decides.
bool Builder::culled(int i, int j) const {
  const float x0 = x_of(kUnits * i), x1 = x_of(kUnits * (i + 1)), z0 = z_of(kUnits * j), z1 = z_of(kUnits * (j + 1));
  return std::any_of(view.frustum.begin(), view.frustum.end(), [&](const Vec4f& n) {
    const float x = n.x > 0 ? x1 : x0, z = n.z > 0 ? z1 : z0;
    const float y = n.y > 0 ? surface.height_bound_m : -surface.height_bound_m;
    return ((n.x * x + n.y * y) + n.z * z) + n.w < 0;
  });
}

// A square of the lattice whose sides towards -x, +z, +x, -z are in `parts` parts each: two triangles where all are in
// one, else a fan about the middle.
void Builder::add_cell(int u, int v, int side, const std::array<int, 4>& parts) {
  if (parts == std::array<int, 4>{1, 1, 1, 1}) {
    const std::uint32_t a = vertex(u, v), b = vertex(u, v + side), c = vertex(u + side, v + side),
                        d = vertex(u + side, v);
    triangle(a, b, c);
    triangle(a, c, d);
    return;
  }
  // Round the square, counter-clockwise from above: down the -x side with v, along +z with u, and back.
  std::vector<std::uint32_t> ring;
  const int from_u[4] = {u, u, u + side, u + side}, from_v[4] = {v, v + side, v + side, v};
  const int step_u[4] = {0, 1, 0, -1}, step_v[4] = {1, 0, -1, 0};
  for (std::size_t s = 0; s < 4; ++s) {
    for (int k = 0; k < parts[s]; ++k) {
      const int along = side / parts[s] * k;
      ring.push_back(vertex(from_u[s] + step_u[s] * along, from_v[s] + step_v[s] * along));
    }
  }
  const std::uint32_t middle = vertex(u + side / 2, v + side / 2);
  for (std::size_t k = 0; k < ring.size(); ++k) triangle(middle, ring[k], ring[(k + 1) % ring.size()]);
}

void Builder::add_block(int i, int j) {
  const int own = band(i, j);
  const int cells = 1 << own, side = kUnits / cells;
  const auto parts_towards = [&](int di, int dj) { return 1 << std::max(0, band(i + di, j + dj) - own); };
  const int parts[4] = {parts_towards(-1, 0), parts_towards(0, 1), parts_towards(1, 0), parts_towards(0, -1)};
  for (int q = 0; q < cells; ++q) {
    for (int p = 0; p < cells; ++p) {
      add_cell(
          kUnits * i + side * p, kUnits * j + side * q, side,
          {p == 0 ? parts[0] : 1, q == cells - 1 ? parts[1] : 1, p == cells - 1 ? parts[2] : 1, q == 0 ? parts[3] : 1});
    }
  }
}

}  // namespace

DisplacedMesh displaced_mesh(const WaterSurface& surface, const PlaneExtent& extent, const DisplacedMeshView& view) {
  const auto blocks = [&](float size) {
    return static_cast<int>(std::clamp(std::ceil(size / view.cell_m), 1.0f, static_cast<float>(kMaxBlocks)));
  };
  const float size_x = extent.max_x_m - extent.min_x_m, size_z = extent.max_z_m - extent.min_z_m;
  if (!(size_x > 0) || !(size_z > 0)) return {};
  Builder builder = {surface, extent, view, blocks(size_x), blocks(size_z), {}, {}, {}};
  builder.vertex_at.assign(
      static_cast<std::size_t>(kUnits * builder.blocks_x + 1) * static_cast<std::size_t>(kUnits * builder.blocks_z + 1),
      kNone);
  builder.find_bands();
  for (int j = 0; j < builder.blocks_z; ++j) {
    for (int i = 0; i < builder.blocks_x; ++i) {
      if (builder.band(i, j) >= 0 && !builder.culled(i, j)) builder.add_block(i, j);
    }
  }
  return std::move(builder.mesh);
}

}  // namespace shoal
