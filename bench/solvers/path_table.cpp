// The table of the flat path (path_solvers.h), by bisection in double.
#include <cmath>

#include "bench/solvers/path_solvers.h"
#include "core/error.h"

namespace shoal {

namespace {

// 1 / q where the path crosses d = x / (1 - x) metres in depths of 1 - y (thin) and y (dense).
double inverse_q(double ratio, double x, double y) {
  const double m = (ratio - 1.0) * (ratio + 1.0), thin = 1.0 - y, dense = y;
  if (x >= 1.0) return 0.0;  // endlessly far away: S grows without bound
  const double d = x / (1.0 - x);
  // By the thin side's sine, which is bounded; the path's width grows with it.
  double lo = 0.0, hi = 1.0;
  for (int i = 0; i < 100; ++i) {
    const double mid = 0.5 * (lo + hi), cosine = std::sqrt((1.0 - mid) * (1.0 + mid));
    const double dense_sine = mid / ratio;
    const double width =
        (thin > 0.0 ? thin * mid / cosine : 0.0) + dense * dense_sine / std::sqrt(1.0 - dense_sine * dense_sine);
    (width < d ? lo : hi) = mid;
  }
  const double cosine2 = (1.0 - hi) * (1.0 + hi);
  return std::sqrt(cosine2 / (ratio * ratio * cosine2 + m * hi * hi));
}

}  // namespace

PathTable make_path_table(const PathConstants& c, std::size_t size) {
  if (size < 2 || size > 4096) throw UsageError("a path table's size is out of range; expected 2 to 4096");
  PathTable table;
  table.size = size;
  table.inv_q.resize(size * size);
  const double ratio = static_cast<double>(c.ratio), cells = static_cast<double>(size - 1);
  for (std::size_t row = 0; row < size; ++row)
    for (std::size_t column = 0; column < size; ++column)
      table.inv_q[row * size + column] =
          static_cast<float>(inverse_q(ratio, static_cast<double>(column) / cells, static_cast<double>(row) / cells));
  return table;
}

}  // namespace shoal
