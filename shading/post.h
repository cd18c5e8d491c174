// From scene-linear light to the 8-bit picture: exposure, tone curve, sRGB.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "core/math.h"
#include "core/vec_lanes.h"
#include "shading/srgb.h"

namespace shoal {

enum class ToneCurve : std::uint8_t {
  kNone,  // clipped to [0, 1]
  kAces,
};

struct PostSettings {
  float exposure_stops = 0;
  ToneCurve tone_curve = ToneCurve::kNone;
};

}  // namespace shoal

namespace shoal::inline SHOAL_ISA_NS {

// Exposure as a factor: 2^stops, exact for whole stops.
SHOAL_INLINE float exposure_scale(const PostSettings& settings) { return det_exp2(settings.exposure_stops); }

// The filmic curve, by channel, from scene-linear to display-linear [0, 1]. Negative values and NaN give 0.
// Source: Narkowicz 2016, "ACES Filmic Tone Mapping Curve": his rational fit of the ACES reference and output
// transforms.
template <class F>
SHOAL_INLINE F tone_aces(F x) {
  // Beyond 2^32 the curve is flat at 1 and its square must not overflow.
  const F c = min(max(x, F(0.0f)), F(0x1p32f));
  const F up = c * (F(2.51f) * c + F(0.03f));
  const F down = c * (F(2.43f) * c + F(0.59f)) + F(0.14f);
  return min(up / down, F(1.0f));
}

// Exposure and tone curve.
//   color  linear radiance
//   scale  exposure_scale(settings), once a frame
// Returns display-linear light; the curve kNone leaves clipping to the encoder.
template <class F>
SHOAL_INLINE Vec3<F> tone_map(Vec3<F> color, const PostSettings& settings, float scale) {
  const Vec3<F> exposed = color * F(scale);
  if (settings.tone_curve == ToneCurve::kNone) return exposed;
  return {tone_aces(exposed.x), tone_aces(exposed.y), tone_aces(exposed.z)};
}

namespace post_detail {
SHOAL_INLINE float encode_scale(std::int32_t exponent) { return kSrgbEncodeScale.at[exponent & 15]; }
SHOAL_INLINE WideF encode_scale(WideI exponent) { return permute(WideF::load(kSrgbEncodeScale.at), exponent); }
SHOAL_INLINE float threshold(std::int32_t code) { return kSrgb8Threshold.at[code]; }
SHOAL_INLINE WideF threshold(WideI code) { return gather(kSrgb8Threshold.at, code); }
}  // namespace post_detail

// The sRGB byte of linear light: floor(255 * srgb(x) + 0.5) exactly, x clipped to [0, 1], NaN as 0.
//
// A polynomial gives 255 * srgb(x) + 0.5 within 5e-4; where that is nearer than kDoubt to a whole number, the exact
// threshold of the code decides. With x = m 2^e, x^(5/12) is m^(5/12), a minimax fit of our own, times a table's entry.
// Source: IEC 61966-2-1:1999. Error: none: the code of every float in [0, 1] is that of the exact curve
// (tests/shading/test_post.cpp, "every threshold").
template <class F>
SHOAL_INLINE IntOf<F> encode_srgb8(F linear) {
  using I = IntOf<F>;
  constexpr float kDoubt = 1e-3f;
  const F x = min(max(linear, F(0.0f)), F(1.0f));
  const I bits = as_int(x);
  const F t = as_float((bits & I(0x007FFFFF)) | I(0x3F800000)) - F(1.0f);
  F root = F(0.0053331309f) * t + F(-0.023987675f);
  root = root * t + F(0.057036076f);
  root = root * t + F(-0.12009922f);
  root = root * t + F(0.41655754f);
  root = root * t + F(1.0000014f);
  const F curved = root * post_detail::encode_scale(shift_right_logical(bits, 23));
  const F value = select(x <= F(0.0031308f), x * F(12.92f * 255.0f) + F(0.5f), curved + F(0.5f - 255.0f * 0.055f));

  const I code = to_int_trunc(value);
  const F part = value - to_float(code);
  const MaskOf<F> doubtful = (part < F(kDoubt)) | (part > F(1.0f - kDoubt));
  if (none(doubtful)) return code;
  const I border = min(max(to_int_nearest(value), I(1)), I(255));
  const I exact = border - select(x < post_detail::threshold(border), I(1), I(0));
  return select(doubtful, exact, code);
}

// Writes a 4 x 4 block of codes (0 to 255) as RGB bytes.
//   pixels     of the block's top left pixel; four rows of twelve bytes, row_bytes apart
// For little-endian machines: Shoal supports no others.
SHOAL_INLINE void store_rgb8_block(std::uint8_t* pixels, std::size_t row_bytes, WideI r, WideI g, WideI b) {
  alignas(64) std::int32_t packed[16];
  (r | (g << 8) | (b << 16)).store(packed);
  // Twelve bytes as two words made in registers: an array of smaller ones is read back before it is in memory.
  for (int y = 0; y < 4; ++y, pixels += row_bytes) {
    std::uint32_t p[4];
    std::memcpy(p, packed + 4 * y, sizeof p);
    const std::uint64_t first = p[0] | static_cast<std::uint64_t>(p[1]) << 24 | static_cast<std::uint64_t>(p[2]) << 48;
    const std::uint32_t last = p[2] >> 16 | p[3] << 8;
    std::memcpy(pixels, &first, sizeof first);
    std::memcpy(pixels + sizeof first, &last, sizeof last);
  }
}

}  // namespace shoal::inline SHOAL_ISA_NS
