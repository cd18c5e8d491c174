// Gradient noise on the integer lattice with its exact gradient.
#pragma once

#include "core/wide/lanes.h"

namespace shoal::inline SHOAL_ISA_NS {

template <class F>
struct Noise {
  F value;   // within +-kNoiseBound
  F dx, dz;  // derivatives by the coordinates; length within kNoiseSlopeBound
};

// Suprema over the cell of what unit gradients can do: all four towards the centre; the slope's by a search over points
// and directions (2.0692 at the centre, 1.7909), rounded up.
inline constexpr float kNoiseBound = 0.70711f;
inline constexpr float kNoiseSlopeBoundQuintic = 2.0695f;
inline constexpr float kNoiseSlopeBoundCubic = 1.796f;

namespace noise_detail {

// Sixteen unit vectors, one every 22.5 degrees.
alignas(64) inline constexpr float kCosine[16] = {
    1.0f,  0x1.d906bcp-1f,  0x1.6a09e6p-1f,  0x1.87de2ap-2f,  0.0f, -0x1.87de2ap-2f, -0x1.6a09e6p-1f, -0x1.d906bcp-1f,
    -1.0f, -0x1.d906bcp-1f, -0x1.6a09e6p-1f, -0x1.87de2ap-2f, 0.0f, 0x1.87de2ap-2f,  0x1.6a09e6p-1f,  0x1.d906bcp-1f};

SHOAL_INLINE float pick16(const float* table, std::int32_t index) { return table[index & 15]; }
SHOAL_INLINE WideF pick16(const float* table, WideI index) { return permute(WideF::load(table), index); }

// A gradient for a lattice point whose coordinates are already times kPrimeX and kPrimeZ.
inline constexpr std::int32_t kPrimeX = 0x27D4EB2D, kPrimeZ = 0x165667B1, kMix = -0x61C88647;
template <class F>
SHOAL_INLINE void gradient(IntOf<F> hashed_x, IntOf<F> hashed_z, F& gx, F& gz) {
  using I = IntOf<F>;
  I h = (hashed_x ^ hashed_z) * I(kMix);
  h = (h ^ shift_right_logical(h, 15)) * I(kPrimeX);
  const I turn = shift_right_logical(h, 28);
  gx = pick16(kCosine, turn);
  gz = pick16(kCosine, turn + I(12));  // sin a = cos(a - 90 degrees)
}

}  // namespace noise_detail

// Perlin's noise with a gradient at every lattice point that a hash chooses of sixteen unit vectors.
//
//   x, z        coordinates in cells, |x|, |z| <= 2^30; periodic with 2^32 cells
//   cell_x, cell_z   added to the lattice point: large offsets lose no digits
//   seed        any
//   cubic       fade curve: 3 t^2 - 2 t^3, else 6 t^5 - 15 t^4 + 10 t^3; the same for all lanes
// Returns value and gradient; 0 at lattice points. RMS 0.216 and 0.883 (quintic), 0.212 and 0.809 (cubic).
// Source: Perlin 1985 and 2002; Li et al., section 2.1, eqs. 1 and 2. Differs: their eq. 3 is the product of two fades,
//         which is no noise; here gradients' ramps are blended, as their text says. No table of permutations.
// Error: value 2e-6 and gradient 8e-6 for coordinates below 1 (tests/water/test_noise.cpp); elsewhere the coordinates'
//        own rounding is added.
template <class F>
SHOAL_INLINE Noise<F> gradient_noise(F x, F z, std::int32_t cell_x, std::int32_t cell_z, std::int32_t seed,
                                     bool cubic) {
  using I = IntOf<F>;
  using namespace noise_detail;
  const F floor_x = floor(x), floor_z = floor(z);
  const F tx = x - floor_x, tz = z - floor_z;
  // Gradients at the four corners.
  const I column = (to_int_trunc(floor_x) + I(cell_x)) * I(kPrimeX);
  const I hx0 = column ^ I(seed), hx1 = (column + I(kPrimeX)) ^ I(seed);
  const I hz0 = (to_int_trunc(floor_z) + I(cell_z)) * I(kPrimeZ), hz1 = hz0 + I(kPrimeZ);
  F gx00, gz00, gx10, gz10, gx01, gz01, gx11, gz11;
  gradient(hx0, hz0, gx00, gz00);
  gradient(hx1, hz0, gx10, gz10);
  gradient(hx0, hz1, gx01, gz01);
  gradient(hx1, hz1, gx11, gz11);
  // Their ramps.
  const F sx = tx - F(1.0f), sz = tz - F(1.0f);
  const F v00 = gx00 * tx + gz00 * tz, v10 = gx10 * sx + gz10 * tz;
  const F v01 = gx01 * tx + gz01 * sz, v11 = gx11 * sx + gz11 * sz;
  // Fades and their derivatives.
  F u, w, du, dw;
  if (cubic) {
    u = tx * tx * (F(3.0f) - (tx + tx));
    w = tz * tz * (F(3.0f) - (tz + tz));
    du = F(-6.0f) * tx * sx;
    dw = F(-6.0f) * tz * sz;
  } else {
    const F tx2 = tx * tx, tz2 = tz * tz;
    u = tx2 * tx * (tx * (tx * F(6.0f) - F(15.0f)) + F(10.0f));
    w = tz2 * tz * (tz * (tz * F(6.0f) - F(15.0f)) + F(10.0f));
    du = F(30.0f) * tx2 * (sx * sx);
    dw = F(30.0f) * tz2 * (sz * sz);
  }
  // Blended: along x, then along z; the gradients alike, and the blends' own derivatives on top.
  const F along0 = v10 - v00, along1 = v11 - v01;
  const F row0 = v00 + u * along0, row1 = v01 + u * along1;
  const F gx0 = gx00 + u * (gx10 - gx00), gx1 = gx01 + u * (gx11 - gx01);
  const F gz0 = gz00 + u * (gz10 - gz00), gz1 = gz01 + u * (gz11 - gz01);
  const F across = row1 - row0;
  return {row0 + w * across, gx0 + w * (gx1 - gx0) + du * (along0 + w * (along1 - along0)),
          gz0 + w * (gz1 - gz0) + dw * across};
}

}  // namespace shoal::inline SHOAL_ISA_NS
