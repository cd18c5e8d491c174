// Sums and percentiles against numbers counted by hand.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "compare/statistics.h"

namespace shoal::test {

TEST_CASE("statistics: nearest-rank percentiles of ten values", "[statistics]") {
  const std::vector<float> values = {9, 1, 8, 2, 7, 3, 6, 4, 10, 5};
  CHECK(mean_of(values) == 5.5);
  CHECK(percentile_of(values, 0.5) == 5);
  CHECK(percentile_of(values, 0.51) == 6);
  CHECK(percentile_of(values, 0.95) == 10);
  CHECK(percentile_of(values, 0.9) == 9);
  CHECK(percentile_of(values, 0) == 1);
  CHECK(percentile_of(values, 1) == 10);
  CHECK(percentile_of({3}, 0.5) == 3);
}

TEST_CASE("statistics: weighted percentiles", "[statistics]") {
  // Sum 10: 1 holds a tenth, 1 + 2 three tenths, 1 + 2 + 3 six.
  CHECK(weighted_percentile_of({4, 1, 3, 2}, 0.1) == 1);
  CHECK(weighted_percentile_of({4, 1, 3, 2}, 0.25) == 2);
  CHECK(weighted_percentile_of({4, 1, 3, 2}, 0.5) == 3);
  CHECK(weighted_percentile_of({4, 1, 3, 2}, 0.75) == 4);
  CHECK(weighted_percentile_of({0, 0, 1}, 0.5) == 1);
  CHECK(weighted_percentile_of({0, 0, 0}, 0.5) == 0);
}

TEST_CASE("statistics: masks, and nothing at all", "[statistics]") {
  const std::vector<float> values = {1, 2, 3, 100};
  const MapSummary inside = summarize(values, {true, true, true, false});
  CHECK(inside.mean == 2);
  CHECK(inside.median == 2);
  CHECK(inside.p95 == 3);
  CHECK(summarize(values, {}).mean == 26.5);
  const MapSummary nothing = summarize(values, {false, false, false, false});
  CHECK(std::isnan(nothing.mean));
  CHECK(std::isnan(nothing.median));
  CHECK(std::isnan(weighted_percentile_of({}, 0.5)));
}

TEST_CASE("statistics: PSNR", "[statistics]") {
  const std::vector<std::uint8_t> black(6, 0);
  CHECK(psnr_db(black, black, {}) == std::numeric_limits<double>::infinity());
  CHECK(psnr_db(black, std::vector<std::uint8_t>(6, 255), {}) == 0);
  // One channel of six is off by a fifth of 255: mean square 0.04 / 6.
  const std::vector<std::uint8_t> one = {0, 0, 0, 0, 51, 0};
  CHECK(psnr_db(black, one, {}) == Approx(10 * std::log10(6 / 0.04)));
  CHECK(psnr_db(black, one, {false, true}) == Approx(10 * std::log10(3 / 0.04)));
  CHECK(psnr_db(black, one, {true, false}) == std::numeric_limits<double>::infinity());
  CHECK(std::isnan(psnr_db(black, one, {false, false})));
}

}  // namespace shoal::test
