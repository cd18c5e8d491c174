// Diffuse light of an environment picture by spherical harmonics.
#include "core/thread_pool.h"
#include "shading/environment/build.h"

namespace shoal::environment_parts {
namespace {

constexpr double kPiDouble = 3.14159265358979323846;

// Integrals over one column of texels: of 1, cos a, sin a, sin a cos a and cos 2a, a the angle from +x towards +z.
struct ColumnIntegrals {
  double f[5];
};
// Sums over one row of radiance times the columns' integrals.
struct RowSums {
  double f[5][3] = {};
};

std::vector<ColumnIntegrals> column_integrals(int width) {
  std::vector<ColumnIntegrals> columns;
  const auto n = static_cast<std::uint64_t>(width);
  const double step = 2 * kPiDouble / static_cast<double>(width);
  // The left edge is -x: half a turn before the angle 0.
  CirclePoint a = circle_point(0, n);
  for (std::uint64_t i = 0; i < n; ++i) {
    const CirclePoint b = circle_point(i + 1, n);
    columns.push_back({{step, a.sine - b.sine, b.cosine - a.cosine, (b.sine * b.sine - a.sine * a.sine) / 2,
                        b.sine * b.cosine - a.sine * a.cosine}});
    a = b;
  }
  return columns;
}

}  // namespace

std::array<Vec3f, 9> irradiance_harmonics(const EquirectImage& image, ThreadPool& pool) {
  const std::vector<ColumnIntegrals> columns = column_integrals(image.width);
  const auto rows = static_cast<std::size_t>(image.height), width = static_cast<std::size_t>(image.width);
  std::vector<RowSums> sums(rows);
  pool.for_each(rows, [&](std::size_t row, int) {
    const float* texel = &image.rgb[row * width * 3];
    for (std::size_t x = 0; x < width; ++x, texel += 3) {
      for (int k = 0; k < 5; ++k) {
        for (int c = 0; c < 3; ++c) sums[row].f[k][c] += static_cast<double>(texel[c]) * columns[x].f[k];
      }
    }
  });

  // With y the cosine c of the angle from +y and s its sine, the radius of the ring: integrals over a row of the
  // factors that multiply the column's integral, times s for the area.
  double total[9][3] = {};
  for (std::size_t row = 0; row < rows; ++row) {
    const CirclePoint a = circle_point(row, 2 * rows), b = circle_point(row + 1, 2 * rows);
    const double angle = kPiDouble / static_cast<double>(rows);
    const double area = a.cosine - b.cosine;
    const double y = (b.sine * b.sine - a.sine * a.sine) / 2;
    const double yy = (a.cosine * a.cosine * a.cosine - b.cosine * b.cosine * b.cosine) / 3;
    const double ring = (angle - (b.sine * b.cosine - a.sine * a.cosine)) / 2;
    const double ring_y = (b.sine * b.sine * b.sine - a.sine * a.sine * a.sine) / 3;
    const double ring2 = area - yy;
    const double part[9] = {area, y, ring, ring, ring_y, ring_y, 3 * yy - area, ring2, ring2};
    const int column[9] = {0, 0, 2, 1, 1, 2, 0, 3, 4};
    for (int k = 0; k < 9; ++k) {
      for (int c = 0; c < 3; ++c) total[k][c] += part[k] * sums[row].f[column[k]][c];
    }
  }

  // The basis functions' squares and the cosine lobe's 1, 2/3, 1/4, over the whole sphere's 4 pi.
  constexpr double kFactor[9] = {1, 2, 2, 2, 3.75, 3.75, 0.3125, 3.75, 0.9375};
  std::array<Vec3f, 9> out;
  for (std::size_t k = 0; k < 9; ++k) {
    const double factor = kFactor[k] / (4 * kPiDouble);
    out[k] = {static_cast<float>(total[k][0] * factor), static_cast<float>(total[k][1] * factor),
              static_cast<float>(total[k][2] * factor)};
  }
  return out;
}

}  // namespace shoal::environment_parts
