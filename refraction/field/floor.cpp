#include "refraction/field/floor.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "raster/bin.h"
#include "refraction/field/distance_field.h"

namespace shoal {

namespace {

constexpr float kLevel_m = 1e-4f, kSame_m = 1e-3f, kUnder_m = 1e-3f;
constexpr double kLeastShare = 0.5;  // of the outline's area
constexpr float kEdgeSlack = 1e-6f;

struct LevelTriangle {
  Floor::Triangle triangle;
  float height_m;
  double area;
};

double area_of(const Floor::Triangle& t) {
  const auto d = [](float a, float b) { return static_cast<double>(a) - static_cast<double>(b); };
  return 0.5 * (d(t.z[1], t.z[0]) * d(t.x[2], t.x[0]) - d(t.x[1], t.x[0]) * d(t.z[2], t.z[0]));
}

struct Bounds {
  float min_x = 3e38f, min_z = 3e38f, max_x = -3e38f, max_z = -3e38f;
  void add(float x, float z) {
    min_x = std::min(min_x, x), max_x = std::max(max_x, x), min_z = std::min(min_z, z), max_z = std::max(max_z, z);
  }
  bool touch(const Bounds& o) const {
    return min_x <= o.max_x && max_x >= o.min_x && min_z <= o.max_z && max_z >= o.min_z;
  }
};
Bounds bounds_of(const Floor::Triangle& t) {
  Bounds b;
  for (int k = 0; k < 3; ++k) b.add(t.x[k], t.z[k]);
  return b;
}

// The level triangles of a drawable under the plane.
std::vector<LevelTriangle> level_triangles(const RenderScene& scene, const WaterBody& body, const Drawable& drawable,
                                           const Bounds& outline) {
  std::vector<LevelTriangle> found;
  const Geometry& g = scene.geometry;
  for (std::uint32_t i = 0; i < drawable.triangle_count; ++i) {
    const std::uint32_t id = drawable.first_triangle + i;
    LevelTriangle t;
    t.triangle.id = static_cast<std::int32_t>(id);
    float lo = 3e38f, hi = -3e38f;
    for (int k = 0; k < 3; ++k) {
      const Vec3f p = to_plane(body, g.vertices[g.triangles[id].vertex[k]].position_world);
      t.triangle.x[k] = p.x, t.triangle.z[k] = p.z;
      lo = std::min(lo, p.y), hi = std::max(hi, p.y);
    }
    t.height_m = 0.5f * (lo + hi);
    t.area = area_of(t.triangle);
    if (!(hi - lo <= kLevel_m && hi <= -kUnder_m && lo >= -body.depth_m - kSame_m)) continue;
    if (!bounds_of(t.triangle).touch(outline)) continue;
    if (t.area < 0 && scene.materials.materials[drawable.material].double_sided) {
      std::swap(t.triangle.x[1], t.triangle.x[2]), std::swap(t.triangle.z[1], t.triangle.z[2]);
      t.area = -t.area;
    }
    if (t.area > 0) found.push_back(t);
  }
  return found;
}

// Returns those of a drawable's level triangles that share a height and have the greatest area together.
std::vector<LevelTriangle> greatest_level(std::vector<LevelTriangle> all, double& area) {
  std::stable_sort(all.begin(), all.end(),
                   [](const LevelTriangle& a, const LevelTriangle& b) { return a.height_m < b.height_m; });
  std::size_t best = 0, best_end = 0;
  area = 0;
  for (std::size_t begin = 0; begin < all.size();) {
    std::size_t end = begin;
    double sum = 0;
    for (; end < all.size() && all[end].height_m - all[begin].height_m <= kSame_m; ++end) sum += all[end].area;
    if (sum > area) area = sum, best = begin, best_end = end;
    begin = end;
  }
  return {all.begin() + static_cast<std::ptrdiff_t>(best), all.begin() + static_cast<std::ptrdiff_t>(best_end)};
}

std::int32_t cell_of(float at, float min_m, float cells_per_m, std::int32_t cells) {
  const float cell = std::floor((at - min_m) * cells_per_m);
  return static_cast<std::int32_t>(std::min(std::max(cell, 0.0f), static_cast<float>(cells - 1)));
}

// Calls body(cell) for every cell that a triangle's bounds touch.
template <class Body>
void for_each_cell(const Floor& floor, const Floor::Triangle& t, Body body) {
  const Bounds b = bounds_of(t);
  const std::int32_t x1 = cell_of(b.max_x, floor.min_x_m, floor.cells_per_m_x, floor.cells_x),
                     z1 = cell_of(b.max_z, floor.min_z_m, floor.cells_per_m_z, floor.cells_z);
  for (std::int32_t z = cell_of(b.min_z, floor.min_z_m, floor.cells_per_m_z, floor.cells_z); z <= z1; ++z)
    for (std::int32_t x = cell_of(b.min_x, floor.min_x_m, floor.cells_per_m_x, floor.cells_x); x <= x1; ++x)
      body(static_cast<std::size_t>(z * floor.cells_x + x));
}

Floor make_floor(std::vector<LevelTriangle> triangles) {
  std::sort(triangles.begin(), triangles.end(),
            [](const LevelTriangle& a, const LevelTriangle& b) { return a.triangle.id < b.triangle.id; });
  Floor floor;
  floor.height_m = triangles.front().height_m;
  Bounds all;
  for (const LevelTriangle& t : triangles)
    for (int k = 0; k < 3; ++k) all.add(t.triangle.x[k], t.triangle.z[k]);
  const float side = std::floor(std::sqrt(static_cast<float>(triangles.size()) * 0.5f));
  floor.cells_x = floor.cells_z = static_cast<std::int32_t>(std::min(std::max(side, 1.0f), 256.0f));
  floor.min_x_m = all.min_x, floor.min_z_m = all.min_z;
  floor.cells_per_m_x = static_cast<float>(floor.cells_x) / (all.max_x - all.min_x);
  floor.cells_per_m_z = static_cast<float>(floor.cells_z) / (all.max_z - all.min_z);
  std::vector<std::vector<Floor::Triangle>> cells(static_cast<std::size_t>(floor.cells_x * floor.cells_z));
  for (const LevelTriangle& t : triangles)
    for_each_cell(floor, t.triangle, [&](std::size_t cell) { cells[cell].push_back(t.triangle); });
  for (const std::vector<Floor::Triangle>& cell : cells) {
    floor.first.push_back(static_cast<std::uint32_t>(floor.triangles.size()));
    floor.triangles.insert(floor.triangles.end(), cell.begin(), cell.end());
  }
  floor.first.push_back(static_cast<std::uint32_t>(floor.triangles.size()));
  return floor;
}

}  // namespace

std::int32_t Floor::at(float x_m, float z_m) const {
  const std::size_t cell = static_cast<std::size_t>(cell_of(z_m, min_z_m, cells_per_m_z, cells_z) * cells_x +
                                                    cell_of(x_m, min_x_m, cells_per_m_x, cells_x));
  for (std::uint32_t i = first[cell]; i < first[cell + 1]; ++i) {
    const Triangle& t = triangles[i];
    bool inside = true;
    for (int k = 0; k < 3; ++k) {
      const int n = k == 2 ? 0 : k + 1;
      const float ex = t.x[n] - t.x[k], ez = t.z[n] - t.z[k];
      // A millionth of the edge to spare: no gap between two triangles.
      inside = inside && ez * (x_m - t.x[k]) - ex * (z_m - t.z[k]) >= -kEdgeSlack * (ex * ex + ez * ez);
    }
    if (inside) return t.id;
  }
  return kNoId;
}

Floor find_floor(const RenderScene& scene, const WaterBody& body) {
  Bounds outline;
  double outline_area = 0;
  for (std::size_t i = 0; i + 2 < body.outline.size(); i += 3) {
    Floor::Triangle t{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3f p = to_plane(body, body.outline[i + k]);
      outline.add(p.x, p.z);
      t.x[k] = p.x, t.z[k] = p.z;
    }
    outline_area += std::fabs(area_of(t));
  }
  std::vector<LevelTriangle> best;
  double best_area = 0;
  for (const Drawable& d : scene.geometry.drawables) {
    if (!d.drawn || scene.materials.materials[d.material].alpha_mode == AlphaMode::kBlend) continue;
    double area = 0;
    std::vector<LevelTriangle> level = greatest_level(level_triangles(scene, body, d, outline), area);
    if (area > best_area) best = std::move(level), best_area = area;
  }
  if (best.empty() || best_area < kLeastShare * outline_area)
    throw NotApplicable("method block-grid is not applicable: the water '" + body.name +
                        "' has no level floor; expected level triangles of one object under it, of half its area or "
                        "more");
  return make_floor(std::move(best));
}

}  // namespace shoal
