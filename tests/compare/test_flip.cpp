// FLIP against published values, a direct evaluation in double precision without any separation of filters, and what
// must hold of any pictures.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "compare/flip.h"
#include "compare/statistics.h"
#include "flip_oracle.h"
#include "scene/images/images.h"

namespace shoal::test {
namespace {

LinearPicture solid(int width, int height, float r, float g, float b) {
  LinearPicture picture{width, height, {}};
  for (int i = 0; i < width * height; ++i) picture.rgb.insert(picture.rgb.end(), {r, g, b});
  return picture;
}

// Blocks of colours with noise: edges, points and flat parts.
LinearPicture blocks(int width, int height, unsigned seed, float most = 1.0f) {
  std::mt19937 random(seed);
  const auto uniform = [&] { return static_cast<float>(random() >> 8) * (1.0f / 16777216.0f); };
  std::vector<float> block_color;
  for (int i = 0; i < 300; ++i) block_color.push_back(uniform() * most);
  LinearPicture picture{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int block = (x / 9 + y / 7 * 5) % 100;
      for (int c = 0; c < 3; ++c) {
        picture.rgb.push_back(
            std::max(0.0f, block_color[static_cast<std::size_t>(block * 3 + c)] + (uniform() - 0.5f) * 0.1f * most));
      }
    }
  }
  return picture;
}

float most_difference(const std::vector<float>& a, const std::vector<double>& b) {
  REQUIRE(a.size() == b.size());
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::fabs(static_cast<double>(a[i]) - b[i]));
  return static_cast<float>(most);
}

LinearPicture load_png(const std::string& path) {
  const Texture texture = load_texture(path, true);
  const Vec2<int> size{texture.width[0], texture.height[0]};
  const std::vector<std::uint8_t> rgba = texture_bytes(texture);
  std::vector<std::uint8_t> rgb;
  for (std::size_t i = 0; i < rgba.size(); i += 4) rgb.insert(rgb.end(), {rgba[i], rgba[i + 1], rgba[i + 2]});
  return linear_from_srgb8(size.x, size.y, rgb.data());
}

}  // namespace

TEST_CASE("flip: the published pair", "[flip]") {
  const char* shared = std::getenv("SHOAL_SHARED_DATA");
  if (shared == nullptr || !std::filesystem::exists(std::string(shared) + "/flip/tree-ref.png")) {
    WARN("SHOAL_SHARED_DATA is not set: FLIP is not compared with its published values");
    return;
  }
  ThreadPool pool(2);
  const LinearPicture reference = load_png(std::string(shared) + "/flip/tree-ref.png");
  const LinearPicture test = load_png(std::string(shared) + "/flip/tree-test.png");
  const std::vector<float> error = ldr_flip(reference, test, {kDefaultPixelsPerDegree, supported_isas().front()}, pool);
  CHECK(mean_of(error) == Approx(0.133285).margin(0.0001));
  CHECK(weighted_percentile_of(error, 0.25) == Approx(0.184924).margin(0.0001));
  CHECK(weighted_percentile_of(error, 0.5) == Approx(0.333241).margin(0.0001));
  CHECK(weighted_percentile_of(error, 0.75) == Approx(0.503441).margin(0.0001));
  CHECK(static_cast<double>(*std::max_element(error.begin(), error.end())) == Approx(0.983044).margin(0.0001));
}

TEST_CASE("flip: as the direct evaluation in double precision", "[flip]") {
  ThreadPool pool(2);
  for (const float ppd : {67.02f, 20.0f, 3.0f}) {
    CAPTURE(ppd);
    const LinearPicture a = blocks(45, 37, 1), b = blocks(45, 37, 2);
    const std::vector<double> expected = oracle_ldr_flip(a, b, static_cast<double>(ppd));
    for (const Isa isa : supported_isas()) CHECK(most_difference(ldr_flip(a, b, {ppd, isa}, pool), expected) < 2e-4f);
  }
}

TEST_CASE("flip: the same bytes for any threads and instruction set, and exchanged", "[flip]") {
  const LinearPicture a = blocks(70, 131, 3), b = blocks(70, 131, 4);
  ThreadPool one(1), three(3);
  const std::vector<float> error = ldr_flip(a, b, {kDefaultPixelsPerDegree, supported_isas().back()}, one);
  for (const Isa isa : supported_isas()) {
    CHECK(ldr_flip(a, b, {kDefaultPixelsPerDegree, isa}, three) == error);
    CHECK(ldr_flip(b, a, {kDefaultPixelsPerDegree, isa}, one) == error);
  }
}

TEST_CASE("flip: nothing differs", "[flip]") {
  ThreadPool pool(1);
  const LinearPicture a = blocks(33, 20, 5);
  for (const float e : ldr_flip(a, a, {}, pool)) REQUIRE(e == 0.0f);
  for (const float e : hdr_flip(a, a, {}, pool).error) REQUIRE(e == 0.0f);
}

TEST_CASE("flip: solid colours", "[flip]") {
  ThreadPool pool(1);
  const auto of = [&](const LinearPicture& a, const LinearPicture& b) {
    const std::vector<float> error = ldr_flip(a, b, {}, pool);
    CHECK(*std::min_element(error.begin(), error.end()) == *std::max_element(error.begin(), error.end()));
    return static_cast<double>(error[0]);
  };
  // Filters of sum 1 keep a solid colour, and it has no features: the colours' error alone. Green and blue are the
  // farthest apart there are: 1 by definition. Black and white are 100 apart, green and blue 308 after Hunt.
  CHECK(of(solid(24, 17, 0, 1, 0), solid(24, 17, 0, 0, 1)) == Approx(1).margin(1e-5));
  const double black_white = of(solid(24, 17, 0, 0, 0), solid(24, 17, 1, 1, 1));
  CHECK(black_white == Approx(oracle_color_error({0, 0, 0}, {1, 1, 1})).margin(1e-5));
  CHECK(black_white > 0.95);
  // The more they differ, the more they differ.
  double last = 0;
  for (int i = 1; i <= 10; ++i) {
    const float grey = static_cast<float>(i) * 0.1f;
    const double error = of(solid(8, 8, 0, 0, 0), solid(8, 8, grey, grey, grey));
    CHECK(error > last);
    last = error;
  }
  // Out of range is the end of the range; what is no number is black.
  CHECK(of(solid(5, 5, -1, -2, 0), solid(5, 5, 2, 3, 4)) == black_white);
  CHECK(of(solid(5, 5, std::nanf(""), 0, 0), solid(5, 5, 1, 1, 1)) == black_white);
}

TEST_CASE("flip: from farther away a fine pattern matters less", "[flip]") {
  ThreadPool pool(1);
  LinearPicture stripes = solid(64, 64, 0, 0, 0);
  const LinearPicture grey = solid(64, 64, 0.5f, 0.5f, 0.5f);
  for (std::size_t i = 0; i < stripes.rgb.size(); ++i) stripes.rgb[i] = i / 3 % 2 ? 1.0f : 0.0f;
  double last = 2;
  for (const float ppd : {5.0f, 20.0f, 40.0f, 80.0f}) {
    const double mean = mean_of(ldr_flip(grey, stripes, {ppd}, pool));
    CHECK(mean < last);
    last = mean;
  }
}

TEST_CASE("flip: HDR is the maximum over its exposures", "[flip]") {
  ThreadPool pool(2);
  const LinearPicture a = blocks(40, 30, 6, 20.0f), b = blocks(40, 30, 7, 20.0f);
  const HdrFlip flip = hdr_flip(a, b, {kDefaultPixelsPerDegree, supported_isas().front()}, pool);
  REQUIRE(flip.exposures >= 2);
  CHECK(most_difference(flip.error, oracle_hdr_flip(a, b, 67.02)) < 5e-4f);
}

TEST_CASE("flip: the range of exposures", "[flip]") {
  // Half at 1, half at 2^10 of it, one pixel more at 1: the median is 1, the brightest 1024.
  LinearPicture picture = solid(3, 1, 1, 1, 1);
  for (std::size_t c = 0; c < 3; ++c) picture.rgb[c] = 1024.0f;
  const HdrFlip range = exposure_range(picture);
  // The curve reaches 0.85 at x = 1.3448 (its quadratic, by hand to four digits): log2 of that.
  CHECK(range.last_stops == Approx(std::log2(oracle_bright_input())).margin(1e-5));
  CHECK(range.last_stops - range.first_stops == Approx(10).margin(1e-5));
  CHECK(range.exposures >= 10);
  CHECK(range.exposures <= 11);
  const HdrFlip black = exposure_range(solid(3, 3, 0, 0, 0));
  CHECK(black.exposures == 1);
  CHECK(black.first_stops == 0);
  ThreadPool pool(1);
  // Brightness that no 8-bit picture shows does count.
  const LinearPicture dim = solid(8, 8, 0.001f, 0.001f, 0.001f), dimmer = solid(8, 8, 0.0003f, 0.0003f, 0.0003f);
  CHECK(mean_of(hdr_flip(dim, dimmer, {}, pool).error) > 4 * mean_of(ldr_flip(dim, dimmer, {}, pool)));
  // Numbers that overflow on the way do no harm.
  for (const float e : hdr_flip(solid(4, 4, 1e38f, 0, 1e-38f), solid(4, 4, 1e-44f, 3e38f, 1), {}, pool).error) {
    CHECK((e >= 0.0f && e <= 1.0f));
  }
}

}  // namespace shoal::test
