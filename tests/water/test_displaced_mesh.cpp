// The displaced mesh: closed, without cracks, finer by bands, culled where it cannot be seen.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <set>

#include "surface_cases.h"
#include "water/displaced_mesh.h"
#include "water/surface.h"

namespace {

using namespace shoal;

constexpr PlaneExtent kPool = {-6.0f, -10.0f, 10.0f, 14.0f};

WaterSurface waves() {
  SurfaceSettings s = surface_cases::of_kind(SurfaceKind::kPerlin);
  s.slope = 0.2f;
  return prepare_surface(s, 1.0, kPool);
}

DisplacedMeshView view_of(float cell_m, float range_m) {
  DisplacedMeshView view;
  view.eye = {0.3f, 1.5f, -7.0f};
  view.cell_m = cell_m;
  view.range_m = range_m;
  return view;
}

using Edge = std::pair<std::uint32_t, std::uint32_t>;

// How often each directed edge occurs.
std::map<Edge, int> edges_of(const DisplacedMesh& mesh) {
  std::map<Edge, int> edges;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) ++edges[{mesh.indices[t + k], mesh.indices[t + (k + 1) % 3]}];
  }
  return edges;
}

double area_from_above(const DisplacedMesh& mesh, std::size_t t) {
  const Vec3f a = mesh.positions[mesh.indices[t]], b = mesh.positions[mesh.indices[t + 1]],
              c = mesh.positions[mesh.indices[t + 2]];
  // The y component of (b - a) x (c - a).
  return 0.5 * (static_cast<double>(b.z - a.z) * static_cast<double>(c.x - a.x) -
                static_cast<double>(b.x - a.x) * static_cast<double>(c.z - a.z));
}

}  // namespace

TEST_CASE("the displaced mesh has no cracks and covers the body once", "[water]") {
  const WaterSurface surface = waves();
  for (const float cell_m : {3.0f, 1.1f, 0.5f}) {
    for (const float range_m : {8.0f, 30.0f, 80.0f, 200.0f}) {
      const DisplacedMesh mesh = displaced_mesh(surface, kPool, view_of(cell_m, range_m));
      CAPTURE(cell_m, range_m);
      REQUIRE(!mesh.indices.empty());
      std::set<std::pair<float, float>> places;
      for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const Vec3f p = mesh.positions[i];
        REQUIRE(places.insert({p.x, p.z}).second);
        const SurfacePoint<float> on = surface_at(surface, p.x, p.z);
        REQUIRE(p.y == on.height_m);
        REQUIRE(mesh.slopes[i].x == on.slope_x);
      }
      double area = 0;
      for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
        REQUIRE(area_from_above(mesh, t) > 0);
        area += area_from_above(mesh, t);
      }
      // Each edge once each way; but once only on the border of the body, or of the range.
      const std::map<Edge, int> edges = edges_of(mesh);
      int border = 0;
      bool on_rectangle = true;
      for (const auto& [edge, count] : edges) {
        REQUIRE(count == 1);
        if (edges.count({edge.second, edge.first}) != 0) continue;
        ++border;
        const Vec3f a = mesh.positions[edge.first], b = mesh.positions[edge.second];
        on_rectangle = on_rectangle && ((a.x == b.x && (a.x == kPool.min_x_m || a.x == kPool.max_x_m)) ||
                                        (a.z == b.z && (a.z == kPool.min_z_m || a.z == kPool.max_z_m)));
      }
      CHECK(border > 0);
      if (range_m > 25) {
        CHECK(on_rectangle);
        CHECK(area == Approx(16.0 * 24.0).epsilon(1e-5));
      } else {
        CHECK(area < 0.9 * 16.0 * 24.0);
      }
    }
  }
}

TEST_CASE("bands of distance are each twice as fine as the one behind", "[water]") {
  const DisplacedMesh mesh = displaced_mesh(waves(), kPool, view_of(0.5f, 20.0f));
  double least[3] = {1e9, 1e9, 1e9}, most[3] = {0, 0, 0};
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    const Vec3f a = mesh.positions[mesh.indices[t]];
    const double distance =
        std::sqrt(std::pow(static_cast<double>(a.x) - 0.3, 2) + std::pow(static_cast<double>(a.z) + 7.0, 2) + 2.25);
    // Well inside of a band, away from fans.
    const int band = distance < 4 ? 2 : distance > 6 && distance < 9 ? 1 : distance > 11 && distance < 19 ? 0 : -1;
    if (band < 0) continue;
    least[band] = std::min(least[band], area_from_above(mesh, t));
    most[band] = std::max(most[band], area_from_above(mesh, t));
  }
  // Half a cell of 0.5 m, of a half and of a quarter of it.
  for (int band = 0; band < 3; ++band) {
    const double side = 0.5 / (1 << band);
    CHECK(least[band] == Approx(0.5 * side * side).epsilon(1e-3));
    CHECK(most[band] == Approx(0.5 * side * side).epsilon(1e-3));
  }
}

TEST_CASE("culling leaves all that a frustum can show, and little more", "[water]") {
  const WaterSurface surface = waves();
  DisplacedMeshView view = view_of(0.5f, 40.0f);
  const DisplacedMesh all = displaced_mesh(surface, kPool, view);
  // Three planes through the eye, looking along +z.
  view.frustum = {
      {0.8f, 0, 0.6f, 0.6f * 7.0f - 0.8f * 0.3f}, {-0.8f, 0, 0.6f, 0.6f * 7.0f + 0.8f * 0.3f}, {0, 0, 1, 5.0f}};
  const DisplacedMesh seen = displaced_mesh(surface, kPool, view);
  const auto inside = [&](Vec3f p, float slack) {
    return std::all_of(view.frustum.begin(), view.frustum.end(),
                       [&](const Vec4f& n) { return n.x * p.x + n.y * p.y + n.z * p.z + n.w >= -slack; });
  };
  using Triangle = std::array<std::pair<float, float>, 3>;
  const auto triangles = [](const DisplacedMesh& mesh) {
    std::set<Triangle> found;
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
      Triangle triangle;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3f p = mesh.positions[mesh.indices[t + k]];
        triangle[k] = {p.x, p.z};
      }
      found.insert(triangle);
    }
    return found;
  };
  const std::set<Triangle> kept = triangles(seen), every = triangles(all);
  CHECK(kept.size() < every.size() / 2);
  for (const Triangle& triangle : every) {
    bool shows = false, near = false;
    for (const auto& [x, z] : triangle) {
      shows = shows || inside({x, surface_at(surface, x, z).height_m, z}, 0.0f);
      near = near || inside({x, 0, z}, 1.0f);
    }
    if (shows) REQUIRE(kept.count(triangle) == 1);
    if (!near) REQUIRE(kept.count(triangle) == 0);
  }
  CHECK(displaced_mesh(surface, {1, 1, 1, 2}, view).indices.empty());
}
