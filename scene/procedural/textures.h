// Textures of the procedural scenes: sRGB, 8 bits, from integer hashes, the same bytes everywhere.
#pragma once

#include <cstdint>

#include "shading/textures/texture.h"

namespace shoal {

// Integer hash of a lattice point (two rounds of xor-shift and multiply, constants of Wellons' lowbias32).
std::uint32_t hash_lattice(std::int32_t x, std::int32_t y, std::uint32_t seed);

// Smooth value noise in [0, 1] that repeats every `period` lattice cells (0: never).
float value_noise(float x, float y, std::int32_t period, std::uint32_t seed);

// A sum of octaves of value noise, each of twice the frequency and half the amplitude; in [0, 1].
float fractal_noise(float x, float y, std::int32_t period, int octaves, std::uint32_t seed);

// All of these repeat in both directions. The comments give the width of a texture on the surface.
Texture make_pool_tiles();       // 1.6 m: 16 x 16 turquoise mosaic tiles
Texture make_lane_tiles();       // 1.6 m: the same tiles in navy
Texture make_waterline_tiles();  // 0.5 m wide, 0.25 m high: a frieze of small tiles
Texture make_pavers();           // 2.4 m: 4 x 4 travertine slabs, joints staggered
Texture make_coping();           // 0.6 m along u: a pale stone
Texture make_stucco();           // 3 m, near white: tint by the material's colour
Texture make_roof_tiles();       // 1.2 m: clay, courses along v
Texture make_planks();           // 1.2 m: 8 boards along u
Texture make_foliage();          // 1 m of leaves, near white: tint by the material's colour
Texture make_grass();            // 4 m of grass, near white: tint by vertex colours
Texture make_beach_ball();       // once around u: six gores, caps at v = 0 and 1
Texture make_ring_stripes();     // once around u: eight stripes
Texture make_awning();           // once around u: sixteen stripes
Texture make_ripple_marble();    // 1.2 m: veined white stone
Texture make_checker();          // 2 m: 4 x 4 stone slabs, pale and slate in turn
Texture make_gravel();           // 0.5 m (of a tank): 24 x 24 pebbles
Texture make_rock();             // 1 m: grey stone with lichen
Texture make_fish_bands();       // u once around, v from tail to nose: white bands on orange
Texture make_fish_flank();       // the same: blue with a dark sweep
Texture make_dirt();             // 2 m: earth with drifts of pebbles
Texture make_verge();            // 1.7 m along u; from earth at v = 0 to grass at v = 1
Texture make_blue_glaze();       // of a pot: u once around, v from its foot over the lip to its inside
Texture make_green_glaze();

}  // namespace shoal
