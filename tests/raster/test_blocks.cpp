// Blocks, regions and slots of a frame, and the ray test of triangles, by plain counting and in double.
#include "raster/blocks.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "raster/camera.h"
#include "raster/triangle_test.h"

using namespace shoal;

TEST_CASE("the blocks of all regions hold each pixel of the frame once, where FrameGrid has its slot") {
  for (const int width : {1, 64, 65, 130, 203})
    for (const int height : {3, 64, 129}) {
      const FrameGrid grid = make_frame_grid(width, height);
      std::vector<int> seen(static_cast<std::size_t>(width * height), 0);
      int wrong = 0;
      for (std::size_t region = 0; region < grid.region_count(); ++region) {
        const RegionOrigin first = region_origin(grid, region);
        CHECK(first.x_px % kRegionSize == 0);
        CHECK((first.x_px < width && first.y_px < height));
        for_each_block(grid, region, [&](const Block& block) {
          CHECK((block.x_px / kRegionSize * kRegionSize == first.x_px && block.y_px >= first.y_px));
          alignas(64) std::int32_t slots[16];
          const WideI x = WideI(block.x_px) + block_x(), y = WideI(block.y_px) + block_y();
          pixel_slots(grid, x, y).store(slots);
          for (int lane = 0; lane < 16; ++lane) {
            const int column = block.x_px + lane % 4, row = block.y_px + lane / 4;
            const bool inside = column < width && row < height;
            wrong += inside != (((to_bits(block.in_frame) >> lane) & 1u) != 0);
            wrong += static_cast<std::size_t>(slots[lane]) != block.offset + static_cast<std::size_t>(lane);
            if (!inside) continue;
            wrong += grid.slot(column, row) != static_cast<std::size_t>(slots[lane]);
            ++seen[static_cast<std::size_t>(row * width + column)];
          }
        });
      }
      for (const int count : seen) wrong += count != 1;
      CAPTURE(width, height);
      CHECK(wrong == 0);
    }
}

TEST_CASE("a block's rays are those of its pixels' centres") {
  Camera camera;
  camera.position_world = {1, 2, 3};
  const View view = make_view(camera, 120, 80, {0.25f, -0.125f});
  const Block block = make_block(make_frame_grid(120, 80), 40, 12);
  const Ray<WideF> rays = block_rays(view, block);
  for (int lane = 0; lane < 16; ++lane) {
    const Ray<float> one = pixel_ray(view, 40.5f + static_cast<float>(lane % 4), 12.5f + static_cast<float>(lane / 4));
    CHECK(extract(rays.direction_world.x, lane) == one.direction_world.x);
    CHECK(extract(rays.direction_world.y, lane) == one.direction_world.y);
    CHECK(extract(rays.origin_world.z, lane) == one.origin_world.z);
  }
}

TEST_CASE("triangle ids: water and nothing are none") {
  alignas(64) std::int32_t ids[16] = {0, 1, kNoId, kFirstWaterId, kFirstWaterId + 5, -1, kNoId - 1, 77};
  for (int i = 8; i < 16; ++i) ids[i] = kNoId;
  CHECK(to_bits(is_triangle(WideI::load(ids))) == 0xC3u);
}

TEST_CASE("rays meet triangles as in double, but within the tolerance of the edges") {
  std::mt19937 engine(77);
  const auto random = [&] { return static_cast<float>(engine()) / 2147483648.0f - 1.0f; };
  int hits = 0, misses = 0, near_edge = 0, wrong = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3f p[3] = {{random(), random(), random()}, {random(), random(), random()}, {random(), random(), random()}};
    const Ray<float> ray{{random(), random(), 3 * random()}, {random(), random(), random()}};
    const Vec3f e1 = p[1] - p[0], e2 = p[2] - p[0];
    const auto wide = [](Vec3f v) { return broadcast<WideF>(v); };
    const TriangleTest test = test_triangle({wide(ray.origin_world), wide(ray.direction_world)}, wide(p[0]), wide(e1),
                                            wide(e2), mask_from_bits(0x7FFFu));
    const auto exact = [](Vec3f v) {
      return Vec3d{static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
    };
    const Vec3d d = exact(ray.direction_world), a = exact(e1), b = exact(e2), s = exact(ray.origin_world) - exact(p[0]);
    const double det = dot(a, cross(d, b));
    const double t = dot(b, cross(s, a)) / det, u = dot(s, cross(d, b)) / det, v = dot(d, cross(s, a)) / det;
    const double inside = std::min({u, v, 1 - u - v, t});
    wrong += ((to_bits(test.inside) >> 15) & 1u) != 0;  // not among the active lanes
    if (std::fabs(inside) < 1e-3 || std::fabs(det) < 1e-3) {
      ++near_edge;
      continue;
    }
    const bool hit = inside > 0;
    ++(hit ? hits : misses);
    wrong += to_bits(test.inside) != (hit ? 0x7FFFu : 0u);
    if (hit) wrong += std::fabs(static_cast<double>(extract(test.t, 3)) - t) > 1e-3 * (1 + t);
  }
  CAPTURE(hits, misses, near_edge);
  CHECK(hits > 200);
  CHECK(misses > 10000);
  CHECK(wrong == 0);
}
