#include "compare/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace shoal {

namespace {
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
}

std::vector<float> masked_values(const std::vector<float>& values, const PixelMask& mask) {
  if (mask.empty()) return values;
  std::vector<float> counted;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (mask[i]) counted.push_back(values[i]);
  }
  return counted;
}

double mean_of(const std::vector<float>& values) {
  if (values.empty()) return kNone;
  double sum = 0;
  for (const float value : values) sum += static_cast<double>(value);
  return sum / static_cast<double>(values.size());
}

double percentile_of(std::vector<float> values, double q) {
  if (values.empty()) return kNone;
  const auto n = static_cast<double>(values.size());
  const double rank = std::clamp(std::ceil(q * n), 1.0, n);
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(rank) - 1;
  std::nth_element(values.begin(), place, values.end());
  return static_cast<double>(*place);
}

double weighted_percentile_of(std::vector<float> values, double q) {
  if (values.empty()) return kNone;
  std::sort(values.begin(), values.end());
  double total = 0;
  for (const float value : values) total += static_cast<double>(value);
  double below = 0;
  for (const float value : values) {
    below += static_cast<double>(value);
    if (below >= q * total) return static_cast<double>(value);
  }
  return static_cast<double>(values.back());
}

MapSummary summarize(const std::vector<float>& values, const PixelMask& mask) {
  const std::vector<float> counted = masked_values(values, mask);
  return {mean_of(counted), percentile_of(counted, 0.5), percentile_of(counted, 0.95)};
}

double psnr_db(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b, const PixelMask& mask) {
  std::uint64_t sum = 0, pixels = 0;
  for (std::size_t i = 0; i < a.size() / 3; ++i) {
    if (!mask.empty() && !mask[i]) continue;
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
      const int d = int{a[c]} - int{b[c]};
      sum += static_cast<std::uint64_t>(d * d);
    }
    ++pixels;
  }
  if (pixels == 0) return kNone;
  if (sum == 0) return std::numeric_limits<double>::infinity();
  return -10.0 * std::log10(static_cast<double>(sum) / (static_cast<double>(pixels) * 3.0 * 255.0 * 255.0));
}

}  // namespace shoal
