// The radiance of rays that leave the scene: one colour, a clear-day sky, or a picture of the surroundings.
//
// The sky is a picture, not a model of scattering: a gradient from horizon to zenith that whitens towards the horizon,
// where calm water reflects the most of it, ground below, a sun disc and a glow of four widths. Its powers are repeated
// squares, so that it costs a few cycles a pixel.
#pragma once

#include "core/vec_lanes.h"
#include "shading/environment/sample.h"
#include "shading/material.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace sky_detail {
// 0 at 0 and below, 1 at 1 and above, level at both ends.
template <class F>
SHOAL_INLINE F smooth(F t) {
  const F c = min(max(t, F(0.0f)), F(1.0f));
  return c * c * (F(3.0f) - (c + c));
}
// 1 above the horizon, 0 from 3 degrees below it on.
template <class F>
SHOAL_INLINE F above_horizon(F y) {
  return smooth(F(1.0f) + y * F(20.0f));
}

// The glow round the sun: a sum of powers of the cosine to it.
struct GlowLobe {
  float height, power;
};
inline constexpr GlowLobe kGlow[4] = {{0.004f, 8.0f}, {0.010f, 64.0f}, {0.03f, 512.0f}, {0.08f, 2048.0f}};

// The sun's disc: 0.2665 degrees of radius (squared, radians), its edge softened over a third more.
inline constexpr float kDiscRadius2 = 0.004651f * 0.004651f;

//   chord2  squared chord between a direction and the sun's: 2 - 2 cosine
template <class F>
SHOAL_INLINE F sun_disc(F chord2) {
  return smooth(F(2.3f) - chord2 * F(1.3f / kDiscRadius2));
}
}  // namespace sky_detail

// The background without the sun, as rough surfaces reflect it: the sun reaches them as a directional light.
//   direction_world  unit, away from the scene; +y is up
// Returns linear radiance, continuous in the direction.
template <class F>
SHOAL_INLINE Vec3<F> background_gradient(const Background& background, Vec3<F> direction_world) {
  if (background.kind == Background::Kind::kColor) return broadcast<F>(background.color);
  if (background.kind == Background::Kind::kEnvironment) {
    Vec3<F> seen;
    environment_radiance<F>(*background.environment, direction_world, seen);
    return seen;
  }
  const F y = min(max(direction_world.y, F(-1.0f)), F(1.0f));
  const F down = F(1.0f) - max(y, F(0.0f));
  const F down2 = down * down, down4 = down2 * down2, down16 = (down4 * down4) * (down4 * down4);
  // The air mass grows slowly at first, then steeply in the last degrees: (1 - y)^3, and a band of haze of (1 - y)^16.
  const Vec3f step = background.horizon - background.zenith;
  const F low = F(0.8f) * (down2 * down) + F(0.2f) * down16;
  const Vec3<F> clear = broadcast<F>(background.zenith) + broadcast<F>(step) * low;
  return lerp(broadcast<F>(background.ground), clear, sky_detail::above_horizon(y));
}

// The whole background: the gradient, and the sun's disc and glow where there is a sun.
//   direction_world  unit, away from the scene
// Returns linear radiance, not negative where the background's colours are not.
template <class F>
SHOAL_INLINE Vec3<F> background_radiance(const Background& background, Vec3<F> direction_world) {
  const Vec3<F> sky = background_gradient<F>(background, direction_world);
  const Vec3f s = background.sun;
  if (background.kind != Background::Kind::kSky || (s.x == 0.0f && s.y == 0.0f && s.z == 0.0f)) return sky;

  // Squared chord to the sun, 2 - 2 cos: exact enough near the disc, where the cosine itself is not.
  const Vec3<F> offset = direction_world - broadcast<F>(background.to_sun_world);
  const F chord2 = dot(offset, offset);
  const F cosine = min(max(F(1.0f) - F(0.5f) * chord2, F(0.0f)), F(1.0f));
  const F c2 = cosine * cosine, c4 = c2 * c2, c8 = c4 * c4;
  const F c16 = c8 * c8, c32 = c16 * c16, c64 = c32 * c32;
  const F c128 = c64 * c64, c256 = c128 * c128, c512 = c256 * c256, c2048 = (c512 * c512) * (c512 * c512);
  using sky_detail::kGlow;
  const F glow =
      (F(kGlow[0].height) * c8 + F(kGlow[1].height) * c64) + (F(kGlow[2].height) * c512 + F(kGlow[3].height) * c2048);
  const F disc = sky_detail::sun_disc(chord2);
  return sky + broadcast<F>(s) * ((glow + disc) * sky_detail::above_horizon(direction_world.y));
}

// The background as a room takes it that does not include this one (water/rough_mirror.h).
struct SkyView {
  const Background& background;

  static constexpr const sky_detail::GlowLobe (&kGlow)[4] = sky_detail::kGlow;
  static constexpr float kDiscRadius2 = sky_detail::kDiscRadius2;

  template <class F>
  SHOAL_INLINE Vec3<F> radiance(Vec3<F> direction_world) const {
    return background_radiance<F>(background, direction_world);
  }
  template <class F>
  SHOAL_INLINE Vec3<F> gradient(Vec3<F> direction_world) const {
    return background_gradient<F>(background, direction_world);
  }
  // The mean of an environment over a GGX lobe; only where there is an environment.
  template <class F>
  SHOAL_INLINE Vec3<F> lobe(Vec3<F> direction_world, F roughness) const {
    return environment_lobe<F>(*background.environment, direction_world, roughness);
  }
  SHOAL_INLINE bool has_environment() const { return background.kind == Background::Kind::kEnvironment; }

  // The sun of a sky; the others are only of use where there is one.
  SHOAL_INLINE bool has_sun() const {
    const Vec3f s = background.sun;
    return background.kind == Background::Kind::kSky && (s.x != 0.0f || s.y != 0.0f || s.z != 0.0f);
  }
  SHOAL_INLINE Vec3f sun() const { return background.sun; }
  SHOAL_INLINE Vec3f to_sun_world() const { return background.to_sun_world; }
  // The share of the sun that is above the horizon, 0 to 1.
  SHOAL_INLINE float sun_risen() const { return sky_detail::above_horizon(background.to_sun_world.y); }
  template <class F>
  SHOAL_INLINE F disc(F chord2) const {
    return sky_detail::sun_disc(chord2);
  }
};

}  // namespace shoal::inline SHOAL_ISA_NS
