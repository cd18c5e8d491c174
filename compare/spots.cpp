#include "compare/spots.h"

#include <algorithm>
#include <tuple>

namespace shoal {

std::vector<Spot> largest_spots(const std::vector<float>& error, int width_px, float threshold, std::size_t most) {
  const int height_px = width_px > 0 ? static_cast<int>(error.size() / static_cast<std::size_t>(width_px)) : 0;
  const auto at = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) + static_cast<std::size_t>(x);
  };
  std::vector<bool> open(error.size());
  for (std::size_t i = 0; i < error.size(); ++i) open[i] = error[i] >= threshold;
  std::vector<Spot> spots;
  std::vector<std::size_t> front;
  for (std::size_t start = 0; start < error.size(); ++start) {
    if (!open[start]) continue;
    Spot spot;
    std::size_t peak = start;
    open[start] = false;
    front.assign(1, start);
    while (!front.empty()) {
      const std::size_t pixel = front.back();
      front.pop_back();
      ++spot.size_px;
      if (error[pixel] > error[peak] || (error[pixel] == error[peak] && pixel < peak)) peak = pixel;
      const int x = static_cast<int>(pixel % static_cast<std::size_t>(width_px));
      const int y = static_cast<int>(pixel / static_cast<std::size_t>(width_px));
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height_px - 1); ++v) {
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width_px - 1); ++u) {
          if (!open[at(u, v)]) continue;
          open[at(u, v)] = false;
          front.push_back(at(u, v));
        }
      }
    }
    spot.x = static_cast<int>(peak % static_cast<std::size_t>(width_px));
    spot.y = static_cast<int>(peak / static_cast<std::size_t>(width_px));
    spot.greatest = error[peak];
    spots.push_back(spot);
  }
  const auto larger = [](const Spot& a, const Spot& b) {
    return std::tuple(b.size_px, b.greatest, a.y, a.x) < std::tuple(a.size_px, a.greatest, b.y, b.x);
  };
  std::sort(spots.begin(), spots.end(), larger);
  if (spots.size() > most) spots.resize(most);
  return spots;
}

}  // namespace shoal
