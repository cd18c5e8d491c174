#include "water/fft.h"

#include <utility>

#include "core/math.h"

namespace shoal {
namespace {

// One transform of `side` values, `stride` apart. roots[k] = exp(2 pi i k / side).
void transform(Complex* v, std::size_t side, std::size_t stride, const std::vector<Complex>& roots) {
  // Bit-reversed order.
  for (std::size_t i = 1, j = 0; i < side; ++i) {
    std::size_t bit = side / 2;
    for (; (j & bit) != 0; bit /= 2) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(v[i * stride], v[j * stride]);
  }
  // Butterflies.
  for (std::size_t half = 1; half < side; half *= 2) {
    for (std::size_t start = 0; start < side; start += 2 * half) {
      for (std::size_t k = 0; k < half; ++k) {
        const Complex w = roots[k * (side / (2 * half))];
        Complex& a = v[(start + k) * stride];
        Complex& b = v[(start + k + half) * stride];
        const Complex t = {b.re * w.re - b.im * w.im, b.re * w.im + b.im * w.re};
        b = {a.re - t.re, a.im - t.im};
        a = {a.re + t.re, a.im + t.im};
      }
    }
  }
}

}  // namespace

void inverse_fft_2d(std::vector<Complex>& values, std::size_t side) {
  std::vector<Complex> roots(side);
  for (std::size_t k = 0; k < side; ++k) {
    det_sincos(6.28318531f * static_cast<float>(k) / static_cast<float>(side), roots[k].im, roots[k].re);
  }
  for (std::size_t i = 0; i < side; ++i) transform(values.data() + i * side, side, 1, roots);
  for (std::size_t i = 0; i < side; ++i) transform(values.data() + i, side, side, roots);
}

}  // namespace shoal
