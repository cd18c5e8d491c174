// The second layer against exact depths of triangles drawn one by one.
#include <catch2/catch.hpp>

#include <random>
#include <vector>

#include "raster/behind.h"
#include "raster/camera.h"
#include "raster_driver.h"

using namespace shoal_test;

namespace {

constexpr int kWidth = 150, kHeight = 90;

struct Straight {
  static constexpr bool kWarped = false;
  View view;
  template <class F>
  ClipVertex<F> vertex(Vec3<F> position_world) const {
    return project(view, position_world);
  }
  bool meshlet_outside(const Meshlet&) const { return false; }
};

// Triangles of all sizes that cross each other before an orthographic camera.
Geometry crossing_triangles(std::size_t count) {
  std::mt19937 random(7);
  const auto number = [&](double low, double high) {
    return static_cast<float>(low + (high - low) * static_cast<double>(random()) / 4294967296.0);
  };
  std::vector<Vec3f> positions, normals;
  std::vector<std::uint32_t> indices;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3f middle{number(-75, 75), number(-45, 45), number(-90, -10)};
    const double size = i % 4 == 0 ? 60 : 8;
    for (int k = 0; k < 3; ++k) {
      positions.push_back(middle + Vec3f{number(-size, size), number(-size, size), number(-5, 5)});
      normals.push_back({0, 0, 1});
      indices.push_back(static_cast<std::uint32_t>(indices.size()));
    }
  }
  MeshView mesh;
  mesh.positions_world = positions.data();
  mesh.normals_world = normals.data();
  mesh.indices = indices.data();
  mesh.vertex_count = mesh.index_count = static_cast<std::uint32_t>(indices.size());
  Geometry geometry;
  append_mesh(geometry, mesh);
  return geometry;
}

}  // namespace

TEST_CASE("behind: the second layer is the second of all triangles at each pixel", "[raster]") {
  Camera camera;
  camera.orthographic = true;
  camera.xmag_m = 0.5f * kWidth, camera.ymag_m = 0.5f * kHeight;
  camera.near_m = 1.0f, camera.far_m = 1025.0f;
  const Straight program{make_view(camera, kWidth, kHeight, {0, 0})};
  const Geometry all = crossing_triangles(300);
  const std::vector<DrawState> states{DrawState{true, false, false}};
  const PassSettings pass = whole_frame(kWidth, kHeight, program.view.centre_px, 32);
  const std::vector<WorkItemBins> bins = bin_geometry(all, states, program, pass, 1);
  VisibilityBuffer nearest, behind;
  draw_tiles(bins, pass, KeepAll{}, nearest);
  const KeepAll keeps;
  behind.resize(nearest.grid);
  draw_tiles(bins, pass, BehindCollector(nearest, behind, keeps), behind);

  // Each triangle by itself: its depth at each of its pixels.
  struct Layer {
    float depth = 0;
    std::int32_t id = kNoId;
  };
  std::vector<Layer> first(std::size_t{kWidth} * kHeight), second(first.size());
  for (std::size_t t = 0; t < all.triangles.size(); ++t) {
    Geometry one;
    std::vector<Vec3f> corners, normals(3, Vec3f{0, 0, 1});
    for (const std::uint32_t vertex : all.triangles[t].vertex) corners.push_back(all.vertices[vertex].position_world);
    const std::uint32_t indices[3] = {0, 1, 2};
    MeshView mesh;
    mesh.positions_world = corners.data(), mesh.normals_world = normals.data(), mesh.indices = indices;
    mesh.vertex_count = mesh.index_count = 3;
    append_mesh(one, mesh);
    VisibilityBuffer alone;
    draw_tiles(bin_geometry(one, states, program, pass, 1), pass, KeepAll{}, alone);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const std::size_t slot = alone.grid.slot(x, y), p = static_cast<std::size_t>(y * kWidth + x);
        if (alone.id[slot] == kNoId) continue;
        Layer here{alone.depth[slot], static_cast<std::int32_t>(t)};
        const auto in_front_of = [](const Layer& a, const Layer& b) {
          return a.depth > b.depth || (a.depth == b.depth && a.id < b.id);
        };
        if (in_front_of(here, first[p])) std::swap(here, first[p]);
        if (in_front_of(here, second[p])) second[p] = here;
      }
  }
  std::size_t shown = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const std::size_t slot = nearest.grid.slot(x, y), p = static_cast<std::size_t>(y * kWidth + x);
      INFO(x << ", " << y);
      REQUIRE(nearest.id[slot] == first[p].id);
      REQUIRE(behind.id[slot] == second[p].id);
      if (second[p].id != kNoId) REQUIRE(behind.depth[slot] == second[p].depth);
      shown += second[p].id != kNoId;
    }
  REQUIRE(shown > 5000);
}
