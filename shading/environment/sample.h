// Sampling an environment: radiance along rays that leave the scene, and light that surfaces reflect.
#pragma once

#include "core/vec_lanes.h"
#include "shading/environment/environment.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace environment_detail {

// Projects a direction to the unfolded octahedron: x and z in [-1, 1]. Any length; the zero vector is +y.
// Source: Meyer et al. 2010, "On floating-point normal vectors" (octahedral parametrisation), about +y.
template <class F>
SHOAL_INLINE Vec2<F> octahedral_of(Vec3<F> d) {
  const F one(1.0f);
  const F inverse = one / max((abs(d.x) + abs(d.y)) + abs(d.z), F(1e-30f));
  const F x = d.x * inverse, z = d.z * inverse;
  const MaskOf<F> lower = d.y < F(0.0f);
  return {select(lower, flip_sign_if(one - abs(z), x < F(0.0f)), x),
          select(lower, flip_sign_if(one - abs(x), z < F(0.0f)), z)};
}

// The inverse: a direction that is not unit.
template <class F>
SHOAL_INLINE Vec3<F> direction_of(Vec2<F> p) {
  const F one(1.0f);
  const F y = (one - abs(p.x)) - abs(p.y);
  const MaskOf<F> lower = y < F(0.0f);
  return {select(lower, flip_sign_if(one - abs(p.y), p.x < F(0.0f)), p.x), y,
          select(lower, flip_sign_if(one - abs(p.x), p.y < F(0.0f)), p.y)};
}

SHOAL_INLINE void load_words(const std::uint32_t* base, std::int32_t i, std::int32_t& first, std::int32_t& second) {
  first = static_cast<std::int32_t>(base[i]);
  second = static_cast<std::int32_t>(base[i + 1]);
}
SHOAL_INLINE void load_words(const std::uint32_t* base, WideI i, WideI& first, WideI& second) {
  load_texel_pairs(base, i, first, second);
}
SHOAL_INLINE std::int32_t entry(const std::int32_t* table, std::int32_t i) { return table[i & 15]; }
SHOAL_INLINE WideI entry(const std::int32_t* table, WideI i) { return permute(WideI::load(table), i); }

// Sixteen bits as a float from 2^-31 (code 0) to 2: the exponent's upper bits are put in front.
inline constexpr std::int32_t kCodeBits = 0x0FFFF000, kCodeExponent = 0x30000000;
inline constexpr float kCodeZero = 0x1p-31f;
template <class F>
SHOAL_INLINE F low_channel(IntOf<F> word) {
  return as_float(((word << 12) & IntOf<F>(kCodeBits)) | IntOf<F>(kCodeExponent));
}
template <class F>
SHOAL_INLINE F high_channel(IntOf<F> word) {
  return as_float((shift_right_logical(word, 4) & IntOf<F>(kCodeBits)) | IntOf<F>(kCodeExponent));
}

template <class F>
SHOAL_INLINE F mix(F a, F b, F t) {
  return a + (b - a) * t;
}

// One row's two texels, mixed.
template <class F>
SHOAL_INLINE Vec3<F> mixed_pair(const std::uint32_t* texels, IntOf<F> word, F t) {
  IntOf<F> rg0, b0, rg1, b1;
  load_words(texels, word, rg0, b0);
  load_words(texels + 2, word, rg1, b1);
  return {mix(low_channel<F>(rg0), low_channel<F>(rg1), t), mix(high_channel<F>(rg0), high_channel<F>(rg1), t),
          mix(low_channel<F>(b0), low_channel<F>(b1), t)};
}

// Bilinear filtering of coded texels.
//   at           octahedral_of a direction
//   size, first  of the level
template <class F>
SHOAL_INLINE Vec3<F> bilinear(const std::uint32_t* texels, Vec2<F> at, IntOf<F> size, IntOf<F> first) {
  using I = IntOf<F>;
  const F half = to_float(size) * F(0.5f);
  // From the centre of the border's first texel; a NaN is there, and nothing is past the last two.
  const F end = to_float(size) + F(0.75f);
  const F x = min(max(at.x * half + (half + F(0.5f)), F(0.0f)), end);
  const F y = min(max(at.y * half + (half + F(0.5f)), F(0.0f)), end);
  const I column = to_int_trunc(x), row = to_int_trunc(y);
  const I stride = size + I(2);
  const I word = (row * stride + column + first) << 1;
  const F tx = x - to_float(column), ty = y - to_float(row);
  const Vec3<F> top = mixed_pair<F>(texels, word, tx), bottom = mixed_pair<F>(texels, word + (stride << 1), tx);
  return {mix(top.x, bottom.x, ty), mix(top.y, bottom.y, ty), mix(top.z, bottom.z, ty)};
}

template <class F>
SHOAL_INLINE Vec3<F> decoded(Vec3<F> code, float scale) {
  const F zero(kCodeZero), unit(scale);
  return {(code.x - zero) * unit, (code.y - zero) * unit, (code.z - zero) * unit};
}

}  // namespace environment_detail

// Radiance of the environment along a direction. Out of line, so that it is not repeated at every call.
//   direction_world  away from the scene, any length; the zero vector is taken for +y
//   out              linear radiance, not negative
// Differs: bilinear at full size always, so a picture that is larger on the map than on the screen aliases (--spp).
template <class F>
__attribute__((noinline)) void environment_radiance(const Environment& e, const Vec3<F>& direction_world,
                                                    Vec3<F>& out) {
  using namespace environment_detail;
  const Vec2<F> at = octahedral_of(direction_world);
  out = decoded(bilinear<F>(e.texels.data(), at, IntOf<F>(e.size[0]), IntOf<F>(0)), e.scale);
}

// The mean of the environment over a GGX lobe round a direction.
//   mirrored   the direction, any length
//   roughness  0 to 1 (clamped)
// Returns linear radiance: the lobe's mean with its axis, the normal and the view in that direction.
// Source: Karis 2013, "Real Shading in Unreal Engine 4" (prefiltered environment map).
// Error: against double, tests/shading/test_environment.cpp ("prefiltered").
template <class F>
SHOAL_INLINE Vec3<F> environment_lobe(const Environment& e, Vec3<F> mirrored, F roughness) {
  using namespace environment_detail;
  using I = IntOf<F>;
  const Vec2<F> at = octahedral_of(mirrored);
  constexpr float kLast = static_cast<float>(kEnvironmentLevels - 1);
  const F place = min(max(roughness * F(kLast), F(0.0f)), F(kLast));
  const I level = min(to_int_trunc(place), I(kEnvironmentLevels - 2));
  const F t = place - to_float(level);
  const std::uint32_t* texels = e.texels.data();
  const Vec3<F> a = bilinear<F>(texels, at, entry(e.size, level), entry(e.first_texel, level));
  const I next = level + I(1);
  const Vec3<F> b = bilinear<F>(texels, at, entry(e.size, next), entry(e.first_texel, next));
  return decoded<F>({mix(a.x, b.x, t), mix(a.y, b.y, t), mix(a.z, b.z, t)}, e.scale);
}

// Irradiance over pi on a surface.
//   n  unit
// Returns at least 0: the nine functions swing below it opposite to a small bright light.
// Source: Ramamoorthi and Hanrahan 2001, "An Efficient Representation for Irradiance Environment Maps", eq. 12.
// Differs: the polar axis is y. Error: that of nine functions: nothing for light of order 0 to 2.
template <class F>
SHOAL_INLINE Vec3<F> environment_irradiance(const Environment& e, Vec3<F> n) {
  const F basis[8] = {
      n.y, n.z, n.x, n.x * n.y, n.y * n.z, F(3.0f) * (n.y * n.y) - F(1.0f), n.x * n.z, n.x * n.x - n.z * n.z};
  Vec3<F> sum = broadcast<F>(e.irradiance[0]);
  for (int i = 0; i < 8; ++i) sum = sum + broadcast<F>(e.irradiance[i + 1]) * basis[i];
  const Vec3<F> zero = broadcast<F>(Vec3f{0, 0, 0});
  return max(sum, zero);
}

// The share of a uniform environment that the lobe reflects: for f0 = 1 (x) and for f0 = 0 (y).
// Error: 0.005 against double from a cosine of 0.1 on, 0.012 from 0.03 on (tests/shading/test_environment.cpp).
template <class F>
SHOAL_INLINE Vec2<F> environment_lobe_share(const Environment& e, F roughness, F n_dot_v) {
  using namespace environment_detail;
  using I = IntOf<F>;
  constexpr float kLast = static_cast<float>(kLobeTableSize - 1);
  const F x = sqrt(min(max(n_dot_v, F(0.0f)), F(1.0f))) * F(kLast);
  const F y = min(max(roughness, F(0.0f)), F(1.0f)) * F(kLast);
  const I column = min(to_int_trunc(x), I(kLobeTableSize - 2)), row = min(to_int_trunc(y), I(kLobeTableSize - 2));
  const F tx = x - to_float(column), ty = y - to_float(row);
  const I at = row * I(kLobeTableSize) + column;
  I word[4];
  load_words(e.lobe.data(), at, word[0], word[1]);
  load_words(e.lobe.data() + kLobeTableSize, at, word[2], word[3]);
  const auto mixed = [&](F a, F b, F c, F d)
                         SHOAL_LAMBDA { return mix(mix(a, b, tx), mix(c, d, tx), ty) * F(1.0f / 65535.0f); };
  const auto low = [](I w) SHOAL_LAMBDA { return to_float(w & I(0xFFFF)); };
  const auto high = [](I w) SHOAL_LAMBDA { return to_float(shift_right_logical(w, 16)); };
  return {mixed(low(word[0]), low(word[1]), low(word[2]), low(word[3])),
          mixed(high(word[0]), high(word[1]), high(word[2]), high(word[3]))};
}

// The part of a shaded point that its environment's light depends on.
template <class F>
struct EnvironmentPoint {
  Vec3<F> diffuse, f0;  // albedo of the Lambert part; reflectance at normal incidence
  Vec3<F> normal, mirrored;
  F roughness, n_dot_v;
};

// Light of the environment towards the viewer: the specular lobe, multiple scattering between its facets, and Lambert
// below.
//   out  linear radiance, without occlusion
// Source: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image Based Lighting", JCGT 8(1),
// listing 1 (without its roughness-dependent Fresnel term). Error: in a uniform environment a white surface, metal or
// not, gives back 1 within 1e-4 at any roughness and angle (tests/shading/test_environment.cpp, "furnace").
template <class F>
__attribute__((noinline)) void reflect_environment(const Environment& e, const EnvironmentPoint<F>& p, Vec3<F>& out) {
  const F one(1.0f);
  const Vec2<F> share = environment_lobe_share<F>(e, p.roughness, p.n_dot_v);
  const Vec3<F> ones{one, one, one};
  const F scale = share.x - share.y;
  const Vec3<F> single = p.f0 * scale + Vec3<F>{share.y, share.y, share.y};
  // The share 1 - share.x goes from facet to facet, and loses all but the mean reflectance each time.
  const F again = one - share.x;
  const Vec3<F> mean = p.f0 + (ones - p.f0) * F(1.0f / 21.0f);
  const Vec3<F> bounces = mean * again;
  const Vec3<F> left = ones - bounces;
  const Vec3<F> many = {single.x * bounces.x / left.x, single.y * bounces.y / left.y, single.z * bounces.z / left.z};
  const Vec3<F> through = max(ones - single - many, broadcast<F>(Vec3f{0, 0, 0}));
  out = single * environment_lobe<F>(e, p.mirrored, p.roughness) +
        (many + p.diffuse * through) * environment_irradiance<F>(e, p.normal);
}

}  // namespace shoal::inline SHOAL_ISA_NS
