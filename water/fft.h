// Fourier transform of our own: the same bits everywhere.
#pragma once

#include <cstddef>
#include <vector>

namespace shoal {

// A complex number that is plain data.
struct Complex {
  float re, im;
};

// In place, rows then columns, of a square of side x side values: out(x, y) = sum over (p, q) of
// in(p, q) exp(2 pi i (p x + q y) / side), without a factor.
//   side   a power of two, 2 to 4096
// Source: Cooley and Tukey 1965, radix 2, decimation in time.
// Error: 1e-6 of the root of the sum of squares (tests/water/test_spectrum.cpp).
void inverse_fft_2d(std::vector<Complex>& values, std::size_t side);

}  // namespace shoal
