// Pictures as environments: formats, limits, invalid numbers, and the cache on disk.
#include <catch2/catch.hpp>

#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/error.h"
#include "core/thread_pool.h"
#include "scene/gltf/gltf.h"
#include "scene/images/environment.h"
#include "scene/images/images.h"
#include "shading/environment/sample.h"

using namespace shoal;
namespace fs = std::filesystem;

namespace {

struct Folder {
  fs::path path = fs::temp_directory_path() / ("shoal_environment_" + std::to_string(getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() {
    std::error_code ec;
    fs::remove_all(path, ec);
  }
  std::string file(const std::string& name) const { return (path / name).string(); }
};

void write(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}
std::string read(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// A Radiance picture of 4 x 2 texels: red 1, green 0.5, blue 2 above; half of it below.
std::string small_hdr() {
  std::string bytes = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n";
  for (const int exponent : {131, 130}) {
    for (int x = 0; x < 4; ++x) bytes += std::string("\x20\x10\x40", 3) + static_cast<char>(exponent);
  }
  return bytes;
}

std::string float_picture(const std::vector<float>& rgba, int width, int height) {
  const auto bytes = encode_texture(make_texture_float(width, height, rgba.data()), "test");
  return {bytes.begin(), bytes.end()};
}

Vec3f seen(const Environment& e, Vec3f d) {
  Vec3f out;
  environment_radiance<float>(e, d, out);
  return out;
}

bool same(const Environment& a, const Environment& b) {
  return a.texels == b.texels && a.lobe == b.lobe && a.scale == b.scale &&
         std::memcmp(a.size, b.size, sizeof a.size) == 0 &&
         std::memcmp(a.first_texel, b.first_texel, sizeof a.size) == 0 &&
         std::memcmp(a.irradiance, b.irradiance, sizeof a.irradiance) == 0;
}

}  // namespace

TEST_CASE("environment file: HDR, EXR and PNG are read as light") {
  const Folder folder;
  ThreadPool pool(2);
  std::string warning;
  write(folder.file("a.hdr"), small_hdr());
  const auto hdr = load_environment(folder.file("a.hdr"), "", pool, warning);
  CHECK(warning.empty());
  CHECK(seen(*hdr, {0.1f, 1, 0}).x == Approx(1).epsilon(0.01));
  CHECK(seen(*hdr, {0.1f, 1, 0}).z == Approx(2).epsilon(0.01));
  CHECK(seen(*hdr, {0.1f, -1, 0}).y == Approx(0.25).epsilon(0.01));

  write(folder.file("a.exr"), float_picture({-1, 4, 0.5f, 1, 7, 4, 0.5f, 1}, 2, 1));
  const auto exr = load_environment(folder.file("a.exr"), "", pool, warning);
  CHECK(warning.find("1 texels are negative") != std::string::npos);
  CHECK(seen(*exr, {1, 1, 3}).y == Approx(4).epsilon(0.001));
  CHECK(seen(*exr, {0, 0, -1}).x == Approx(0).margin(0.08));
  CHECK(seen(*exr, {0, 0, 1}).x == Approx(7).margin(0.08));

  const std::uint8_t grey[4] = {128, 255, 0, 255};
  const auto png = encode_texture(make_texture_rgba8(1, 1, grey, true), "test");
  write(folder.file("a.png"), {png.begin(), png.end()});
  const auto sky = load_environment(folder.file("a.png"), "", pool, warning);
  CHECK(warning.empty());
  CHECK(seen(*sky, {1, 2, 3}).x == Approx(std::pow((128 / 255.0 + 0.055) / 1.055, 2.4)).epsilon(0.001));
  CHECK(seen(*sky, {1, 2, 3}).y == Approx(1).epsilon(0.001));
}

TEST_CASE("environment file: what is no picture is one line") {
  const Folder folder;
  ThreadPool pool(1);
  std::string warning;
  const auto message = [&](const std::string& path) -> std::string {
    try {
      load_environment(path, "", pool, warning);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  CHECK(message(folder.file("none.hdr")) == folder.file("none.hdr") + ": cannot be opened; expected an image file");
  write(folder.file("text.hdr"), "hello");
  CHECK(message(folder.file("text.hdr")).find("no image of a known format; expected PNG") != std::string::npos);
  const std::string hdr = small_hdr();
  write(folder.file("cut.hdr"), hdr.substr(0, hdr.size() - 5));
  CHECK(message(folder.file("cut.hdr")).find("cannot be decoded") != std::string::npos);
  write(folder.file("huge.hdr"), "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 9000 +X 9000\n");
  CHECK(message(folder.file("huge.hdr")).find("9000 x 9000 texels; expected 1 to 8192") != std::string::npos);
  write(folder.file("large.hdr"), "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8000 +X 8000\n");
  CHECK(message(folder.file("large.hdr")).find("expected at most 33554432 in all") != std::string::npos);
}

TEST_CASE("environment file: the cache changes nothing, and what is wrong in it is made anew") {
  const Folder folder;
  ThreadPool pool(2);
  std::string warning;
  const std::string picture = folder.file("a.hdr"), cache = folder.file("deep/cache");
  write(picture, small_hdr());
  const auto plain = load_environment(picture, "", pool, warning);
  CHECK_FALSE(fs::exists(cache));
  const auto first = load_environment(picture, cache, pool, warning);
  CHECK(same(*plain, *first));
  REQUIRE(std::distance(fs::directory_iterator(cache), fs::directory_iterator()) == 1);
  const std::string kept = fs::directory_iterator(cache)->path().string(), bytes = read(kept);
  CHECK(same(*plain, *load_environment(picture, cache, pool, warning)));
  CHECK(read(kept) == bytes);

  // Cut short, one bit turned, of another picture, empty: each is replaced by the right one.
  std::string turned = bytes, foreign = bytes;
  turned[bytes.size() / 2] = static_cast<char>(turned[bytes.size() / 2] ^ 4);
  foreign[25] = foreign[25] == '0' ? '1' : '0';  // in the key
  for (const std::string& bad :
       {bytes.substr(0, bytes.size() - 1), bytes.substr(0, 40), turned, foreign, std::string()}) {
    write(kept, bad);
    CHECK(same(*plain, *load_environment(picture, cache, pool, warning)));
    CHECK(read(kept) == bytes);
  }
  // Another picture has a file of its own.
  std::string brighter = small_hdr();
  brighter.back() = static_cast<char>(135);
  write(picture, brighter);
  CHECK_FALSE(same(*plain, *load_environment(picture, cache, pool, warning)));
  CHECK(std::distance(fs::directory_iterator(cache), fs::directory_iterator()) == 2);
  // A folder that cannot be: a file stands there.
  write(folder.file("file"), "x");
  write(picture, small_hdr());
  CHECK(same(*plain, *load_environment(picture, folder.file("file") + "/below", pool, warning)));
}

// Opening a FIFO that has no writer would wait for ever.
TEST_CASE("environment file: a FIFO and a folder are refused") {
  const Folder folder;
  ThreadPool pool(1);
  std::string warning;
  REQUIRE(mkfifo(folder.file("fifo.hdr").c_str(), 0600) == 0);
  fs::create_directory(folder.file("folder.hdr"));
  for (const char* name : {"fifo.hdr", "folder.hdr"}) {
    CHECK_THROWS_WITH(load_environment(folder.file(name), "", pool, warning),
                      folder.file(name) + ": is no regular file; expected an image file");
  }
}

TEST_CASE("environment file: a scene names one beside it, and only there") {
  const Folder folder;
  const auto load = [&](const std::string& extras) {
    const std::string path = folder.file("scene.gltf");
    write(path,
          R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"extras": {"environment": )" + extras + "}}]}");
    return load_gltf(path).environment_file;
  };
  const auto message = [&](const std::string& extras) -> std::string {
    try {
      load(extras);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  write(folder.file("sky high.hdr"), small_hdr());
  CHECK(fs::equivalent(load("\"sky%20high.hdr\""), folder.file("sky high.hdr")));
  CHECK(message("\"none.hdr\"").find("scenes[0].extras.environment is missing") != std::string::npos);
  CHECK(message("\"../sky.hdr\"").find("without '..'") != std::string::npos);
  CHECK(message("\"/etc/passwd\"").find("relative path") != std::string::npos);
  CHECK(message("\"https://example.org/sky.hdr\"").find("expected a file") != std::string::npos);
  for (const char* wrong : {"7", "\"\"", "\"data:image/png;base64,AAAA\"", "[1]"})
    CHECK(message(wrong).find("extras.environment is wrong; expected the URI") != std::string::npos);
}
