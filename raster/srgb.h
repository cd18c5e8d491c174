// The sRGB transfer curve in double precision at compile time, and the two tables made from it: what an 8-bit texel is in
// linear light, and where one 8-bit output code ends and the next begins. No libm: x^2.4 = x^2 * (x^2)^(1/5).
//
// Source: IEC 61966-2-1:1999, section 5.2.
#pragma once

#include <array>
#include <bit>
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
constexpr std::array<std::int16_t, 256> make_linear15_from_srgb8() {
  std::array<std::int16_t, 256> table{};
  for (std::size_t i = 0; i < 256; ++i)
    table[i] = static_cast<std::int16_t>(srgb_to_linear(static_cast<double>(i) / 255.0) * kTexelOne + 0.5);
  return table;
}
constexpr std::array<float, 257> make_srgb8_thresholds() {
  std::array<float, 257> table{};
  for (std::size_t k = 1; k < 256; ++k) {
    const double exact = srgb_to_linear((static_cast<double>(k) - 0.5) / 255.0);
    float rounded = static_cast<float>(exact);
    if (static_cast<double>(rounded) < exact) rounded = std::bit_cast<float>(std::bit_cast<std::uint32_t>(rounded) + 1);
    table[k] = rounded;
  }
  table[0] = -1.0f;
  table[256] = 2.0f;
  return table;
}
}  // namespace srgb_detail

// The 15-bit linear value nearest to an sRGB byte's.
inline constexpr std::array<std::int16_t, 256> kLinear15FromSrgb8 = srgb_detail::make_linear15_from_srgb8();

// Entry k, 1 to 255: the smallest float whose code floor(255 * srgb(x) + 0.5) is k. Entries 0 and 256 are out of range,
// so that code k is right exactly where table[k] <= x < table[k + 1].
inline constexpr std::array<float, 257> kSrgb8Threshold = srgb_detail::make_srgb8_thresholds();

}  // namespace shoal
