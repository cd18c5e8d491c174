// Pictures whose header exceeds their data: they are refused before a library allocates memory.
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "core/error.h"
#include "scene/images/images.h"
#include "tests/scene/bad_files.h"

namespace shoal::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::string error_of(const Bytes& file) {
  try {
    decode_texture(file, "picture", true);
  } catch (const Error& e) {
    return e.what();
  }
  return "decoded";
}

// Where the text begins; the file's end where it is not there.
std::size_t place_of(const Bytes& file, const std::string& text) {
  const auto same = [](std::uint8_t a, char b) { return a == static_cast<std::uint8_t>(b); };
  return static_cast<std::size_t>(std::search(file.begin(), file.end(), text.begin(), text.end(), same) - file.begin());
}

Bytes exr_file() {
  const std::vector<float> texels(8 * 4 * 4, 0.5f);
  return encode_texture(make_texture_float(8, 4, texels.data()), "light");
}

// The value of an attribute begins after its name, its type and a length of four bytes.
void put_u32(Bytes& file, std::size_t at, std::uint32_t value) {
  REQUIRE(at + 4 <= file.size());
  for (std::size_t i = 0; i < 4; ++i) file[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
}
constexpr std::size_t kWindowLength = 17;  // "dataWindow", "box2i", a zero after each

Bytes exr_with_window(std::uint32_t x_max, std::uint32_t y_max) {
  Bytes file = exr_file();
  const std::size_t value = place_of(file, std::string("dataWindow\0box2i", 16)) + kWindowLength + 4;
  put_u32(file, value + 8, x_max);
  put_u32(file, value + 12, y_max);
  return file;
}

}  // namespace

TEST_CASE("images: a PNG cannot hold more than deflate makes of its bytes", "[images]") {
  // One row of 40 bytes of data with its frame: 11 more. 258 bytes of two bits each are 1032 a byte.
  const auto promising = [](std::uint32_t height) {
    Bytes file = png(39, 1, 0, 8, Bytes(39, 0)), out(file.begin(), file.begin() + 8);
    Bytes header(file.begin() + 16, file.begin() + 29);
    for (int i = 0; i < 4; ++i)
      header[static_cast<std::size_t>(4 + i)] = static_cast<std::uint8_t>(height >> (24 - 8 * i));
    append_png_chunk(out, "IHDR", header);
    out.insert(out.end(), file.begin() + 33, file.end());
    return out;
  };
  CHECK(error_of(promising(1)) == "decoded");
  const std::uint32_t most = 51 * 1032 / 39;
  CHECK_THAT(error_of(promising(most)), Catch::Matchers::Contains("cannot be decoded"));  // tried
  CHECK_THAT(error_of(promising(most + 1)), Catch::Matchers::Contains("its 51 bytes of data cannot hold 39 x 1350"));
}

TEST_CASE("images: a PNG of a palette has it before its pixels", "[images]") {
  CHECK_THAT(error_of(png(2, 1, 3, 8, {0, 1})), Catch::Matchers::Contains("no palette"));
}

TEST_CASE("images: a JPEG has limits of size and of scans", "[images]") {
  Bytes file = read_whole_file(SHOAL_SOURCE_DIR "/tests/fuzz/corpus/image/rgb.jpg");
  REQUIRE(error_of(file) == "decoded");
  const std::size_t scan = place_of(file, "\xFF\xDA");
  SECTION("size") {
    const std::size_t frame = place_of(file, "\xFF\xC0");
    REQUIRE(frame < file.size());
    for (std::size_t i = 0; i < 4; ++i) file[frame + 5 + i] = i % 2 == 0 ? 0x7F : 0xFF;
    CHECK_THAT(error_of(file), Catch::Matchers::Contains("32767 x 32767 texels; expected 1 to 16384"));
  }
  SECTION("scans") {
    REQUIRE(scan < file.size());
    const Bytes once(file.begin() + static_cast<std::ptrdiff_t>(scan), file.end() - 2);
    for (int i = 0; i < 100; ++i) file.insert(file.end() - 2, once.begin(), once.end());
    CHECK_THAT(error_of(file), Catch::Matchers::Contains("101 scans; expected at most 100"));
  }
}

TEST_CASE("images: the header of an OpenEXR file is checked before its library reads it", "[images]") {
  const Bytes good = exr_file();
  REQUIRE(error_of(good) == "decoded");
  SECTION("any attribute longer than the file") {
    for (const char* type : {"box2i", "chlist", "float", "v2f"}) {
      Bytes file = good;
      put_u32(file, place_of(file, std::string(1, '\0') + type + '\0') + std::string(type).size() + 2, 0x7FFFFFF0);
      CHECK_THAT(error_of(file), Catch::Matchers::Contains("an attribute is longer than the file"));
    }
  }
  SECTION("an attribute whose type is longer than its length") {
    for (const char* type : {"box2i", "chlist", "float", "v2f"}) {
      Bytes file = good;
      const std::size_t at = place_of(file, std::string(1, '\0') + type + '\0') + std::string(type).size() + 2;
      put_u32(file, at, 0);
      CHECK_THAT(error_of(file), Catch::Matchers::Contains("not its type's"));
    }
  }
  SECTION("a window") {
    CHECK_THAT(error_of(exr_with_window(0x7FFFFFFF, 3)), Catch::Matchers::Contains("data window"));
    CHECK_THAT(error_of(exr_with_window(0xFFFFFFFF, 3)), Catch::Matchers::Contains("data window"));
    CHECK_THAT(error_of(exr_with_window(16384, 3)), Catch::Matchers::Contains("has 16385 x 4 texels"));
    CHECK_THAT(error_of(exr_with_window(16383, 16383)), Catch::Matchers::Contains("is cut short"));
  }
  SECTION("deep or of several parts") {
    Bytes file = good;
    file[5] = 0x10;
    CHECK_THAT(error_of(file), Catch::Matchers::Contains("several parts"));
  }
  SECTION("tiles") {
    Bytes file = good;
    file[5] = 0x02;
    CHECK_THAT(error_of(file), Catch::Matchers::Contains("tiles of 0 x 0"));
  }
  SECTION("cut anywhere") {
    for (std::size_t size = 0; size < good.size(); size += 5) {
      CHECK(error_of({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)}) != "decoded");
    }
  }
}

}  // namespace shoal::test
