// NEON (AArch64): four registers of four lanes, vector masks.
#pragma once

#include <arm_neon.h>

#include <bit>

#include "core/wide/compress_table.h"

namespace shoal::inline SHOAL_ISA_NS::wide_detail {
using VF = float32x4_t;
using VI = int32x4_t;
using VU = uint32x4_t;
inline constexpr int kParts = 4;
}  // namespace shoal::inline SHOAL_ISA_NS::wide_detail

#include "core/wide/native_vector_mask.h"

namespace shoal::inline SHOAL_ISA_NS::wide_detail {

SHOAL_INLINE VF f_set1(float s) { return vdupq_n_f32(s); }
SHOAL_INLINE VI i_set1(std::int32_t s) { return vdupq_n_s32(s); }
SHOAL_INLINE VF f_load(const float* p) { return vld1q_f32(p); }
SHOAL_INLINE VI i_load(const std::int32_t* p) { return vld1q_s32(p); }
SHOAL_INLINE void f_store(float* p, VF v) { vst1q_f32(p, v); }
SHOAL_INLINE void i_store(std::int32_t* p, VI v) { vst1q_s32(p, v); }

SHOAL_INLINE std::uint32_t m_bits(VM a) {
  const VU lane_bit = {1, 2, 4, 8};
  return vaddvq_u32((VU)a & lane_bit);
}
SHOAL_INLINE VM m_from_bits(std::uint32_t bits) {
  const VI lane_bit = {1, 2, 4, 8};
  return (i_set1(static_cast<std::int32_t>(bits)) & lane_bit) == lane_bit;
}
SHOAL_INLINE VF f_select(VM m, VF a, VF b) { return vbslq_f32((VU)m, a, b); }
SHOAL_INLINE VI i_select(VM m, VI a, VI b) { return vbslq_s32((VU)m, a, b); }
// Not vminq and vmaxq: those differ on NaN and on zeros of either sign.
SHOAL_INLINE VF f_min(VF a, VF b) { return vbslq_f32(vcltq_f32(a, b), a, b); }
SHOAL_INLINE VF f_max(VF a, VF b) { return vbslq_f32(vcgtq_f32(a, b), a, b); }
SHOAL_INLINE VI i_min(VI a, VI b) { return vminq_s32(a, b); }
SHOAL_INLINE VI i_max(VI a, VI b) { return vmaxq_s32(a, b); }
SHOAL_INLINE VF f_sqrt(VF a) { return vsqrtq_f32(a); }
SHOAL_INLINE VF f_floor(VF a) { return vrndmq_f32(a); }
SHOAL_INLINE VF f_from_i(VI a) { return vcvtq_f32_s32(a); }
SHOAL_INLINE VI i_trunc(VF a) { return vcvtq_s32_f32(a); }
SHOAL_INLINE VI i_nearest(VF a) { return vcvtnq_s32_f32(a); }
SHOAL_INLINE VI i_shl(VI a, VI n) { return vshlq_s32(a, n); }
SHOAL_INLINE VI i_shr(VI a, VI n) { return (VI)vshlq_u32((VU)a, vnegq_s32(n)); }

// All sixteen lanes are one 64-byte table; lane index k is bytes 4k..4k+3.
SHOAL_INLINE void f_permute(const VF* v, const VI* index, VF* out) {
  const uint8x16x4_t table = {{(uint8x16_t)v[0], (uint8x16_t)v[1], (uint8x16_t)v[2], (uint8x16_t)v[3]}};
  const VI low = i_set1(15), spread = i_set1(0x04040404), byte = i_set1(0x03020100);
  const VI i0 = (index[0] & low) * spread + byte, i1 = (index[1] & low) * spread + byte;
  const VI i2 = (index[2] & low) * spread + byte, i3 = (index[3] & low) * spread + byte;
  out[0] = (VF)vqtbl4q_u8(table, (uint8x16_t)i0);
  out[1] = (VF)vqtbl4q_u8(table, (uint8x16_t)i1);
  out[2] = (VF)vqtbl4q_u8(table, (uint8x16_t)i2);
  out[3] = (VF)vqtbl4q_u8(table, (uint8x16_t)i3);
}
SHOAL_INLINE void compress_four(std::int32_t* out, VI v, std::uint32_t bits) {
  vst1q_s32(out, (VI)vqtbl1q_u8((uint8x16_t)v, vld1q_u8(kCompressTable.byte[bits])));
}
// Four lanes at a time, each group stored where the one before ended; what follows the last is zero.
SHOAL_INLINE void i_compress(const VI* v, const VM* m, VI* out) {
  Lanes lanes = {};
  const std::uint32_t b0 = m_bits(m[0]), b1 = m_bits(m[1]), b2 = m_bits(m[2]), b3 = m_bits(m[3]);
  const std::uint32_t bits = b0 | b1 << 4 | b2 << 8;
  compress_four(lanes.at, v[0], b0);
  compress_four(lanes.at + std::popcount(b0), v[1], b1);
  compress_four(lanes.at + std::popcount(bits & 0xFFu), v[2], b2);
  compress_four(lanes.at + std::popcount(bits), v[3], b3);
  from_lanes(lanes, out);
}
SHOAL_INLINE VI i_gather(const std::int32_t* base, VI i) { return VI{base[i[0]], base[i[1]], base[i[2]], base[i[3]]}; }
SHOAL_INLINE VI i_gather(const std::int32_t* base, VI i, VM m, VI other) {
  return VI{m[0] ? base[i[0]] : other[0], m[1] ? base[i[1]] : other[1], m[2] ? base[i[2]] : other[2],
            m[3] ? base[i[3]] : other[3]};
}
SHOAL_INLINE VF f_gather(const float* base, VI i) { return VF{base[i[0]], base[i[1]], base[i[2]], base[i[3]]}; }
SHOAL_INLINE VF f_gather(const float* base, VI i, VM m, VF other) {
  return VF{m[0] ? base[i[0]] : other[0], m[1] ? base[i[1]] : other[1], m[2] ? base[i[2]] : other[2],
            m[3] ? base[i[3]] : other[3]};
}
SHOAL_INLINE void i_load_pairs(const std::uint32_t* base, const std::int32_t* index, VI& first, VI& second) {
  const VI low = vcombine_s32((int32x2_t)vld1_u32(base + index[0]), (int32x2_t)vld1_u32(base + index[1]));
  const VI high = vcombine_s32((int32x2_t)vld1_u32(base + index[2]), (int32x2_t)vld1_u32(base + index[3]));
  first = vuzp1q_s32(low, high);
  second = vuzp2q_s32(low, high);
}
SHOAL_INLINE VI i_load_u8(const std::uint8_t* p) {
  std::uint32_t four;
  std::memcpy(&four, p, 4);
  return (VI)vmovl_u16(vget_low_u16(vmovl_u8(vcreate_u8(four))));
}
SHOAL_INLINE void i_store_u8(std::uint8_t* p, const VI* v) {
  const uint16x8_t low = vcombine_u16(vqmovun_s32(v[0]), vqmovun_s32(v[1]));
  const uint16x8_t high = vcombine_u16(vqmovun_s32(v[2]), vqmovun_s32(v[3]));
  vst1q_u8(p, vcombine_u8(vqmovn_u16(low), vqmovn_u16(high)));
}
// Lanes 0..7 with 8..15, then 0..3 with 4..7, then 0, 1 with 2, 3, then 0 with 1: the fixed tree.
SHOAL_INLINE float f_reduce_min(const VF* v) {
  const VF four = f_min(f_min(v[0], v[2]), f_min(v[1], v[3]));
  const VF two = f_min(four, vextq_f32(four, four, 2));
  return two[0] < two[1] ? two[0] : two[1];
}
SHOAL_INLINE float f_reduce_max(const VF* v) {
  const VF four = f_max(f_max(v[0], v[2]), f_max(v[1], v[3]));
  const VF two = f_max(four, vextq_f32(four, four, 2));
  return two[0] > two[1] ? two[0] : two[1];
}
SHOAL_INLINE std::int32_t i_reduce_min(const VI* v) { return vminvq_s32(i_min(i_min(v[0], v[2]), i_min(v[1], v[3]))); }
SHOAL_INLINE std::int32_t i_reduce_max(const VI* v) { return vmaxvq_s32(i_max(i_max(v[0], v[2]), i_max(v[1], v[3]))); }

}  // namespace shoal::inline SHOAL_ISA_NS::wide_detail
