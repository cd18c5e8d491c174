// The shape of a pixel in a texture: the ellipse that its derivatives span, and the probes that fill it.
#pragma once

#include "core/vec_lanes.h"
#include "shading/textures/texture.h"

namespace shoal::inline SHOAL_ISA_NS {

// Where one pixel is sampled: probe i of `count` lies at ((i + 1/2) / count - 1/2) of the axis from the pixel's uv.
template <class F>
struct Probes {
  IntOf<F> count;   // 1 to the limit
  F rho2;           // a probe's width in texels of level 0, squared: 1 (magnified, or not a number) to 2^28
  Vec2<F> axis_uv;  // the ellipse's long axis, end to end, in uv
};

namespace footprint_detail {
// Limits a derivative so that its fourth power is finite: all larger footprints have the last of 15 levels.
template <class F>
SHOAL_INLINE F tame(F texels) {
  constexpr float kMax = 0x1p20f;
  return select(texels == texels, clamp(texels, F(-kMax), F(kMax)), F(0.0f));
}
}  // namespace footprint_detail

// The probes of one pixel.
//   duv_dx, duv_dy  the change of uv over one pixel
//   limit           2 to 16: the most probes, and the greatest ratio of the axes that keeps its sharpness
// With the derivatives in texels as columns, the singular values of that matrix are the ellipse's axes, long and short.
// The ratio eta = min(long / short, limit); a probe is as wide as long / eta, so the level changes smoothly, and there
// are ceil(eta - 1/8) of them: rounding does not buy a second one for a round footprint.
// Source: Vulkan 1.3, 16.5.7 (scale factors, ratio of anisotropy) and "texel anisotropic filtering". Differs: the axes
// are the ellipse's own, not the two derivatives, so a picture does not depend on how a camera is rolled (Heckbert
// 1989, 3.5.8); an axis counts as one texel at least, because level 0 is the sharpest; probes lie at the middles of
// equal parts, not at i / (N + 1), so that their spread is that of the pixel's box. Error: ratio and axis 1e-5 of
// double precision where the ratio is up to the limit (tests/shading/test_anisotropy.cpp).
template <class F>
SHOAL_INLINE Probes<F> footprint_probes(const Texture& texture, Vec2<F> duv_dx, Vec2<F> duv_dy, int limit) {
  using footprint_detail::tame;
  const float width = static_cast<float>(texture.width[0]), height = static_cast<float>(texture.height[0]);
  const F ux = tame(duv_dx.x * F(width)), vx = tame(duv_dx.y * F(height));
  const F uy = tame(duv_dy.x * F(width)), vy = tame(duv_dy.y * F(height));
  const F half(0.5f), one(1.0f), zero(0.0f);

  // Eigenvalues of the matrix of inner products. The smaller one by the determinant: the difference would cancel.
  const F xx = ux * ux + vx * vx, yy = uy * uy + vy * vy, xy = ux * uy + vx * vy;
  const F difference = xx - yy, twice = xy + xy;
  const F root = sqrt(difference * difference + twice * twice);
  const F area = ux * vy - uy * vx;
  const F long2 = max(((xx + yy) + root) * half, one);
  const F short2 = max(area * area / long2, one);
  const F eta = min(sqrt(long2 / short2), F(static_cast<float>(limit)));

  // The long axis' eigenvector on the screen, from the row that does not cancel; of a circle any will do.
  const F part = (abs(difference) + root) * half;
  const MaskOf<F> x_longer = difference >= zero;
  const F sx = select(x_longer, part, xy), sy = select(x_longer, xy, part);
  const F length = sqrt(sx * sx + sy * sy);
  const F scale = select(length > zero, one / select(length > zero, length, one), zero);
  const F ax = (ux * sx + uy * sy) * scale, ay = (vx * sx + vy * sy) * scale;

  const F count = max(-floor(F(0.125f) - eta), one);
  return {
      to_int_trunc(count), clamp(long2 / (eta * eta), one, F(0x1p28f)), {ax * F(1.0f / width), ay * F(1.0f / height)}};
}

}  // namespace shoal::inline SHOAL_ISA_NS
