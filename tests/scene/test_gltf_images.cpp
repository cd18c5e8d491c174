// Pictures written by hand, compared texel for texel.
#include <catch2/catch.hpp>
#include <limits>

#include "core/error.h"
#include "scene/images/images.h"
#include "tests/scene/bad_files.h"

namespace shoal::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes decoded(const Bytes& file) { return texture_bytes(decode_texture(file, "picture", true)); }

// A Radiance file, rows not compressed: red, green, blue mantissas and a common exponent.
Bytes radiance_file(int width, int height, const Bytes& rgbe) {
  const std::string header =
      "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " + std::to_string(width) + "\n";
  Bytes file(header.begin(), header.end());
  file.insert(file.end(), rgbe.begin(), rgbe.end());
  return file;
}

}  // namespace

TEST_CASE("images: PNG of each kind becomes RGBA, alpha not multiplied in", "[images]") {
  CHECK(decoded(png(2, 1, 6, 8, {200, 100, 50, 3, 7, 8, 9, 0})) == Bytes{200, 100, 50, 3, 7, 8, 9, 0});
  CHECK(decoded(png(1, 2, 2, 8, {1, 2, 3, 254, 255, 0})) == Bytes{1, 2, 3, 255, 254, 255, 0, 255});
  CHECK(decoded(png(2, 1, 0, 8, {77, 0})) == Bytes{77, 77, 77, 255, 0, 0, 0, 255});
  CHECK(decoded(png(1, 1, 4, 8, {77, 5})) == Bytes{77, 77, 77, 5});
}

TEST_CASE("images: a PNG's gamma is not read", "[images]") {
  const Bytes plain = png(2, 1, 0, 8, {77, 200});
  Bytes file(plain.begin(), plain.begin() + 33);
  append_png_chunk(file, "gAMA", {0, 1, 0x86, 0xA0});  // 1.0
  file.insert(file.end(), plain.begin() + 33, plain.end());
  CHECK(decoded(file) == decoded(plain));
}

TEST_CASE("images: sixteen bits are rounded to the nearest of eight", "[images]") {
  // 257 v is exactly v of 8 bits; 128 more is still nearer to v than to v + 1, 129 is not.
  for (const int v : {0, 1, 77, 127, 254}) {
    const int values[] = {257 * v, 257 * v + 128, 257 * v + 129};
    Bytes row;
    for (const int value : values) {
      row.push_back(static_cast<std::uint8_t>(value >> 8));
      row.push_back(static_cast<std::uint8_t>(value & 255));
    }
    const Bytes rgba = decoded(png(3, 1, 0, 16, row));
    CHECK(rgba[0] == v);
    CHECK(rgba[4] == v);
    CHECK(rgba[8] == v + 1);
  }
}

TEST_CASE("images: Radiance files are linear floats", "[images]") {
  // Mantissa m and exponent e stand for (m + 0.5 or m) / 256 * 2^(e - 128): 128 with 129 is one.
  const Texture texture = decode_texture(radiance_file(2, 1, {128, 64, 0, 129, 0, 0, 0, 0}), "sky", true);
  REQUIRE(texture.format == TexelFormat::kRgba32Float);
  REQUIRE(texture.width[0] == 2);
  const float* texel = texture.rgba32f.data();
  CHECK(texel[0] == Approx(1.0).epsilon(1.0 / 128));
  CHECK(texel[1] == Approx(0.5).epsilon(1.0 / 64));
  CHECK(texel[3] == 1.0f);
  CHECK(texel[4] == 0.0f);
}

TEST_CASE("images: encoding loses nothing and repeats itself", "[images]") {
  const std::uint8_t texels[] = {255, 0,   7,   0,   1,   2,   3,  4, 9, 99, 199, 255,
                                 128, 127, 126, 125, 200, 100, 50, 1, 0, 0,  0,   0};
  const Texture texture = make_texture_rgba8(3, 2, texels, true);
  const Bytes file = encode_texture(texture, "t");
  CHECK(file == encode_texture(texture, "t"));
  CHECK(decoded(file) == Bytes(std::begin(texels), std::end(texels)));

  const float radiance[] = {0.1f, 1e6f, -3, 1, 3.3f, 2e-20f, 0.7f, 0.25f};
  const Bytes exr = encode_texture(make_texture_float(2, 1, radiance), "t");
  CHECK(exr == encode_texture(make_texture_float(2, 1, radiance), "t"));
  const Texture again = decode_texture(exr, "t", false);
  REQUIRE(again.format == TexelFormat::kRgba32Float);
  for (std::size_t i = 0; i < 8; ++i) CHECK(again.rgba32f[i] == radiance[i]);
}

TEST_CASE("images: size from the header, limits before decoding", "[images]") {
  const Bytes file = png(3, 2, 6, 8, Bytes(24, 1));
  CHECK(image_size(file, "p").width == 3);
  CHECK(image_size(file, "p").height == 2);
  CHECK_THROWS_WITH(image_size(file, "p", {2, 100}), Catch::Matchers::Contains("p: has 3 x 2 texels"));
  CHECK_THROWS_WITH(image_size(file, "p", {16384, 5}), Catch::Matchers::Contains("expected at most 5 in all"));
  CHECK_THROWS_AS(image_size(png(20000, 1, 6, 8, Bytes(8, 1)), "p"), Error);
}

TEST_CASE("images: damaged and foreign data are errors", "[images]") {
  const Bytes file = png(3, 2, 6, 8, Bytes(24, 1));
  for (std::size_t size = 0; size < file.size(); ++size) {
    CHECK_THROWS_AS(decode_texture(std::span(file).first(size), "p", true), Error);
  }
  for (std::size_t at = 0; at < file.size(); ++at) {
    Bytes damaged = file;
    damaged[at] ^= 0x55u;
    CHECK_THROWS_AS(decode_texture(damaged, "p", true), Error);
  }
  for (const char* text : {"GIF89a______", "#?RADIANCE\n", "v/1\x01____________", "\xFF\xD8\xFF\xE0"}) {
    const std::string bytes = text;
    CHECK_THROWS_AS(decode_texture({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, "p", true),
                    Error);
  }
  CHECK_THROWS_AS(load_texture("/", true), Error);
  CHECK_THROWS_AS(load_texture("/no/such/picture.png", true), Error);
}

}  // namespace shoal::test
