// Spots of maps that are drawn here.
#include <catch2/catch.hpp>
#include <string>

#include "compare/spots.h"

namespace shoal::test {
namespace {

// '.' is 0, a digit so many tenths.
std::vector<float> map_of(const std::vector<std::string>& rows) {
  std::vector<float> map;
  for (const std::string& row : rows)
    for (const char c : row) map.push_back(c == '.' ? 0.0f : 0.1f * static_cast<float>(c - '0'));
  return map;
}

}  // namespace

TEST_CASE("spots: sizes, peaks and order", "[spots]") {
  const auto map = map_of({
      "2......4",
      "3..11...",  // 1s are below the threshold
      ".5.11..6",
      "..9....6",  // a corner joins; nothing goes round from the right to the left
      "8.......",
  });
  const std::vector<Spot> spots = largest_spots(map, 8, 0.15f, 10);
  REQUIRE(spots.size() == 4);
  CHECK(spots[0].size_px == 4);
  CHECK(spots[0].x == 2);
  CHECK(spots[0].y == 3);
  CHECK(spots[0].greatest == 0.1f * 9);
  CHECK(spots[1].size_px == 2);  // equal errors: the first
  CHECK(spots[1].x == 7);
  CHECK(spots[1].y == 2);
  CHECK(spots[2].greatest == 0.1f * 8);  // of one pixel each, the greater
  CHECK(spots[3].y == 0);
  CHECK(spots[3].x == 7);
  CHECK(largest_spots(map, 8, 0.15f, 1).size() == 1);
  CHECK(largest_spots(map, 8, 0.95f, 10).empty());
  CHECK(largest_spots({}, 0, 0.1f, 10).empty());
  CHECK(largest_spots(std::vector<float>(12, 1.0f), 4, 1.0f, 10).front().size_px == 12);
}

}  // namespace shoal::test
