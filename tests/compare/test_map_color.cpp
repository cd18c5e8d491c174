// Error maps: the scale's ends, its order, and the colours of what has no error.
#include <catch2/catch.hpp>

#include "compare/map_color.h"

namespace shoal::test {

TEST_CASE("map colours: the more, the brighter", "[map_color]") {
  int last = -1;
  for (int i = 0; i <= 50; ++i) {
    const Rgb8 c = magma(i / 50.0);
    const int luminance = 2126 * c.r + 7152 * c.g + 722 * c.b;
    CHECK(luminance > last);
    last = luminance;
  }
  CHECK(magma(-1).b == magma(0).b);
  CHECK(magma(2).g == magma(1).g);
}

TEST_CASE("map colours: FLIP and its mask", "[map_color]") {
  const std::vector<std::uint8_t> rgb = flip_map_rgb({1.0f, 1.0f}, {true, false});
  REQUIRE(rgb.size() == 6);
  CHECK(int{rgb[0]} == 252);
  CHECK(int{rgb[3]} == 63);
  CHECK(flip_map_rgb({1.0f}, {}) == std::vector<std::uint8_t>{252, 253, 191});
}

TEST_CASE("map colours: hits", "[map_color]") {
  HitComparison hits;
  hits.water = {false, true, true, true, true, true};
  hits.error_map_px = {-1, -1, -1, 0.0f, 1.0f, 1000.0f};
  hits.wrong = {0, HitComparison::kWrongKind, 0, 0, 0, HitComparison::kWrongObject};
  const std::vector<std::uint8_t> rgb = hit_map_rgb(hits);
  const auto is = [&](std::size_t i, Rgb8 c) {
    return rgb[3 * i] == c.r && rgb[3 * i + 1] == c.g && rgb[3 * i + 2] == c.b;
  };
  CHECK(is(0, kNoWaterColor));
  CHECK(is(1, kWrongKindColor));
  CHECK(is(2, kSameKindColor));
  CHECK(is(3, magma(0)));
  CHECK(is(4, magma(0.5)));  // one pixel is in the middle of a hundredth and a hundred
  CHECK(is(5, magma(1)));
}

}  // namespace shoal::test
