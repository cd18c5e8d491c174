// Sampling a texture: level of detail, wrapping, filtering. One texture and one sampler for all lanes of a call.
//
// Texel coordinates and weights are fixed-point, 15 bits of fraction, from one multiplication; filtering is integer for
// the 8-bit formats (shading/textures/texel_filter.h) and float for float textures. A lane's result never depends on
// the other lanes.
#pragma once

#include "core/vec_lanes.h"
#include "shading/textures/footprint.h"
#include "shading/textures/texel_filter.h"
#include "shading/textures/texture.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace sample_detail {

inline constexpr int kFractionBits = 15;
inline constexpr std::int32_t kOne = 1 << kFractionBits;
inline constexpr std::int32_t kHalf = kOne / 2;

SHOAL_INLINE std::int32_t entry(const std::int32_t* table, std::int32_t i) { return table[i & 15]; }
SHOAL_INLINE WideI entry(const std::int32_t* table, WideI i) { return permute(WideI::load(table), i); }

// A level of detail: whole and fraction in units of 2^-15, below kOne.
template <class F>
struct Lod {
  IntOf<F> level, fraction;
};

// log2(x) / 2, fraction truncated. x: finite, normal, at least 1. The exponent gives the whole number at once, so that
// addresses need not wait for the polynomial. With t = mantissa - 1, log2(1 + t) = t + t (1 - t) q(t): powers of two
// are exact. The minimax q is our own fit. Error: 6e-5 + 2^-15 (test_texture.cpp, "level of detail").
template <class F>
SHOAL_INLINE Lod<F> half_log2(F x) {
  using I = IntOf<F>;
  const I bits = as_int(x);
  const I exponent = shift_right_logical(bits, 23) - I(127);
  const F t = as_float((bits & I(0x007FFFFF)) | I(0x3F800000)) - F(1.0f);
  const F q = (F(0.08213072f) * t + F(-0.23905827f)) * t + F(0.43872575f);
  const F part = t + t * (F(1.0f) - t) * q;
  const I fixed = min(to_int_trunc(part * F(static_cast<float>(kOne))), I(kOne - 1));
  const I odd = (exponent & I(1)) << kFractionBits;
  return {exponent >> 1, shift_right_logical(odd + fixed, 1)};
}

// A texture coordinate folded into [0, 1): one period for repeat, the mirrored half period, or the clamped value. Exact
// but for the last bit. NaN and, where the mode has no limit there, infinity give 0.
template <class F>
SHOAL_INLINE F fold(F u, Wrap wrap) {
  constexpr float kBelowOne = 0x1.fffffep-1f;
  F folded = u;
  if (wrap == Wrap::kRepeat) {
    folded = u - floor(u);
  } else if (wrap == Wrap::kMirror) {
    const F half = u * F(0.5f);
    const F period = half - floor(half);
    folded = F(1.0f) - abs(F(1.0f) - (period + period));
  }
  return min(max(folded, F(0.0f)), F(kBelowOne));
}

// The first of the two texels along one axis and the second one's weight.
template <class F>
struct AxisTap {
  IntOf<F> texel, weight;
};

//   folded       [0, 1)
//   size         texels
//   half         kHalf where the filter is linear, 0 where it is nearest
//   weight_mask  kOne - 1 where linear, 0 where nearest
template <class F>
SHOAL_INLINE AxisTap<F> axis_tap(F folded, IntOf<F> size, Wrap wrap, IntOf<F> half, IntOf<F> weight_mask) {
  using I = IntOf<F>;
  // folded < 1 keeps the product below size * kOne after rounding too: no texel past the end.
  I x = to_int_trunc(folded * to_float(size << kFractionBits)) - half;
  if (wrap == Wrap::kRepeat) {
    const I texel = x >> kFractionBits;
    return {select(texel < I(0), texel + size, texel), x & weight_mask};
  }
  // Beyond the outer texel centres both neighbours are the edge texel: stop at the centre. A mirrored coordinate too.
  x = min(max(x, I(0)), (size - I(1)) << kFractionBits);
  return {x >> kFractionBits, x & weight_mask};
}

// The part of a sample that all levels share.
template <class F>
struct Footprint {
  Vec2<F> folded;
  IntOf<F> half, weight_mask;  // see axis_tap
};

// Where the four texels of a bilinear tap are, and their weights.
template <class F>
struct Tap {
  IntOf<F> index;  // texel number of the upper left one, from the level's first
  IntOf<F> wx, wy;
};
template <class F>
SHOAL_INLINE Tap<F> make_tap(const Sampler& sampler, const Footprint<F>& at, IntOf<F> width, IntOf<F> height) {
  const AxisTap<F> x = axis_tap(at.folded.x, width, sampler.wrap_u, at.half, at.weight_mask);
  const AxisTap<F> y = axis_tap(at.folded.y, height, sampler.wrap_v, at.half, at.weight_mask);
  return {y.texel * (width + IntOf<F>(1)) + x.texel, x.weight, y.weight};
}

// One level of an 8-bit texture: the same for all lanes, as it mostly is in a block of pixels, or one a lane.
template <class F>
SHOAL_INLINE auto sample_one_level(const Texture& texture, const Sampler& sampler, const Footprint<F>& at,
                                   std::int32_t level) {
  const std::int32_t width = texture.width[level];
  const Tap<F> tap = make_tap<F>(sampler, at, IntOf<F>(width), IntOf<F>(texture.height[level]));
  return bilinear_texels(texture.rgba15.data() + texture.first_texel[level], width + 1, tap.index, tap.wx, tap.wy);
}
SHOAL_INLINE WideTexel sample_any_level(const Texture& texture, const Sampler& sampler, const Footprint<WideF>& at,
                                        WideI level) {
  const WideI width = entry(texture.width, level), height = entry(texture.height, level);
  const Tap<WideF> tap = make_tap<WideF>(sampler, at, width, height);
  const WideI index = entry(texture.first_texel, level) + tap.index;
  return bilinear_texels(texture.rgba15.data(), width + WideI(1), index, tap.wx, tap.wy);
}

SHOAL_INLINE std::int32_t first_lane(std::int32_t v) { return v; }
SHOAL_INLINE std::int32_t first_lane(WideI v) { return extract(v, 0); }

// Float textures: the same taps, weights as floats; a rare format, so four gathers a texel will do.
SHOAL_INLINE float fetch(const float* base, std::int32_t i) { return base[i]; }
SHOAL_INLINE WideF fetch(const float* base, WideI i) { return gather(base, i); }
template <class F>
SHOAL_INLINE F bilinear_channel(const float* base, IntOf<F> top, IntOf<F> bottom, F wx, F wy) {
  const F a = fetch(base, top), b = fetch(base + 4, top);
  const F c = fetch(base, bottom), d = fetch(base + 4, bottom);
  const F left = a + (c - a) * wy, right = b + (d - b) * wy;
  return left + (right - left) * wx;
}
template <class F>
SHOAL_INLINE Vec4<F> bilinear_float(const Texture& texture, const Sampler& sampler, const Footprint<F>& at,
                                    IntOf<F> level) {
  const IntOf<F> width = entry(texture.width, level), height = entry(texture.height, level);
  const Tap<F> tap = make_tap<F>(sampler, at, width, height);
  const IntOf<F> top = (entry(texture.first_texel, level) + tap.index) << 2;
  const IntOf<F> bottom = top + ((width + IntOf<F>(1)) << 2);
  const F scale(1.0f / static_cast<float>(kOne));
  const F wx = to_float(tap.wx) * scale, wy = to_float(tap.wy) * scale;
  const float* base = texture.rgba32f.data();
  return {bilinear_channel<F>(base, top, bottom, wx, wy), bilinear_channel<F>(base + 1, top, bottom, wx, wy),
          bilinear_channel<F>(base + 2, top, bottom, wx, wy), bilinear_channel<F>(base + 3, top, bottom, wx, wy)};
}

}  // namespace sample_detail

// The level of detail of one pixel, before clamping to the levels that there are.
//   duv_dx, duv_dy  the change of uv over one pixel
// Returns log2 of the longer of the two in texels of level 0: whole level and fraction in units of 2^-15, from 0
// (magnified, or not a number) to 14.
// Source: Vulkan 1.3, 16.5.7 (scale factor rho_max, no anisotropy). Error: 1e-4 levels (test_texture.cpp).
template <class F>
SHOAL_INLINE sample_detail::Lod<F> level_of_detail(const Texture& texture, Vec2<F> duv_dx, Vec2<F> duv_dy) {
  const F width(static_cast<float>(texture.width[0])), height(static_cast<float>(texture.height[0]));
  const F ux = duv_dx.x * width, vx = duv_dx.y * height, uy = duv_dy.x * width, vy = duv_dy.y * height;
  const F x2 = ux * ux + vx * vx, y2 = uy * uy + vy * vy;
  // max(a, 1) is 1 where a is NaN.
  const F rho2 = min(max(max(x2, F(1.0f)), max(y2, F(1.0f))), F(0x1p28f));
  return sample_detail::half_log2<F>(rho2);
}

namespace sample_detail {

// Which levels a pixel is read from, and how they are filtered: see Lod and axis_tap.
template <class F>
struct Levels {
  IntOf<F> level, fraction;  // of magnified lanes 0
  IntOf<F> half, weight_mask;
};

//   lod_of  returns the Lod; not called where it makes no difference
template <class F, class LodOf>
SHOAL_INLINE Levels<F> choose_levels(const Texture& texture, const Sampler& sampler, LodOf lod_of) {
  using I = IntOf<F>;
  const auto filter_half = [](Filter f) { return f == Filter::kLinear ? kHalf : 0; };
  Levels<F> r{I(0), I(0), I(filter_half(sampler.magnify)), I(0)};
  if (texture.level_count > 1 || sampler.magnify != sampler.minify) {
    const Lod<F> lod = lod_of();
    const MaskOf<F> minified = (lod.level | lod.fraction) > I(0);
    if (sampler.magnify != sampler.minify) r.half = select(minified, I(filter_half(sampler.minify)), r.half);
    const I last(texture.level_count - 1);
    if (sampler.mip == MipFilter::kLinear) {
      r.level = min(lod.level, last);
      r.fraction = select(lod.level < last, lod.fraction, I(0));
    } else if (sampler.mip == MipFilter::kNearest) {
      r.level = min(lod.level + shift_right_logical(lod.fraction, kFractionBits - 1), last);
    }
  }
  r.weight_mask = (r.half << 1) - select(r.half > I(0), I(1), I(0));
  return r;
}

// One tap a level: uv as in `sample`.
template <class F>
SHOAL_INLINE Vec4<F> sample_levels(const Texture& texture, const Sampler& sampler, Vec2<F> uv, const Levels<F>& levels,
                                   MaskOf<F> active) {
  using I = IntOf<F>;
  const Footprint<F> at{{fold(uv.x, sampler.wrap_u), fold(uv.y, sampler.wrap_v)}, levels.half, levels.weight_mask};
  const I level = levels.level, fraction = levels.fraction;
  const bool two_levels = any((fraction != I(0)) & active);
  if (texture.format == TexelFormat::kRgba32Float) {
    const Vec4<F> a = bilinear_float<F>(texture, sampler, at, level);
    if (!two_levels) return a;
    const Vec4<F> b = bilinear_float<F>(texture, sampler, at, level + I(1));
    const F t = to_float(fraction) * F(1.0f / static_cast<float>(kOne));
    return {a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.z + (b.z - a.z) * t, a.w + (b.w - a.w) * t};
  }
  const std::int32_t one_level = first_lane(level);
  if constexpr (LanesOf<F>::kCount > 1) {
    if (!all(level == I(one_level))) {
      const WideTexel a = sample_any_level(texture, sampler, at, level);
      return texels_to_float(lerp_texels(a, sample_any_level(texture, sampler, at, level + I(1)), fraction));
    }
  }
  const auto a = sample_one_level<F>(texture, sampler, at, one_level);
  if (!two_levels) return texels_to_float(a);
  return texels_to_float(lerp_texels(a, sample_one_level<F>(texture, sampler, at, one_level + 1), fraction));
}

// The mean of a pixel's probes (shading/textures/footprint.h). It is a running mean: exact where all texels are equal,
// and never out of their range.
template <class F>
__attribute__((noinline)) void sample_anisotropic(const Texture& texture, const Sampler& sampler, const Vec2<F>& uv,
                                                  const Vec2<F>& duv_dx, const Vec2<F>& duv_dy, const MaskOf<F>& active,
                                                  Vec4<F>& mean) {
  const Probes<F> probes = footprint_probes<F>(texture, duv_dx, duv_dy, sampler.anisotropy);
  const Levels<F> levels = choose_levels<F>(texture, sampler, [&]() SHOAL_LAMBDA { return half_log2<F>(probes.rho2); });
  const F half(0.5f), part = F(1.0f) / to_float(probes.count), last = to_float(probes.count) - F(1.0f);
  // Lanes that have had their last probe read it again, from cache, and keep their mean.
  const auto probe = [&](F i) SHOAL_LAMBDA {
    const F along = (min(i, last) + half) * part - half;
    return sample_levels<F>(texture, sampler, uv + probes.axis_uv * along, levels, active);
  };
  mean = probe(F(0.0f));
  for (std::int32_t i = 1; any((probes.count > IntOf<F>(i)) & active); ++i) {
    const MaskOf<F> more = probes.count > IntOf<F>(i);
    const Vec4<F> texel = probe(F(static_cast<float>(i)));
    const F weight = select(more, F(1.0f / static_cast<float>(i + 1)), F(0.0f));
    mean = {mean.x + (texel.x - mean.x) * weight, mean.y + (texel.y - mean.y) * weight,
            mean.z + (texel.z - mean.z) * weight, mean.w + (texel.w - mean.w) * weight};
  }
}

}  // namespace sample_detail

// Samples `texture` at `uv`: linear light, alpha as stored.
//   uv              any value; (0, 0) is the corner of the first texel, v goes down the rows
//   duv_dx, duv_dy  derivatives of uv over one pixel
//   active          lanes that are set; the others too read only valid texels, and return finite values
// Returns R, G, B, A, in [0, 1] for the 8-bit formats. uv that is NaN or infinite is taken as some valid texel.
// Source: Vulkan 1.3, 16.5 to 16.9 (image operations). Differs: nearest mip is floor(lod + 1/2); weights have 15 bits;
// anisotropy: shading/textures/footprint.h.
// Error: against double precision on the stored texels 4 / 32767, plus the rounding of uv: 2^-24 of the texture's size
// in texels, times the difference of neighbours (test_texture.cpp, "filtering"); the mean of probes 1e-6 more.
template <class F>
SHOAL_INLINE Vec4<F> sample(const Texture& texture, const Sampler& sampler, Vec2<F> uv, Vec2<F> duv_dx, Vec2<F> duv_dy,
                            MaskOf<F> active) {
  using namespace sample_detail;
  if (sampler.anisotropy > 1) {
    Vec4<F> mean;
    sample_anisotropic<F>(texture, sampler, uv, duv_dx, duv_dy, active, mean);
    return mean;
  }
  const Levels<F> levels =
      choose_levels<F>(texture, sampler, [&]() SHOAL_LAMBDA { return level_of_detail<F>(texture, duv_dx, duv_dy); });
  return sample_levels<F>(texture, sampler, uv, levels, active);
}

}  // namespace shoal::inline SHOAL_ISA_NS
