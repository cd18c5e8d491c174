// Each way to solve the flat path against bisection in long double; the errors are those of docs/solvers.md.
// `test_refraction "[measure]"` prints that page's rows.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "tests/refraction/path_oracle.h"
#include "bench/solvers/path_solvers.h"

namespace {

using namespace shoal;
using namespace shoal_test;

enum class Way { kFixedPoint, kNewton, kHalley, kQuartic, kTable };

// A solver and what docs/solvers.md says of it at ior 1.333, both grids together, from the thin and the dense side.
struct Row {
  const char* name;
  Way way;
  int steps;  // or points a side of the table
  double thin_relative, thin_px, dense_relative, dense_px;
};
const std::vector<Row> kRows = {
    {"fixed point, 1", Way::kFixedPoint, 1, 1.6, 84, 0.99, 5.1e+02},
    {"fixed point, 2", Way::kFixedPoint, 2, 0.98, 64, 0.99, 4.1e+02},
    {"fixed point, 4", Way::kFixedPoint, 4, 0.51, 40, 0.97, 2.7e+02},
    {"fixed point, 8", Way::kFixedPoint, 8, 0.19, 18, 0.93, 1.5e+02},
    {"fixed point, 16", Way::kFixedPoint, 16, 0.029, 3.6, 0.84, 61},
    {"Newton, 1", Way::kNewton, 1, 0.025, 9.4, 0.12, 0.62},
    {"Newton, 2", Way::kNewton, 2, 0.00075, 0.3, 0.017, 0.028},
    {"Newton, 3", Way::kNewton, 3, 8.6e-07, 0.00035, 0.0004, 0.00058},
    {"Newton, 4", Way::kNewton, 4, 6.5e-07, 0.00013, 2.1e-06, 9.7e-05},
    {"Halley, 1", Way::kHalley, 1, 0.00096, 0.3, 0.005, 0.12},
    {"Halley, 2 (ours)", Way::kHalley, 2, 8.8e-07, 0.00014, 4.8e-06, 9.7e-05},
    {"Halley, 3", Way::kHalley, 3, 8.8e-07, 0.00014, 3.7e-06, 9.7e-05},
    {"quartic, closed form", Way::kQuartic, 0, 0.0011, 0.00091, 0.0045, 0.87},
    {"table, 65 x 65", Way::kTable, 65, 0.024, 3.4, 0.93, 13},
    {"table, 129 x 129", Way::kTable, 129, 0.0046, 0.62, 0.62, 9.4},
    {"table, 257 x 257", Way::kTable, 257, 0.0011, 0.16, 0.35, 3.6},
};

template <class F>
SHOAL_INLINE PathSolution<F> solve(const Row& row, const PathConstants& c, const PathTable& table, F thin_m, F dense_m,
                                   F d_m) {
  switch (row.way) {
    case Way::kFixedPoint:
      return solve_fixed_point(c, thin_m, dense_m, d_m, row.steps);
    case Way::kNewton:
      return solve_newton(c, thin_m, dense_m, d_m, row.steps);
    case Way::kHalley:
      return solve_halley(c, thin_m, dense_m, d_m, row.steps);
    case Way::kQuartic:
      return solve_quartic(c, thin_m, dense_m, d_m);
    default:
      return solve_table(c, table, thin_m, dense_m, d_m);
  }
}

PathTable table_of(const Row& row, const PathConstants& c) {
  return row.way == Way::kTable ? make_path_table(c, static_cast<std::size_t>(row.steps)) : PathTable{};
}

struct GridPath {
  float far_m, d_m;
  double want;
};
// The oracle is slow: each grid once.
const std::vector<GridPath>& grid_paths(float ior, bool eye_above) {
  static std::map<std::pair<float, bool>, std::vector<GridPath>> known;
  std::vector<GridPath>& paths = known[{ior, eye_above}];
  if (!paths.empty()) return paths;
  for (const bool log_spaced : {true, false})
    for_each_path(log_spaced, [&](float far_m, float d_m) {
      paths.push_back({far_m, d_m,
                       oracle_distance(static_cast<double>(ior), eye_above, 2.0, static_cast<double>(far_m),
                                       static_cast<double>(d_m))});
    });
  return paths;
}

struct Errors {
  double relative = 0, px = 0;
  double median_relative = 0, median_px = 0;
};

Errors measure(const Row& row, float ior, bool eye_above) {
  const PathConstants c = path_constants(ior);
  const PathTable table = table_of(row, c);
  const bool eye_is_thin = eye_above != c.water_is_thin;
  std::vector<double> relative, px;
  for (const GridPath& p : grid_paths(ior, eye_above)) {
    const PathSolution<float> path =
        eye_is_thin ? solve(row, c, table, 2.0f, p.far_m, p.d_m) : solve(row, c, table, p.far_m, 2.0f, p.d_m);
    const double got = static_cast<double>(apparent_distance(path, eye_is_thin, p.far_m));
    relative.push_back(std::fabs(got - p.want) / p.want);
    px.push_back(pixels_between(got, p.want, static_cast<double>(p.d_m)));
  }
  std::sort(relative.begin(), relative.end()), std::sort(px.begin(), px.end());
  return {relative.back(), px.back(), relative[relative.size() / 2], px[px.size() / 2]};
}

}  // namespace

TEST_CASE("measure: errors of the path solvers", "[.][measure]") {
  for (const Row& row : kRows) {
    const Errors thin = measure(row, 1.333f, true), dense = measure(row, 1.333f, false);
    std::printf("| %s | %.2g | %.2g | %.2g | %.2g | %.2g | %.2g | %.2g | %.2g |\n", row.name, thin.relative,
                thin.median_relative, thin.px, thin.median_px, dense.relative, dense.median_relative, dense.px,
                dense.median_px);
  }
  SUCCEED();
}

TEST_CASE("every path solver is as far off as docs/solvers.md says", "[refraction]") {
  for (const Row& row : kRows) {
    const Errors thin = measure(row, 1.333f, true), dense = measure(row, 1.333f, false);
    CAPTURE(row.name, thin.relative, thin.px, dense.relative, dense.px);
    // No farther, and not much less: a row that got better is to be measured again.
    CHECK(thin.relative <= row.thin_relative);
    CHECK(thin.relative >= 0.5 * row.thin_relative);
    CHECK(thin.px <= row.thin_px);
    CHECK(dense.relative <= row.dense_relative);
    CHECK(dense.relative >= 0.5 * row.dense_relative);
    CHECK(dense.px <= row.dense_px);
  }
}

TEST_CASE("the converged solvers are right for every pair of media", "[refraction]") {
  for (const float ior : {1.0f / 3.0f, 0.75f, 1.0f, 1.01f, 3.0f}) {
    for (const bool eye_above : {true, false}) {
      for (const Row& row : kRows) {
        if (!((row.way == Way::kNewton && row.steps == 4) || (row.way == Way::kHalley && row.steps == 3))) continue;
        const Errors errors = measure(row, ior, eye_above);
        CAPTURE(row.name, ior, eye_above, errors.relative);
        CHECK(errors.relative < 1e-5);
        CHECK(errors.px < 5e-4);
      }
    }
  }
}

TEST_CASE("Halley with two steps is solve_path, to the bit", "[refraction]") {
  const PathConstants c = path_constants(1.333f);
  for (const GridPath& p : grid_paths(1.333f, true)) {
    const PathSolution<float> ours = solve_path(c, 2.0f, p.far_m, p.d_m),
                              same = solve_halley(c, 2.0f, p.far_m, p.d_m, 2);
    REQUIRE(as_int(ours.q) == as_int(same.q));
    REQUIRE(as_int(ours.tan_thin) == as_int(same.tan_thin));
  }
}

TEST_CASE("no path solver gives a NaN, and lanes give the bits of scalars", "[refraction]") {
  const std::vector<float> lengths = {0.0f, 1e-45f, 1e-38f, 1e-30f, 1e-20f, 1e-10f, 1e-3f,
                                      1.0f, 2.28f,  1e3f,   1e10f,  1e20f,  1e30f};
  for (const Row& row : kRows) {
    for (const float ior : {1.0f / 3.0f, 1.0f, 1.0000001f, 1.333f, 3.0f}) {
      const PathConstants c = path_constants(ior);
      const PathTable table = table_of(row, c);
      for (const float thin : lengths) {
        for (const float dense : lengths) {
          float lanes[16] = {}, wide[16];
          std::copy(lengths.begin(), lengths.end(), lanes);
          solve(row, c, table, WideF(thin), WideF(dense), WideF::load(lanes)).q.store(wide);
          for (std::size_t i = 0; i < 16; ++i) {
            const PathSolution<float> path = solve(row, c, table, thin, dense, lanes[i]);
            CAPTURE(row.name, ior, thin, dense, lanes[i], path.q, path.tan_thin);
            REQUIRE(std::isfinite(path.q));
            REQUIRE(path.q >= 1.0f);
            REQUIRE(std::isfinite(path.tan_thin));
            REQUIRE(path.tan_thin >= 0.0f);
            REQUIRE(as_int(path.q) == as_int(wide[i]));
          }
        }
      }
    }
  }
}
