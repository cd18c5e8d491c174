// Bilinear and mip filtering of 15-bit RGBA texels by 16-bit integers, one pixel (int32) or sixteen (WideI) at a time.
//
// One step is lerp(a, b, w) = a + ((b - a) * w + 2^14 >> 15): texels 0 to 32767, weight w 0 to 32767 of 32768. It is
// exact where a = b or w = 0, never leaves [a, b], and is one instruction for the product on every machine (x86
// pmulhrsw, NEON sqrdmulh; core/wide/lanes16.h). Error: a filtered value is within 3.5 / 32767 of exact weights on
// exact texels for three steps (half a unit of storage, half a unit each step, and up to one weight unit, 2^-15 of the
// difference, where weights are truncated; pinned by tests/shading/test_texture.cpp).
#pragma once

#include <bit>
#include <cstdint>

#include "core/vec.h"
#include "core/wide/lanes.h"
#include "core/wide/lanes16.h"
#include "shading/srgb.h"

namespace shoal::inline SHOAL_ISA_NS {

// --- One pixel ---

struct Texel {
  std::int32_t channel[4];
};

namespace texel_detail {
SHOAL_INLINE std::int32_t lerp15(std::int32_t a, std::int32_t b, std::int32_t w) {
  return a + (((b - a) * w + 0x4000) >> 15);
}
SHOAL_INLINE std::int32_t channel15(std::uint64_t texel, int c) {
  return static_cast<std::int32_t>((texel >> (16 * c)) & 0xFFFFu);
}
}  // namespace texel_detail

SHOAL_INLINE Texel lerp_texels(const Texel& a, const Texel& b, std::int32_t w) {
  Texel r;
  for (int c = 0; c < 4; ++c) r.channel[c] = texel_detail::lerp15(a.channel[c], b.channel[c], w);
  return r;
}
SHOAL_INLINE Texel bilinear_texels(const std::uint64_t* texels, std::int32_t stride, std::int32_t index,
                                   std::int32_t wx, std::int32_t wy) {
  using namespace texel_detail;
  const std::uint64_t* top = texels + index;
  const std::uint64_t* bottom = top + stride;
  Texel left, right;
  for (int c = 0; c < 4; ++c) {
    left.channel[c] = lerp15(channel15(top[0], c), channel15(bottom[0], c), wy);
    right.channel[c] = lerp15(channel15(top[1], c), channel15(bottom[1], c), wy);
  }
  return lerp_texels(left, right, wx);
}
SHOAL_INLINE Vec4<float> texels_to_float(const Texel& t) {
  constexpr float kScale = 1.0f / kTexelOne;
  return {static_cast<float>(t.channel[0]) * kScale, static_cast<float>(t.channel[1]) * kScale,
          static_cast<float>(t.channel[2]) * kScale, static_cast<float>(t.channel[3]) * kScale};
}

// --- Sixteen pixels ---
//
// A register holds lanes of 128 bits, each two texels. 128-bit lane k of all lanes together serves pixels 4k to 4k + 3,
// and nothing ever crosses lanes, so the algorithm is one for every register size.
namespace texel_detail {

using namespace lanes16;

inline constexpr int kRegs = 64 / static_cast<int>(sizeof(Reg));  // registers that hold sixteen int32s
struct Words {
  Reg reg[kRegs];
};

SHOAL_INLINE Reg lerp15(Reg a, Reg b, Reg w) { return add16(a, mulhrs16(sub16(b, a), w)); }
// A weight a pixel, twice in its 32 bits.
SHOAL_INLINE Words twice(WideI w) { return std::bit_cast<Words>(w | (w << 16)); }

// Words of one 128-bit lane, as in pshufd: all of pixel k, or pixels 0 0 1 1, or 2 2 3 3.
template <int k>
inline constexpr int kAllOf = k * 0x55;
inline constexpr int kFirstTwo = 0x50, kLastTwo = 0xFA;

}  // namespace texel_detail

// Sixteen texels: of a 128-bit lane's four pixels, 0 and 1 in pair 0, 2 and 3 in pair 1.
struct WideTexel {
  texel_detail::Reg pair[texel_detail::kRegs][2];
};

//   w  0 to 32767
SHOAL_INLINE WideTexel lerp_texels(const WideTexel& a, const WideTexel& b, WideI w) {
  using namespace texel_detail;
  const Words weight = twice(w);
  WideTexel r;
  for (int k = 0; k < kRegs; ++k) {
    r.pair[k][0] = lerp15(a.pair[k][0], b.pair[k][0], words<kFirstTwo>(weight.reg[k]));
    r.pair[k][1] = lerp15(a.pair[k][1], b.pair[k][1], words<kLastTwo>(weight.reg[k]));
  }
  return r;
}

namespace texel_detail {
// Else GCC takes each index out of the register that was stored, which costs several times as much.
SHOAL_INLINE void read_from_memory(std::int32_t (&index)[16]) { asm("" : "+m"(index)); }

// Lane i's upper pair is at top + i-th of `at`, its lower pair at bottom + i-th of `at_bottom`.
SHOAL_INLINE WideTexel bilinear(const std::uint64_t* top, const std::int32_t* at, const std::uint64_t* bottom,
                                const std::int32_t* at_bottom, WideI wx, WideI wy) {
  const Words across = twice(wx), down = twice(wy);
  WideTexel r;
  for (int k = 0; k < kRegs; ++k) {
    const std::int32_t* i = at + k * (16 / kRegs);
    const std::int32_t* j = at_bottom + k * (16 / kRegs);
    const Reg v0 = lerp15(load_pairs(top, i), load_pairs(bottom, j), words<kAllOf<0>>(down.reg[k]));
    const Reg v1 = lerp15(load_pairs(top, i + 1), load_pairs(bottom, j + 1), words<kAllOf<1>>(down.reg[k]));
    const Reg v2 = lerp15(load_pairs(top, i + 2), load_pairs(bottom, j + 2), words<kAllOf<2>>(down.reg[k]));
    const Reg v3 = lerp15(load_pairs(top, i + 3), load_pairs(bottom, j + 3), words<kAllOf<3>>(down.reg[k]));
    r.pair[k][0] = lerp15(low64(v0, v1), high64(v0, v1), words<kFirstTwo>(across.reg[k]));
    r.pair[k][1] = lerp15(low64(v2, v3), high64(v2, v3), words<kLastTwo>(across.reg[k]));
  }
  return r;
}
}  // namespace texel_detail

// The four texels texels[index], [index + 1], [index + stride] and [index + stride + 1] of every lane, filtered: first
// down, then across. One stride for all lanes, or one a lane.
//   wx, wy  0 to 32767: weight of the right and of the lower texels
SHOAL_INLINE WideTexel bilinear_texels(const std::uint64_t* texels, std::int32_t stride, WideI index, WideI wx,
                                       WideI wy) {
  alignas(64) std::int32_t at[16];
  index.store(at);
  texel_detail::read_from_memory(at);
  return texel_detail::bilinear(texels, at, texels + stride, at, wx, wy);
}
SHOAL_INLINE WideTexel bilinear_texels(const std::uint64_t* texels, WideI stride, WideI index, WideI wx, WideI wy) {
  alignas(64) std::int32_t at[16], at_bottom[16];
  index.store(at);
  (index + stride).store(at_bottom);
  texel_detail::read_from_memory(at), texel_detail::read_from_memory(at_bottom);
  return texel_detail::bilinear(texels, at, texels, at_bottom, wx, wy);
}

// To linear floats, 1 for kTexelOne.
SHOAL_INLINE Vec4<WideF> texels_to_float(const WideTexel& t) {
  using namespace texel_detail;
  Words r, g, b, a;
  for (int k = 0; k < kRegs; ++k) {
    const Reg even_odd_low = low16(t.pair[k][0], t.pair[k][1]);    // R0 R2 G0 G2 B0 B2 A0 A2
    const Reg even_odd_high = high16(t.pair[k][0], t.pair[k][1]);  // R1 R3 G1 G3 B1 B3 A1 A3
    const Reg rg = low16(even_odd_low, even_odd_high);             // R0 R1 R2 R3 G0 G1 G2 G3
    const Reg ba = high16(even_odd_low, even_odd_high);
    r.reg[k] = low16(rg, zero());
    g.reg[k] = high16(rg, zero());
    b.reg[k] = low16(ba, zero());
    a.reg[k] = high16(ba, zero());
  }
  const WideF scale(1.0f / kTexelOne);
  return {to_float(std::bit_cast<WideI>(r)) * scale, to_float(std::bit_cast<WideI>(g)) * scale,
          to_float(std::bit_cast<WideI>(b)) * scale, to_float(std::bit_cast<WideI>(a)) * scale};
}

}  // namespace shoal::inline SHOAL_ISA_NS
