#include "scene/images/images.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string_view>

#include "core/error.h"
#include "scene/images/exr.h"
#include "scene/images/png.h"
#include "shading/srgb.h"

namespace shoal {
namespace {

using Encoded = std::span<const std::uint8_t>;

[[noreturn]] void fail(const std::string& name, const std::string& what, const std::string& expected) {
  throw Error(name + ": " + what + "; " + expected);
}

// Joins the lines of OpenImageIO's messages.
std::string on_one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text.size() > 200 ? text.substr(0, 200) + "..." : text;
}

bool starts_with(Encoded bytes, std::initializer_list<int> magic) {
  return bytes.size() >= magic.size() &&
         std::equal(magic.begin(), magic.end(), bytes.begin(), [](int a, std::uint8_t b) { return a == b; });
}

enum class Format { kPng, kJpeg, kHdr, kExr };

// Only these four of OpenImageIO's readers are used.
Format format_of(Encoded bytes, const std::string& name) {
  if (starts_with(bytes, {0x89, 'P', 'N', 'G', 0x0D, 0x0A, 0x1A, 0x0A})) return Format::kPng;
  if (starts_with(bytes, {0xFF, 0xD8, 0xFF})) return Format::kJpeg;
  if (starts_with(bytes, {'#', '?'})) return Format::kHdr;
  if (starts_with(bytes, {0x76, 0x2F, 0x31, 0x01})) return Format::kExr;
  fail(name, bytes.empty() ? "is empty" : "is no image of a known format",
       "expected PNG, JPEG, Radiance HDR or OpenEXR");
}

const char* reader_name(Format format) {
  switch (format) {
    case Format::kPng:
      return "png";
    case Format::kJpeg:
      return "jpeg";
    case Format::kHdr:
      return "hdr";
    case Format::kExr:
      return "openexr";
  }
  return "";
}

// Checks that a JPEG is complete, because libjpeg fills missing data with grey and reports success: every segment up to
// the end marker is there.
//   scans  receives the number of scans; each scan of a progressive JPEG can be as short as 12 bytes and is a pass over
//          the whole picture
// Source: ITU-T T.81, annex B.
bool jpeg_has_end(Encoded bytes, int& scans) {
  std::size_t at = 2;
  scans = 0;
  while (at + 1 < bytes.size()) {
    if (bytes[at] != 0xFF) return false;
    const int marker = bytes[at + 1];
    if (marker == 0xD9) return true;
    if (marker == 0xFF) {  // fill
      ++at;
      continue;
    }
    at += 2;
    if ((marker >= 0xD0 && marker <= 0xD7) || marker == 0x01) continue;  // no parameters
    if (at + 2 > bytes.size()) return false;
    at += static_cast<std::size_t>(bytes[at]) << 8 | bytes[at + 1];
    if (marker != 0xDA) continue;
    ++scans;
    // Coded data end at a marker that is neither a stuffed zero nor a restart.
    const auto is_data = [&](int next) { return next == 0 || (next >= 0xD0 && next <= 0xD7); };
    while (at + 1 < bytes.size() && (bytes[at] != 0xFF || is_data(bytes[at + 1]))) ++at;
  }
  return false;
}

void check_jpeg(Encoded bytes, const std::string& name) {
  constexpr int kMaxScans = 100;
  int scans = 0;
  if (!jpeg_has_end(bytes, scans)) fail(name, "is cut short or damaged", "expected a whole JPEG");
  if (scans > kMaxScans) {
    fail(name, "has " + std::to_string(scans) + " scans", "expected at most " + std::to_string(kMaxScans));
  }
}

// Reads from memory with bounds checks. The library's own proxy accepts any position that a damaged file names.
class BoundedMemory final : public OIIO::Filesystem::IOMemReader {
 public:
  using IOMemReader::IOMemReader;
  bool seek(std::int64_t offset) override { return holds(offset) && IOMemReader::seek(offset); }
  std::size_t read(void* to, std::size_t bytes) override { return holds(m_pos) ? IOMemReader::read(to, bytes) : 0; }
  std::size_t pread(void* to, std::size_t bytes, std::int64_t offset) override {
    return holds(offset) ? IOMemReader::pread(to, bytes, offset) : 0;
  }

 private:
  bool holds(std::int64_t offset) const { return offset >= 0 && static_cast<std::uint64_t>(offset) <= size(); }
};

struct Reader {
  Reader(Encoded bytes, const std::string& name_in, const ImageLimits& limits)
      : name(name_in),
        format(format_of(bytes, name)),
        png(format == Format::kPng ? png_pixels_only(bytes, name) : std::vector<std::uint8_t>()),
        memory(png.empty() ? bytes.data() : png.data(), png.empty() ? bytes.size() : png.size()) {
    if (format == Format::kJpeg) check_jpeg(bytes, name);
    if (format == Format::kExr) check_exr_header(bytes, name, limits);
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    input = OIIO::ImageInput::create(reader_name(format));
    if (!input) fail(name, "cannot be decoded (" + on_one_line(OIIO::geterror()) + ")", "expected OpenImageIO with it");
    OIIO::ImageSpec header;
    if (!input->set_ioproxy(&memory) || !input->open("memory", header, config)) {
      fail(name, "cannot be decoded (" + on_one_line(input->geterror()) + ")", "expected a whole image");
    }
  }
  const OIIO::ImageSpec& spec() const { return input->spec(); }

  std::string name;
  Format format;
  std::vector<std::uint8_t> png;  // checked and stripped
  BoundedMemory memory;
  std::unique_ptr<OIIO::ImageInput> input;
};

ImageSize checked_size(const Reader& reader, const ImageLimits& limits) {
  const OIIO::ImageSpec& spec = reader.spec();
  const std::string size = std::to_string(spec.width) + " x " + std::to_string(spec.height);
  if (spec.width < 1 || spec.height < 1 || spec.width > limits.max_size || spec.height > limits.max_size) {
    fail(reader.name, "has " + size + " texels",
         "expected 1 to " + std::to_string(limits.max_size) + " in width and height");
  }
  const std::uint64_t texels = static_cast<std::uint64_t>(spec.width) * static_cast<std::uint64_t>(spec.height);
  if (texels > limits.max_texels) {
    fail(reader.name, "has " + size + " texels", "expected at most " + std::to_string(limits.max_texels) + " in all");
  }
  if (spec.deep || spec.depth > 1 || spec.nchannels < 1) {
    fail(reader.name, "is no flat image", "expected one layer of colours");
  }
  return {spec.width, spec.height, reader.format == Format::kHdr || reader.format == Format::kExr};
}

// The channel numbers of red, green, blue and alpha; -1 for a missing one.
struct ChannelMap {
  int r = 0, g = 0, b = 0, a = -1;
};
ChannelMap channel_map(const OIIO::ImageSpec& spec, int channels) {
  const int alpha = spec.alpha_channel >= 0 && spec.alpha_channel < channels ? spec.alpha_channel : -1;
  const int colors = channels - (alpha >= 0 ? 1 : 0);
  if (colors < 3) return {0, 0, 0, alpha};
  return {0, 1, 2, alpha};
}

template <class T>
std::vector<T> read_channels(Reader& reader, int channels, OIIO::TypeDesc type) {
  const OIIO::ImageSpec& spec = reader.spec();
  const std::size_t row = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(channels);
  const std::size_t all = row * static_cast<std::size_t>(spec.height);
  std::vector<T> values;
  values.reserve(all);
  bool ok = true;
  if (spec.tile_width != 0) {
    values.resize(all);
    ok = reader.input->read_image(0, 0, 0, channels, type, values.data());
  } else {
    // Reading in bands keeps a small file with a large size in its header from touching much memory before it fails.
    constexpr int kBand = 256;  // rows; a multiple of the lines in a chunk for every compression of OpenEXR
    for (int y = 0; ok && y < spec.height; y += kBand) {
      const int rows = std::min(kBand, spec.height - y);
      const std::size_t first = values.size();
      values.resize(first + static_cast<std::size_t>(rows) * row);
      const int y0 = spec.y + y;
      ok = reader.input->read_scanlines(0, 0, y0, y0 + rows, 0, 0, channels, type, &values[first]);
    }
  }
  if (!ok) {
    fail(reader.name, "cannot be decoded (" + on_one_line(reader.input->geterror()) + ")", "expected a whole image");
  }
  return values;
}

// Expands an image to RGBA; `convert` converts one channel value.
template <class To, class From, class Convert>
std::vector<To> to_rgba(const std::vector<From>& from, std::size_t channels, const ChannelMap& map, To opaque,
                        Convert convert) {
  const std::size_t texels = from.size() / channels;
  std::vector<To> rgba(texels * 4);
  for (std::size_t i = 0; i < texels; ++i) {
    const From* texel = &from[i * channels];
    rgba[4 * i] = convert(texel[map.r]);
    rgba[4 * i + 1] = convert(texel[map.g]);
    rgba[4 * i + 2] = convert(texel[map.b]);
    rgba[4 * i + 3] = map.a < 0 ? opaque : convert(texel[map.a]);
  }
  return rgba;
}

float tamed(float value) {
  if (std::isnan(value)) return 0;
  return std::clamp(value, -1e9f, 1e9f);
}

// Rounds 16 bits to the nearest 8-bit value, ties up: 257 steps of 16 bits are one step of 8 bits.
std::uint8_t rounded_to_8_bits(std::uint16_t value) {
  return static_cast<std::uint8_t>((static_cast<std::uint32_t>(value) + 128u) / 257u);
}

void write_or_fail(std::unique_ptr<OIIO::ImageOutput> out, const OIIO::ImageSpec& spec, OIIO::Filesystem::IOProxy& sink,
                   OIIO::TypeDesc type, const void* texels, const std::string& name) {
  const std::string why = out ? "" : OIIO::geterror();
  if (!out || !out->set_ioproxy(&sink) || !out->open("memory", spec) || !out->write_image(type, texels) ||
      !out->close()) {
    fail(name, "cannot be encoded (" + on_one_line(out ? out->geterror() : why) + ")",
         "expected OpenImageIO with PNG and OpenEXR");
  }
}

}  // namespace

ImageSize image_size(Encoded encoded, const std::string& name, const ImageLimits& limits) {
  return checked_size(Reader(encoded, name, limits), limits);
}

Texture decode_texture(Encoded encoded, const std::string& name, bool srgb, const ImageLimits& limits) {
  Reader reader(encoded, name, limits);
  const ImageSize size = checked_size(reader, limits);
  const int channels = std::min(reader.spec().nchannels, 4);
  const ChannelMap map = channel_map(reader.spec(), channels);
  const auto count = static_cast<std::size_t>(channels);
  if (size.is_float) {
    const std::vector<float> values = read_channels<float>(reader, channels, OIIO::TypeDesc::FLOAT);
    const std::vector<float> rgba = to_rgba<float>(values, count, map, 1.0f, tamed);
    return make_texture_float(size.width, size.height, rgba.data());
  }
  std::vector<std::uint8_t> rgba;
  if (reader.spec().format == OIIO::TypeDesc::UINT16) {
    const std::vector<std::uint16_t> values = read_channels<std::uint16_t>(reader, channels, OIIO::TypeDesc::UINT16);
    rgba = to_rgba<std::uint8_t>(values, count, map, std::uint8_t{255}, rounded_to_8_bits);
  } else {
    const std::vector<std::uint8_t> values = read_channels<std::uint8_t>(reader, channels, OIIO::TypeDesc::UINT8);
    rgba = to_rgba<std::uint8_t>(values, count, map, std::uint8_t{255}, [](std::uint8_t v) { return v; });
  }
  return make_texture_rgba8(size.width, size.height, rgba.data(), srgb);
}

std::vector<std::uint8_t> read_image_file(const std::string& path) {
  std::error_code ec;
  const std::filesystem::file_status status = std::filesystem::status(path, ec);
  if (ec || status.type() == std::filesystem::file_type::not_found)
    fail(path, "cannot be opened", "expected an image file");
  // Opening a FIFO would wait for its writer, and a device has no end.
  if (status.type() != std::filesystem::file_type::regular) fail(path, "is no regular file", "expected an image file");
  const std::uint64_t size = std::filesystem::file_size(path, ec);
  std::ifstream in(path, std::ios::binary);
  if (ec || !in) fail(path, "cannot be opened", "expected an image file");
  if (size > std::uint64_t{4} << 30) fail(path, "has " + std::to_string(size) + " bytes", "expected at most 4 GiB");
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (static_cast<std::uint64_t>(in.gcount()) != size)
    fail(path, "cannot be read to its end", "expected an image file");
  constexpr std::string_view kLfsPointer = "version https://git-lfs.github.com/spec/";
  if (bytes.size() >= kLfsPointer.size() && std::equal(kLfsPointer.begin(), kLfsPointer.end(), bytes.begin()))
    fail(path, "is a Git LFS pointer, not the file itself", "expected the file that `git lfs pull` fetches");
  return bytes;
}

Texture load_texture(const std::string& path, bool srgb, const ImageLimits& limits) {
  return decode_texture(read_image_file(path), path, srgb, limits);
}

LinearImage decode_linear(Encoded encoded, const std::string& name, const ImageLimits& limits) {
  Reader reader(encoded, name, limits);
  const ImageSize size = checked_size(reader, limits);
  const int channels = std::min(reader.spec().nchannels, 4);
  const ChannelMap map = channel_map(reader.spec(), channels);
  const auto count = static_cast<std::size_t>(channels);
  LinearImage image{size.width, size.height, {}};
  const auto convert = [&](const auto& values, auto to_linear) {
    const std::size_t texels = values.size() / count;
    image.rgb.resize(texels * 3);
    for (std::size_t i = 0; i < texels; ++i) {
      const int channel[3] = {map.r, map.g, map.b};
      for (std::size_t c = 0; c < 3; ++c)
        image.rgb[3 * i + c] = to_linear(values[i * count + static_cast<std::size_t>(channel[c])]);
    }
  };
  // A table of linear light for all 16-bit codes. An 8-bit code repeated gives its 16-bit code.
  const auto decoded_codes = [](std::size_t codes) {
    std::vector<float> table(codes);
    for (std::size_t i = 0; i < codes; ++i)
      table[i] = static_cast<float>(srgb_to_linear(static_cast<double>(i) / static_cast<double>(codes - 1)));
    return table;
  };
  if (size.is_float) {
    convert(read_channels<float>(reader, channels, OIIO::TypeDesc::FLOAT), [](float v) { return v; });
  } else if (reader.spec().format == OIIO::TypeDesc::UINT16) {
    const std::vector<float> table = decoded_codes(65536);
    convert(read_channels<std::uint16_t>(reader, channels, OIIO::TypeDesc::UINT16),
            [&](std::uint16_t v) { return table[v]; });
  } else {
    const std::vector<float> table = decoded_codes(256);
    convert(read_channels<std::uint8_t>(reader, channels, OIIO::TypeDesc::UINT8),
            [&](std::uint8_t v) { return table[v]; });
  }
  return image;
}

std::vector<std::uint8_t> encode_texture(const Texture& texture, const std::string& name) {
  if (texture.level_count < 1) fail(name, "has no texels", "expected a texture with its level 0");
  const int width = texture.width[0], height = texture.height[0];
  std::vector<unsigned char> file;
  OIIO::Filesystem::IOVecOutput sink(file);
  if (texture.format != TexelFormat::kRgba32Float) {
    const std::vector<std::uint8_t> rgba = texture_bytes(texture);
    OIIO::ImageSpec spec(width, height, 4, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:UnassociatedAlpha", 1);  // otherwise colours are divided by alpha
    write_or_fail(OIIO::ImageOutput::create("image.png"), spec, sink, OIIO::TypeDesc::UINT8, rgba.data(), name);
    return file;
  }
  // A texture stores one more texel at the end of each row.
  const auto row = static_cast<std::size_t>(width) * 4;
  std::vector<float> rgba(row * static_cast<std::size_t>(height));
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
    const float* from = &texture.rgba32f[static_cast<std::size_t>(texture.first_texel[0]) * 4 + y * (row + 4)];
    std::copy(from, from + row, &rgba[y * row]);
  }
  OIIO::ImageSpec spec(width, height, 4, OIIO::TypeDesc::FLOAT);
  spec.attribute("DateTime", "1970:01:01 00:00:00");  // otherwise the writer stores the current time
  spec.attribute("compression", "zip");
  write_or_fail(OIIO::ImageOutput::create("image.exr"), spec, sink, OIIO::TypeDesc::FLOAT, rgba.data(), name);
  return file;
}

}  // namespace shoal
