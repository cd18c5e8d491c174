// Numbers that sum up a map: means, percentiles, PSNR. Sums run in the order of the pixels, in double precision.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace shoal {

// Which pixels count, row by row from the top; an empty one: all do.
using PixelMask = std::vector<bool>;

// The values whose pixels count, in their order.
//   mask  empty, or as long as the values
std::vector<float> masked_values(const std::vector<float>& values, const PixelMask& mask);

// Of no values: NaN.
double mean_of(const std::vector<float>& values);

// The nearest-rank percentile: the least value that is not below a share q of all values.
//
//   values  no NaN
//   q       0 to 1
// Returns NaN of no values.
double percentile_of(std::vector<float> values, double q);

// The percentile with each value weighted by itself: the least value such that it and all below hold a share q of the
// sum of all values.
//
//   values  0 or more
// Returns NaN of no values.
// Source: Andersson et al. 2020, section 4.3: their pooling by weighted quartiles.
double weighted_percentile_of(std::vector<float> values, double q);

struct MapSummary {
  double mean = 0, median = 0, p95 = 0;
};
MapSummary summarize(const std::vector<float>& values, const PixelMask& mask);

// Peak signal-to-noise ratio of two 8-bit RGB pictures, in decibels: -10 log10 of the mean squared difference of all
// three channels, where 1 is the greatest code.
//
//   a, b  3 codes a pixel, of the same size
// Returns +infinity where the pixels that count are equal, NaN where none does.
double psnr_db(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b, const PixelMask& mask);

}  // namespace shoal
