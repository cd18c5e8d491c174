// The Fourier transform against the sum that defines it, and the sea against a sum of its waves.
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <random>

#include "surface_cases.h"
#include "water/fft.h"
#include "water/surface.h"

namespace {
using namespace shoal;
constexpr double kTurn = 6.283185307179586;
}  // namespace

TEST_CASE("the transform is the sum that defines it", "[water]") {
  std::mt19937 random(41);
  for (const std::size_t side : {2u, 8u, 32u}) {
    std::vector<Complex> values(side * side);
    std::vector<std::complex<double>> in;
    double square = 0;
    for (Complex& v : values) {
      v = {static_cast<float>(random() >> 8) * 0x1p-24f - 0.5f, static_cast<float>(random() >> 8) * 0x1p-24f - 0.5f};
      in.emplace_back(static_cast<double>(v.re), static_cast<double>(v.im));
      square += std::norm(in.back());
    }
    inverse_fft_2d(values, side);
    double worst = 0;
    for (std::size_t y = 0; y < side; ++y) {
      for (std::size_t x = 0; x < side; ++x) {
        std::complex<double> sum = 0;
        for (std::size_t q = 0; q < side; ++q)
          for (std::size_t p = 0; p < side; ++p)
            sum += in[q * side + p] *
                   std::polar(1.0, kTurn * static_cast<double>(p * x + q * y) / static_cast<double>(side));
        const Complex got = values[y * side + x];
        worst = std::max(
            worst, std::abs(sum - std::complex<double>(static_cast<double>(got.re), static_cast<double>(got.im))));
      }
    }
    CAPTURE(side, worst);
    CHECK(worst < 1e-6 * std::sqrt(square));
  }
}

TEST_CASE("the sea at its grid's points is the sum of its waves, at any time, and repeats by tiles", "[water]") {
  SurfaceSettings s = surface_cases::of_kind(SurfaceKind::kSpectrum);
  s.grid = 32;
  s.amplitude_m = 0.3f;
  s.direction_deg = 30;
  const SurfaceModel model = make_surface_model(s, surface_cases::kBody);
  const double tile = static_cast<double>(*model.parts[0].settings.tile_m);
  const std::vector<float>& waves = model.parts[0].waves;
  double variance = 0;
  for (const double time : {0.0, 2.5, 1000.0}) {
    const WaterSurface surface = prepare_surface(model, time);
    for (const auto& [i, j] : {std::pair{0, 0}, std::pair{5, 17}, std::pair{31, 2}}) {
      // Each wave and its mirror image: twice the real part.
      double height = 0;
      variance = 0;
      for (int q = 0; q < 32; ++q) {
        for (int p = 0; p < 32; ++p) {
          const double kx = kTurn / tile * (p > 16 ? p - 32 : p), kz = kTurn / tile * (q > 16 ? q - 32 : q);
          const double omega = std::sqrt(9.81 * std::hypot(kx, kz));
          const std::complex<double> h0(static_cast<double>(waves[static_cast<std::size_t>(2 * (q * 32 + p))]),
                                        static_cast<double>(waves[static_cast<std::size_t>(2 * (q * 32 + p) + 1)]));
          height += 2 * std::real(h0 * std::polar(1.0, (kx * i + kz * j) * tile / 32 - omega * time));
          variance += 2 * std::norm(h0);
        }
      }
      const float x = static_cast<float>(tile * i / 32), z = static_cast<float>(tile * j / 32);
      CAPTURE(time, i, j);
      REQUIRE(surface_at(surface, x, z).height_m == Approx(0.3 * height).margin(3e-5));
      REQUIRE(surface_at(surface, x + static_cast<float>(tile), z - static_cast<float>(3 * tile)).height_m ==
              Approx(surface_at(surface, x, z).height_m).margin(2e-5));
    }
  }
  CHECK(variance == Approx(0.5).epsilon(1e-4));
}
