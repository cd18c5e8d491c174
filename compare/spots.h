// Where two pictures differ most: the largest connected spots of an error map.
#pragma once

#include <cstddef>
#include <vector>

namespace shoal {

struct Spot {
  int x = 0, y = 0;  // the pixel of the greatest error, the first of them from the top left
  std::size_t size_px = 0;
  float greatest = 0;
};

// FLIP from which on a pixel belongs to a spot, and how many spots are told.
inline constexpr float kSpotFlip = 0.1f;
inline constexpr std::size_t kMostSpots = 10;

// The largest sets of pixels at or above a threshold that touch one another, by side or by corner.
//
//   error   rows from the top, width_px a row
// Returns at most `most`, the largest first, of equal ones the greater error, then the one nearer the top left.
std::vector<Spot> largest_spots(const std::vector<float>& error, int width_px, float threshold, std::size_t most);

}  // namespace shoal
