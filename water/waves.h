// Waves that are sines: Champandard's ripples, and Gerstner's trochoids as a height field.
#pragma once

#include "core/math.h"
#include "water/surface_data.h"

namespace shoal::inline SHOAL_ISA_NS {

// Height over the plane and its derivatives along the plane's axes.
template <class F>
struct SurfacePoint {
  F height_m, slope_x, slope_z;
};

// Sine and cosine of an angle in turns. Error: 3 ULP of 1 for |turns| < 1; elsewhere the argument's rounding.
template <class F>
SHOAL_INLINE void sincos_turns(F turns, F& sine, F& cosine) {
  const F part = turns - floor(turns + F(0.5f));
  det_sincos(part * F(0x1.921fb6p+2f), sine, cosine);
}

// One ring of waves.
//
// Returns height and gradient; at the source itself the gradient is 0, beyond a linear ripple's reach all is 0.
// Source: Champandard 1999: max_amplitude * distance_fade * time_fade * sin(time_scale), fades within 0..1, linear or
//         exponential. Differs: the phase has the distance in it, or nothing would travel; the linear fade is clamped;
//         the distance is softened by a sixteenth of a wave, so that the tip is round.
// Error: the gradient is that of the height within 2e-6 of the slope bound (tests/water/test_surface.cpp).
template <class F>
SHOAL_INLINE SurfacePoint<F> ripple_at(const RippleSource& s, F x_m, F z_m) {
  const F dx = x_m - F(s.x_m), dz = z_m - F(s.z_m);
  const F r = sqrt((dx * dx + dz * dz) + F(s.soften2_m2));
  F fade, fade_slope;  // by r
  if (s.exponential != 0) {
    fade = det_exp2(r * F(-1.44269504f * s.inverse_reach_per_m));
    fade_slope = fade * F(-s.inverse_reach_per_m);
  } else {
    const F left = F(1.0f) - r * F(s.inverse_reach_per_m);
    fade = max(left, F(0.0f));
    fade_slope = select(left > F(0.0f), F(-s.inverse_reach_per_m), F(0.0f));
  }
  F sine, cosine;
  sincos_turns(r * F(s.turns_per_m) + F(s.phase_turns), sine, cosine);
  const F radial = F(s.amplitude_m) * (fade_slope * sine + fade * (F(6.28318531f * s.turns_per_m) * cosine));
  const F per_r = radial / r;
  return {F(s.amplitude_m) * (fade * sine), per_r * dx, per_r * dz};
}

// Rounds of Newton's method that find the point at rest.
inline constexpr int kTrochoidRounds = 4;

// Trochoids as they are; filter_surface.h fades them instead.
struct WholeWaves {
  template <class F>
  SHOAL_INLINE bool leave_out(const TrochoidWave&) const {
    return false;
  }
  template <class F>
  SHOAL_INLINE F of(const TrochoidWave&, float constant) const {
    return F(constant);
  }
};

// Sum of Gerstner's waves over a point of the plane. They move water sideways too, so the height over (x, z) is that of
// the point at rest p with p - push(p) = (x, z), found by kTrochoidRounds rounds from p = (x, z).
//
//   waves, count   the sum of 2 pi turns_per_m |push| over them is at most kMaxFold, so p is unique
//   shares         which waves count, and by what their amplitude and push are multiplied
// Returns height and gradient (of the height over the plane, by the implicit function theorem).
// Source: Gerstner 1809; Tessendorf 2001, section 3. Differs: a height field.
// Error: p off by 1e-5 of the longest wave at kMaxFold (tests/water/test_surface.cpp).
inline constexpr float kMaxFold = 0.6f;
template <class F, class Shares = WholeWaves>
SHOAL_INLINE SurfacePoint<F> trochoids_at(const TrochoidWave* waves, std::size_t count, F x_m, F z_m,
                                          const Shares& shares = {}) {
  F px = x_m, pz = z_m, height, sx, sz;
  F ixx, ixz, izz;  // of the inverse of the symmetric Jacobian of p - push(p)
  for (int round = 0;; ++round) {
    F off_x = F(0.0f), off_z = F(0.0f), jxx = F(1.0f), jxz = F(0.0f), jzz = F(1.0f);
    height = sx = sz = F(0.0f);
    for (std::size_t i = 0; i < count; ++i) {
      const TrochoidWave& w = waves[i];
      if (shares.template leave_out<F>(w)) continue;
      F sine, cosine;
      sincos_turns(px * F(w.turns_x_per_m) + pz * F(w.turns_z_per_m) + F(w.phase_turns), sine, cosine);
      const float kx = 6.28318531f * w.turns_x_per_m, kz = 6.28318531f * w.turns_z_per_m;
      off_x = off_x + shares.template of<F>(w, w.push_x_m) * sine;
      off_z = off_z + shares.template of<F>(w, w.push_z_m) * sine;
      jxx = jxx - shares.template of<F>(w, w.push_x_m * kx) * cosine;
      jxz = jxz - shares.template of<F>(w, w.push_x_m * kz) * cosine;
      jzz = jzz - shares.template of<F>(w, w.push_z_m * kz) * cosine;
      height = height + shares.template of<F>(w, w.amplitude_m) * cosine;
      sx = sx - shares.template of<F>(w, w.amplitude_m * kx) * sine;
      sz = sz - shares.template of<F>(w, w.amplitude_m * kz) * sine;
    }
    const F inverse = F(1.0f) / (jxx * jzz - jxz * jxz);
    ixx = jzz * inverse;
    ixz = -jxz * inverse;
    izz = jxx * inverse;
    if (round == kTrochoidRounds) break;
    const F miss_x = (px - off_x) - x_m, miss_z = (pz - off_z) - z_m;
    px = px - (ixx * miss_x + ixz * miss_z);
    pz = pz - (ixz * miss_x + izz * miss_z);
  }
  return {height, ixx * sx + ixz * sz, ixz * sx + izz * sz};
}

}  // namespace shoal::inline SHOAL_ISA_NS
