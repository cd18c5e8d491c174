// Coverage against the exact oracle (coverage_oracle.h): which triangles cover which pixels, every pixel of the frame.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "coverage_oracle.h"

using namespace shoal_test;

namespace {

struct FrameSize {
  int width_px, height_px;
};

// Front end and tiles against the oracle.
void check_mesh(const GridMesh& mesh, FrameSize size, int tile_px, bool two_sided, float w = 1) {
  const Vec2f centre{static_cast<float>(size.width_px) * 0.5f, static_cast<float>(size.height_px) * 0.5f};
  const Geometry g = geometry_of(mesh.positions, mesh.indices);
  const PassSettings pass = whole_frame(size.width_px, size.height_px, centre, tile_px);
  const Coverage seen = raster_coverage(g, PixelProgram{centre, w}, pass, two_sided, 3);
  const Coverage expected = oracle_coverage(mesh.triangles(), size.width_px, size.height_px, two_sided);
  for (std::size_t i = 0; i < expected.count.size(); ++i) {
    if (seen.count[i] == expected.count[i] && seen.marks[i] == expected.marks[i]) continue;
    FAIL("frame " << size.width_px << "x" << size.height_px << " tile " << tile_px << " pixel "
                  << i % static_cast<std::size_t>(size.width_px) << "," << i / static_cast<std::size_t>(size.width_px)
                  << ": covered by " << seen.count[i] << " triangles, expected " << expected.count[i]);
  }
  SUCCEED();
}

// Each pixel whose centre is within [x0, x1) x [y0, y1) exactly once, no other.
void check_covered_once(const GridMesh& mesh, FrameSize size, int tile_px, int x0, int y0, int x1, int y1) {
  const Vec2f centre{static_cast<float>(size.width_px) * 0.5f, static_cast<float>(size.height_px) * 0.5f};
  const Geometry g = geometry_of(mesh.positions, mesh.indices);
  const PassSettings pass = whole_frame(size.width_px, size.height_px, centre, tile_px);
  const Coverage seen = raster_coverage(g, PixelProgram{centre}, pass, true, 2);
  long wrong = 0;
  for (int y = 0; y < size.height_px; ++y)
    for (int x = 0; x < size.width_px; ++x) {
      const bool inside = x >= x0 && x < x1 && y >= y0 && y < y1;
      wrong += seen.count[seen.at(x, y)] != (inside ? 1u : 0u);
    }
  CHECK(wrong == 0);
}

constexpr int kTiles[] = {16, 32, 64, 128, 256};
constexpr FrameSize kFrames[] = {{1, 1}, {3, 5}, {16, 16}, {64, 64}, {131, 77}, {65, 257}, {320, 63}};

// A grid of jittered quads over [x0, x1] x [y0, y1] px, its outline straight; both diagonals occur.
GridMesh jittered_grid(int columns, int rows, std::int64_t x0, std::int64_t y0, std::int64_t x1, std::int64_t y1,
                       TestRandom& random, bool snap_to_centres) {
  GridMesh m;
  const std::int64_t dx = (x1 - x0) / columns, dy = (y1 - y0) / rows;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const bool edge_x = i == 0 || i == columns, edge_y = j == 0 || j == rows;
      std::int64_t x = i == columns ? x1 : x0 + i * dx, y = j == rows ? y1 : y0 + j * dy;
      if (!edge_x) x += random.integer(-dx / 4, dx / 4);
      if (!edge_y) y += random.integer(-dy / 4, dy / 4);
      // Vertices at pixel centres, so that samples lie on edges and corners.
      if (snap_to_centres && !edge_x) x = x / 256 * 256 + 128;
      if (snap_to_centres && !edge_y) y = y / 256 * 256 + 128;
      m.vertex(x, y, 0.5f);
    }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (columns + 1) + i); };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      if (random.integer(0, 1) != 0) {
        m.triangle(at(i, j), at(i, j + 1), at(i + 1, j + 1)), m.triangle(at(i, j), at(i + 1, j + 1), at(i + 1, j));
      } else {
        m.triangle(at(i, j), at(i, j + 1), at(i + 1, j)), m.triangle(at(i + 1, j), at(i, j + 1), at(i + 1, j + 1));
      }
    }
  return m;
}

}  // namespace

TEST_CASE("coverage: random triangles of all sizes equal the exact oracle") {
  TestRandom random(1);
  for (const FrameSize size : kFrames)
    for (const int tile : kTiles) {
      GridMesh m;
      for (int i = 0; i < 120; ++i) {
        const std::int64_t reach = std::int64_t(1) << random.integer(3, 17);
        const std::int64_t x = random.integer(-2000, size.width_px * 256 + 2000),
                           y = random.integer(-2000, size.height_px * 256 + 2000);
        std::uint32_t v[3];
        for (std::uint32_t& k : v)
          k = m.vertex(x + random.integer(-reach, reach), y + random.integer(-reach, reach), 0.5f);
        m.triangle(v[0], v[1], v[2]);
      }
      for (const bool two_sided : {false, true}) check_mesh(m, size, tile, two_sided, two_sided ? 4.0f : 1.0f);
    }
}

TEST_CASE("coverage: corners and edges on sample points equal the exact oracle") {
  TestRandom random(2);
  const FrameSize size{40, 36};
  for (const int tile : {16, 64}) {
    for (int round = 0; round < 8; ++round) {
      GridMesh m;
      const int reach = round < 4 ? 6 : 150;  // both the packets' and the large triangles' path
      for (int i = 0; i < 150; ++i) {
        const int cx = static_cast<int>(random.integer(0, 40)), cy = static_cast<int>(random.integer(0, 36));
        std::uint32_t v[3];
        for (std::uint32_t& k : v)
          k = m.vertex((cx + random.integer(-reach, reach)) * 256 + 128,
                       (cy + random.integer(-reach, reach)) * 256 + 128, 0.5f);
        m.triangle(v[0], v[1], v[2]);
      }
      check_mesh(m, size, tile, true);
      check_mesh(m, size, tile, false);
    }
  }
}

TEST_CASE("coverage: slivers, needles and degenerate triangles equal the exact oracle") {
  TestRandom random(3);
  const FrameSize size{131, 77};
  for (const int tile : {16, 64, 256}) {
    GridMesh m;
    for (int i = 0; i < 300; ++i) {
      const std::int64_t x = random.integer(-200, size.width_px * 256 + 200),
                         y = random.integer(-200, size.height_px * 256 + 200);
      const std::int64_t reach = i % 2 == 0 ? 4000 : 60000, dx = random.integer(-reach, reach),
                         dy = random.integer(-reach, reach);
      const std::int64_t thick = random.integer(0, 3);
      const std::uint32_t a = m.vertex(x, y, 0.5f), b = m.vertex(x + dx, y + dy, 0.5f);
      switch (i % 5) {
        case 0:
          m.triangle(a, b, m.vertex(x + thick, y + random.integer(-1, 1), 0.5f));
          break;  // needle
        case 1:
          m.triangle(a, b, m.vertex(x + dx / 2 + thick, y + dy / 2, 0.5f));
          break;  // sliver
        case 2:
          m.triangle(a, b, m.vertex(x + 2 * dx, y + 2 * dy, 0.5f));
          break;  // collinear
        case 3:
          m.triangle(a, a, b);
          break;
        default:
          m.triangle(a, a, a);
          break;
      }
    }
    check_mesh(m, size, tile, true);
    check_mesh(m, size, tile, false);
  }
}

TEST_CASE("coverage: huge triangles up to the guard band equal the exact oracle") {
  TestRandom random(4);
  // Long frames reach the far ends of the coordinate range in either direction.
  for (const FrameSize size : {FrameSize{16384, 6}, FrameSize{5, 16384}, FrameSize{200, 120}}) {
    const std::int64_t cx = size.width_px * 128, cy = size.height_px * 128, reach = 16384 * 256;
    for (const int tile : {16, 64, 256}) {
      GridMesh m;
      for (int i = 0; i < 12; ++i) {
        std::uint32_t v[3];
        for (std::uint32_t& k : v) {
          const std::int64_t band_x = i % 3 == 0 ? size.width_px * 128 : reach,
                             band_y = i % 3 == 0 ? size.height_px * 128 : reach;
          k = m.vertex(cx + random.integer(-band_x, band_x), cy + random.integer(-band_y, band_y), 0.5f);
        }
        m.triangle(v[0], v[1], v[2]);
      }
      // The guard band's own corners.
      m.triangle(m.vertex(cx - reach, cy - reach, 0.5f), m.vertex(cx - reach, cy + reach, 0.5f),
                 m.vertex(cx + reach, cy + reach, 0.5f));
      m.triangle(m.vertex(cx - reach, cy - reach + 1, 0.5f), m.vertex(cx + reach, cy + reach, 0.5f),
                 m.vertex(cx + reach, cy + reach - 3, 0.5f));
      check_mesh(m, size, tile, true);
    }
  }
}

TEST_CASE("coverage: meshes with shared edges cover each pixel exactly once") {
  TestRandom random(5);
  const FrameSize size{131, 77};
  const int x0 = 7, y0 = 3, x1 = 120, y1 = 71;  // the outline runs between pixel centres
  for (const int tile : kTiles)
    for (const int cells : {1, 2, 7, 40})
      for (const bool centres : {false, true}) {
        if (centres && cells > 10) continue;  // centres would meet
        const GridMesh m = jittered_grid(cells, cells, x0 * 256, y0 * 256, x1 * 256, y1 * 256, random, centres);
        check_covered_once(m, size, tile, x0, y0, x1, y1);
      }
  // The outline on pixel centres: top and left edges own theirs, bottom and right ones do not.
  for (const int tile : kTiles) {
    const GridMesh m =
        jittered_grid(5, 5, x0 * 256 + 128, y0 * 256 + 128, x1 * 256 + 128, y1 * 256 + 128, random, true);
    check_covered_once(m, size, tile, x0, y0, x1, y1);
  }
}

TEST_CASE("coverage: fans round a point cover each pixel exactly once") {
  TestRandom random(6);
  const FrameSize size{100, 100};
  for (int round = 0; round < 12; ++round) {
    GridMesh m;
    const std::int64_t px = random.integer(30, 70) * 256 + (round % 2 == 0 ? 128 : random.integer(0, 255));
    const std::int64_t py = random.integer(30, 70) * 256 + (round % 3 == 0 ? 128 : random.integer(0, 255));
    const std::uint32_t hub = m.vertex(px, py, 0.5f);
    // Round the square [4, 96)^2, its corners among the rim's points.
    std::vector<std::pair<std::int64_t, std::int64_t>> rim;
    const std::int64_t lo = 4 * 256, hi = 96 * 256;
    for (int side = 0; side < 4; ++side) {
      std::vector<std::int64_t> along{lo};
      for (int i = 0; i < round * 3; ++i) along.push_back(random.integer(lo + 1, hi - 1));
      std::sort(along.begin(), along.end());
      along.erase(std::unique(along.begin(), along.end()), along.end());
      for (const std::int64_t a : along) {
        if (side == 0) rim.emplace_back(lo, a);
        if (side == 1) rim.emplace_back(a, hi);
        if (side == 2) rim.emplace_back(hi, lo + hi - a);
        if (side == 3) rim.emplace_back(lo + hi - a, lo);
      }
    }
    std::vector<std::uint32_t> v;
    for (const auto& [x, y] : rim) v.push_back(m.vertex(x, y, 0.5f));
    for (std::size_t i = 0; i < v.size(); ++i) m.triangle(hub, v[i], v[(i + 1) % v.size()]);
    check_covered_once(m, size, round % 2 == 0 ? 32 : 64, 4, 4, 96, 96);
  }
}

TEST_CASE("coverage: a large shared-edge mesh across the guard band covers each pixel exactly once") {
  TestRandom random(7);
  const std::int64_t reach = 16384 * 256;
  for (const FrameSize size : {FrameSize{16384, 4}, FrameSize{300, 200}}) {
    const std::int64_t cx = size.width_px * 128, cy = size.height_px * 128;
    const GridMesh m = jittered_grid(9, 9, cx - reach, cy - reach, cx + reach, cy + reach, random, false);
    check_covered_once(m, size, 64, 0, 0, size.width_px, size.height_px);
  }
}

TEST_CASE("coverage: a pass that is bounded draws nothing outside of its bounds' tiles and all inside") {
  TestRandom random(8);
  const FrameSize size{256, 192};
  const GridMesh m = jittered_grid(6, 6, 0, 0, 256 * 256, 192 * 256, random, false);
  const Geometry g = geometry_of(m.positions, m.indices);
  for (const int tile : {16, 64}) {
    PassSettings pass = whole_frame(size.width_px, size.height_px, {128, 96}, tile);
    pass.x_min = 64, pass.y_min = 64, pass.x_max = 127, pass.y_max = 191;
    const Coverage seen = raster_coverage(g, PixelProgram{{128, 96}}, pass, true, 1);
    long wrong = 0;
    for (int y = 64; y < 192; ++y)
      for (int x = 64; x < 128; ++x) wrong += seen.count[seen.at(x, y)] != 1;
    for (int y = 0; y < 192; ++y) wrong += seen.count[seen.at(0, y)] != 0;
    CHECK(wrong == 0);
  }
}
