// Every surface and valid_normal: sixteen lanes give the bits of one, and every instruction set those written here.
#include <algorithm>
#include <cmath>
#include <random>

#include "../core/isa_case.h"
#include "core/digest.h"
#include "surface_cases.h"
#include "water/filter_surface.h"
#include "water/intersect_surface.h"
#include "water/surface.h"
#include "water/valid_normal.h"

namespace {

using namespace shoal;
using surface_cases::kBody;

}  // namespace

SHOAL_ISA_CASE(lanes_equal_scalars, "surfaces have the same bits in lanes as alone") {
  for (const auto& c : surface_cases::all()) {
    CAPTURE(c.name);
    const WaterSurface surface = prepare_surface(c.settings, 2.25, kBody);
    std::mt19937 random(11);
    for (int block = 0; block < 200; ++block) {
      alignas(64) float x[16], z[16], wide[3][16];
      for (int i = 0; i < 16; ++i) {
        x[i] = static_cast<float>(static_cast<std::int32_t>(random()) >> 8) * 0x1p-19f;
        z[i] = static_cast<float>(static_cast<std::int32_t>(random()) >> 8) * 0x1p-19f;
      }
      if (block == 0) x[3] = 1e30f, z[4] = -HUGE_VALF, x[5] = 0.0f, z[5] = -0.0f;
      const SurfacePoint<WideF> got = surface_at(surface, WideF::load(x), WideF::load(z));
      got.height_m.store(wide[0]);
      got.slope_x.store(wide[1]);
      got.slope_z.store(wide[2]);
      for (int i = 0; i < 16; ++i) {
        const SurfacePoint<float> one = surface_at(surface, x[i], z[i]);
        REQUIRE(as_int(wide[0][i]) == as_int(one.height_m));
        REQUIRE(as_int(wide[1][i]) == as_int(one.slope_x));
        REQUIRE(as_int(wide[2][i]) == as_int(one.slope_z));
      }
    }
  }
}

SHOAL_ISA_CASE(filtered_lanes_equal, "filtered surfaces have the same bits in lanes as alone") {
  for (const auto& c : surface_cases::all()) {
    CAPTURE(c.name);
    const WaterSurface surface = prepare_surface(c.settings, 2.25, kBody);
    std::mt19937 random(17);
    const auto within = [&](float size) {
      return static_cast<float>(static_cast<std::int32_t>(random()) >> 8) * 0x1p-23f * size;
    };
    for (int block = 0; block < 200; ++block) {
      alignas(64) float in[6][16], wide[4][16];
      // From all lanes near to all far, and mixed.
      for (int i = 0; i < 16; ++i) {
        const float size = block % 4 == 0   ? 0.02f
                           : block % 4 == 1 ? 20.0f
                           : block % 4 == 2 ? 0.5f
                                            : 1.5f * within(1.0f);
        in[0][i] = within(15.0f), in[1][i] = within(15.0f);
        for (int k = 2; k < 6; ++k) in[k][i] = within(size);
      }
      if (block == 3) in[2][3] = 1e6f, in[4][3] = -1e6f;
      const auto load = [&](int k) { return WideF::load(in[k]); };
      const FilteredPoint<WideF> got =
          filtered_surface_at(surface, load(0), load(1), Footprint<WideF>{load(2), load(3), load(4), load(5)});
      got.mean.height_m.store(wide[0]);
      got.mean.slope_x.store(wide[1]);
      got.mean.slope_z.store(wide[2]);
      got.slope_variance.store(wide[3]);
      for (int i = 0; i < 16; ++i) {
        const FilteredPoint<float> one =
            filtered_surface_at(surface, in[0][i], in[1][i], Footprint<float>{in[2][i], in[3][i], in[4][i], in[5][i]});
        REQUIRE(as_int(wide[0][i]) == as_int(one.mean.height_m));
        REQUIRE(as_int(wide[1][i]) == as_int(one.mean.slope_x));
        REQUIRE(as_int(wide[2][i]) == as_int(one.mean.slope_z));
        REQUIRE(as_int(wide[3][i]) == as_int(one.slope_variance));
        REQUIRE(one.slope_variance >= 0);
      }
    }
  }
}

SHOAL_ISA_CASE(valid_normals_equal, "valid_normal has the same bits in lanes as alone") {
  std::mt19937 random(12);
  const auto signed_unit = [&] { return static_cast<float>(static_cast<std::int32_t>(random()) >> 8) * 0x1p-23f; };
  for (const float eta : {0.75f, 1.0f, 1.333f}) {
    for (int block = 0; block < 400; ++block) {
      alignas(64) float in[6][16], wide[3][16];
      Vec3f d[16], wave[16];
      for (int i = 0; i < 16; ++i) {
        d[i] = normalize(Vec3f{signed_unit(), -0.3f * std::fabs(signed_unit()) - 1e-4f, signed_unit()});
        wave[i] = normalize(Vec3f{signed_unit(), 1.0f, signed_unit()});
        in[0][i] = d[i].x, in[1][i] = d[i].y, in[2][i] = d[i].z;
        in[3][i] = wave[i].x, in[4][i] = wave[i].y, in[5][i] = wave[i].z;
      }
      const Vec3<WideF> got = valid_normal<WideF>({WideF::load(in[0]), WideF::load(in[1]), WideF::load(in[2])},
                                                  broadcast<WideF>(Vec3f{0, 1, 0}),
                                                  {WideF::load(in[3]), WideF::load(in[4]), WideF::load(in[5])}, eta);
      got.x.store(wide[0]);
      got.y.store(wide[1]);
      got.z.store(wide[2]);
      for (int i = 0; i < 16; ++i) {
        const Vec3f one = valid_normal<float>(d[i], Vec3f{0, 1, 0}, wave[i], eta);
        REQUIRE(as_int(wide[0][i]) == as_int(one.x));
        REQUIRE(as_int(wide[1][i]) == as_int(one.y));
        REQUIRE(as_int(wide[2][i]) == as_int(one.z));
      }
    }
  }
}

SHOAL_ISA_CASE(crossings_equal, "intersect_surface has the same bits in lanes as alone") {
  const WaterSurface surface = prepare_surface(surface_cases::of_kind(SurfaceKind::kGradientWaves), 2.25, kBody);
  std::mt19937 random(13);
  const auto s = [&] { return static_cast<float>(static_cast<std::int32_t>(random()) >> 8) * 0x1p-23f; };
  int hits = 0;
  for (int block = 0; block < 40; ++block) {
    alignas(64) float in[6][16], wide[16];
    for (int i = 0; i < 16; ++i) {
      const Vec3f d = normalize(Vec3f{s(), 0.3f * s(), s()});
      in[0][i] = s(), in[1][i] = 3 * surface.height_bound_m * s(), in[2][i] = s();
      in[3][i] = d.x, in[4][i] = i == 3 ? 0.0f : d.y, in[5][i] = d.z;
    }
    const WideM lanes = mask_from_bits(0xFFF7u);
    intersect_surface<WideF>(surface, {WideF::load(in[0]), WideF::load(in[1]), WideF::load(in[2])},
                             {WideF::load(in[3]), WideF::load(in[4]), WideF::load(in[5])}, 0.0f, 2.0f, lanes)
        .store(wide);
    for (int i = 0; i < 16; ++i) {
      const float one = intersect_surface<float>(surface, {in[0][i], in[1][i], in[2][i]},
                                                 {in[3][i], in[4][i], in[5][i]}, 0.0f, 2.0f, i != 3);
      REQUIRE(as_int(wide[i]) == as_int(one));
      hits += one < HUGE_VALF ? 1 : 0;
    }
  }
  CHECK(hits > 100);
}

// A change of these digests changes every picture of waves: CHANGELOG.md says why.
SHOAL_ISA_CASE(surfaces_are_pinned, "surfaces have the bits that are written here") {
  static const std::pair<const char*, const char*> kPinned[] = {
      {"perlin 4", "0ac447ceadb5403fc0f2a0aa16ca7f7b"},
      {"gradient-waves", "0060a96e0e24b0ec9481a8523e04fdbf"},
      {"ripples exponential", "8c57f586cd4c6ea41ac0423df4d95f7a"},
      {"spectrum", "cd6b924515c9e486ab3a42e0944956e7"},
      {"ripple-filter", "f9318f58345231c3fff0b9bf65b810b2"},
      {"gerstner 5", "2f20da069df72a341e6a1077f09dd981"},
  };
  for (const auto& c : surface_cases::all()) {
    const auto* pinned =
        std::find_if(std::begin(kPinned), std::end(kPinned), [&](const auto& p) { return c.name == p.first; });
    if (pinned == std::end(kPinned)) continue;
    const WaterSurface surface = prepare_surface(c.settings, 2.25, kBody);
    Digest digest;
    for (int block = 0; block < 256; ++block) {
      const WideF x = to_float(lane_index()) * WideF(1.375f) - WideF(9.0f);
      const SurfacePoint<WideF> got = surface_at(surface, x, WideF(static_cast<float>(block) * 0.0625f - 7.0f));
      alignas(64) float out[48];
      got.height_m.store(out);
      got.slope_x.store(out + 16);
      got.slope_z.store(out + 32);
      digest.add(out, sizeof out);
    }
    CAPTURE(c.name);
    CHECK(digest.hex() == pinned->second);
  }
}
