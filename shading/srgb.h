// The sRGB transfer curve in double precision at compile time, and tables made from it: the linear light of each 8-bit
// texel, and the limits between 8-bit output codes. No libm: x^2.4 = x^2 * (x^2)^(1/5).
//
// Source: IEC 61966-2-1:1999, section 5.2.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace shoal {

// Linear texels are 15-bit integers: 0 is 0, this is 1. The smallest step of sRGB (12.92 * 255 codes a unit) is 9.9 of
// them, so that each of the 256 codes comes back as itself, and differences of two texels fit sixteen bits.
inline constexpr int kTexelOne = 32767;

namespace srgb_detail {
constexpr double fifth_root(double y) {
  double x = 1.0;
  for (int i = 0; i < 64; ++i) x = (4.0 * x + y / (x * x * x * x)) / 5.0;
  return x;
}
}  // namespace srgb_detail

// Encoded [0, 1] to linear [0, 1]; below 0 the linear segment goes on.
constexpr double srgb_to_linear(double encoded) {
  if (encoded <= 0.04045) return encoded / 12.92;
  const double base = (encoded + 0.055) / 1.055;
  return base * base * srgb_detail::fifth_root(base * base);
}

namespace srgb_detail {
// A plain array, so that kernels call no library function to read it.
template <class T, std::size_t kSize>
struct alignas(64) Table {
  T at[kSize] = {};
};

constexpr Table<std::int16_t, 256> make_linear15_from_srgb8() {
  Table<std::int16_t, 256> table;
  for (std::size_t i = 0; i < 256; ++i)
    table.at[i] = static_cast<std::int16_t>(srgb_to_linear(static_cast<double>(i) / 255.0) * kTexelOne + 0.5);
  return table;
}
constexpr Table<float, 257> make_srgb8_thresholds() {
  Table<float, 257> table;
  for (std::size_t k = 1; k < 256; ++k) {
    const double exact = srgb_to_linear((static_cast<double>(k) - 0.5) / 255.0);
    float rounded = static_cast<float>(exact);
    if (static_cast<double>(rounded) < exact) rounded = std::bit_cast<float>(std::bit_cast<std::uint32_t>(rounded) + 1);
    table.at[k] = rounded;
  }
  table.at[0] = -1.0f;
  table.at[256] = 2.0f;
  return table;
}

constexpr Table<float, 16> make_encode_scale() {
  constexpr double kRoot = 1.3348398541700343649;  // 2^(5/12)
  Table<float, 16> table;
  double scale = 255.0 * 1.055;
  for (std::size_t e = 0; e < 10; ++e, scale /= kRoot) table.at[(127 - e) & 15] = static_cast<float>(scale);
  return table;
}
}  // namespace srgb_detail

// The 15-bit linear value nearest to an sRGB byte's.
inline constexpr srgb_detail::Table<std::int16_t, 256> kLinear15FromSrgb8 = srgb_detail::make_linear15_from_srgb8();

// Entry k, 1 to 255: the smallest float whose code floor(255 * srgb(x) + 0.5) is k. Entries 0 and 256 are out of range,
// so that code k is right exactly where at[k] <= x < at[k + 1].
inline constexpr srgb_detail::Table<float, 257> kSrgb8Threshold = srgb_detail::make_srgb8_thresholds();

// 255 * 1.055 * 2^(5/12 e) for the exponents e = -9 to 0, at the low four bits of the biased exponent.
inline constexpr srgb_detail::Table<float, 16> kSrgbEncodeScale = srgb_detail::make_encode_scale();

}  // namespace shoal
