#include "scene/images/exr.h"

#include <algorithm>

#include "core/error.h"

namespace shoal {
namespace {

using Bytes = std::span<const std::uint8_t>;

[[noreturn]] void fail(const std::string& name, const std::string& what,
                       const std::string& expected = "expected a whole OpenEXR file") {
  throw Error(name + ": " + what + "; " + expected);
}

std::uint32_t read_u32(Bytes bytes, std::size_t at) {
  return static_cast<std::uint32_t>(bytes[at]) | static_cast<std::uint32_t>(bytes[at + 1]) << 8 |
         static_cast<std::uint32_t>(bytes[at + 2]) << 16 | static_cast<std::uint32_t>(bytes[at + 3]) << 24;
}

// Returns the length of a zero-terminated string. Throws Error where it does not end.
std::size_t string_length(Bytes file, std::size_t at, const std::string& name) {
  constexpr std::size_t kMaxName = 255;
  std::size_t length = 0;
  while (at + length < file.size() && file[at + length] != 0) {
    if (++length > kMaxName) fail(name, "is damaged (a name in its header does not end)");
  }
  if (at + length >= file.size()) fail(name, "is cut short");
  return length;
}

// The number of lines in a chunk by compression: none, RLE, ZIPS, ZIP, PIZ, PXR24, B44, B44A, DWAA, DWAB.
constexpr std::uint64_t kLinesInChunk[] = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};

// Types whose value the library reads by the size of the type, not by the length that the file gives.
struct FixedType {
  const char* name;
  std::size_t size;
};
constexpr FixedType kFixedTypes[] = {
    {"box2f", 16},
    {"box2i", 16},
    {"chromaticities", 32},
    {"compression", 1},
    {"deepImageState", 1},
    {"double", 8},
    {"envmap", 1},
    {"float", 4},
    {"int", 4},
    {"keycode", 28},
    {"lineOrder", 1},
    {"m33d", 72},
    {"m33f", 36},
    {"m44d", 128},
    {"m44f", 64},
    {"rational", 8},
    {"tiledesc", 9},
    {"timecode", 8},
    {"v2d", 16},
    {"v2f", 8},
    {"v2i", 8},
    {"v3d", 24},
    {"v3f", 12},
    {"v3i", 12},
};

// Checks a list of names, each followed by 16 bytes and the last one empty.
bool is_channel_list(Bytes data, const std::string& name) {
  std::size_t at = 0;
  while (at < data.size() && data[at] != 0) {
    at += string_length(data, at, name) + 1;
    if (data.size() - at < 16) return false;
    at += 16;
  }
  return at + 1 == data.size();
}

// Checks a list of lengths, each followed by as many bytes.
bool is_string_vector(Bytes data) {
  std::size_t at = 0;
  while (data.size() - at >= 4) {
    const std::size_t length = read_u32(data, at);
    at += 4;
    if (length > data.size() - at) return false;
    at += length;
  }
  return at == data.size();
}

bool is_preview(Bytes data) {
  if (data.size() < 8) return false;
  const std::uint64_t width = read_u32(data, 0), height = read_u32(data, 4);
  return width <= data.size() && height <= data.size() && width * height * 4 == data.size() - 8;
}

// Returns false where the library would read beyond the end of the value. It reads strings and unknown types by their
// length.
bool has_its_size(const std::string& type, Bytes data, const std::string& name) {
  if (type == "chlist") return is_channel_list(data, name);
  if (type == "stringvector") return is_string_vector(data);
  if (type == "preview") return is_preview(data);
  if (type == "idmanifest") return false;  // compressed; its decoded size is not bounded
  const auto* fixed =
      std::find_if(std::begin(kFixedTypes), std::end(kFixedTypes), [&](const FixedType& t) { return type == t.name; });
  return fixed == std::end(kFixedTypes) || fixed->size == data.size();
}

struct Header {
  std::uint64_t width = 0, height = 0;
  std::uint64_t tile_width = 0, tile_height = 0;
  std::size_t compression = std::size(kLinesInChunk);
  bool has_channels = false;
};

// Reads the data window xMin, yMin, xMax, yMax, which includes both ends.
void read_window(Bytes data, const std::string& name, Header& header) {
  if (data.size() != 16) fail(name, "is damaged (its data window)");
  const auto side = [&](std::size_t at) {
    const auto low = static_cast<std::int32_t>(read_u32(data, at));
    const auto high = static_cast<std::int32_t>(read_u32(data, at + 8));
    constexpr std::int32_t kFar = 1 << 28;
    if (low > high || low < -kFar || high > kFar) fail(name, "is damaged (its data window)");
    return static_cast<std::uint64_t>(high - low) + 1;
  };
  header.width = side(0);
  header.height = side(4);
}

void read_attribute(const std::string& attribute, Bytes data, const std::string& name, Header& header) {
  if (attribute == "dataWindow") {
    read_window(data, name, header);
  } else if (attribute == "tiles") {
    if (data.size() != 9) fail(name, "is damaged (its tiles)");
    header.tile_width = read_u32(data, 0);
    header.tile_height = read_u32(data, 4);
  } else if (attribute == "compression") {
    if (data.size() != 1 || data[0] >= std::size(kLinesInChunk)) fail(name, "has a compression that is not known");
    header.compression = data[0];
  } else if (attribute == "channels") {
    header.has_channels = data.size() > 1;
  }
}

void check_sizes(const Header& header, bool tiled, std::size_t left, const std::string& name,
                 const ImageLimits& limits) {
  const auto most = static_cast<std::uint64_t>(limits.max_size);
  if (header.width > most || header.height > most || header.width * header.height > limits.max_texels) {
    fail(name, "has " + std::to_string(header.width) + " x " + std::to_string(header.height) + " texels",
         "expected 1 to " + std::to_string(limits.max_size) + " in width and height, and at most " +
             std::to_string(limits.max_texels) + " in all");
  }
  std::uint64_t chunks = 0;
  if (tiled) {
    const std::uint64_t w = header.tile_width, h = header.tile_height;
    if (w < 1 || h < 1 || w > most || h > most || w * h > limits.max_texels) {
      fail(name, "has tiles of " + std::to_string(w) + " x " + std::to_string(h) + " texels",
           "expected tiles no larger than the largest image");
    }
    chunks = ((header.width + w - 1) / w) * ((header.height + h - 1) / h);
  } else {
    const std::uint64_t lines = kLinesInChunk[header.compression];
    chunks = (header.height + lines - 1) / lines;
  }
  // A chunk needs eight bytes in the table of offsets and at least eight of its own.
  if (chunks * 16 > left) fail(name, "is cut short");
}

}  // namespace

void check_exr_header(Bytes file, const std::string& name, const ImageLimits& limits) {
  if (file.size() < 9) fail(name, "is cut short");
  const std::uint32_t version = read_u32(file, 4);
  constexpr std::uint32_t kTiled = 0x200, kLongNames = 0x400, kDeep = 0x800, kParts = 0x1000;
  if ((version & 0xFFu) != 2 || (version & ~(0xFFu | kTiled | kLongNames | kDeep | kParts)) != 0) {
    fail(name, "is of an OpenEXR version that is not known", "expected version 2");
  }
  if ((version & (kDeep | kParts)) != 0) fail(name, "has deep pixels or several parts", "expected one flat picture");

  Header header;
  std::size_t at = 8;
  const auto next_string = [&] {
    const std::size_t length = string_length(file, at, name);
    const std::string text(reinterpret_cast<const char*>(&file[at]), length);
    at += length + 1;
    return text;
  };
  for (std::string attribute = next_string(); !attribute.empty(); attribute = next_string()) {
    const std::string type = next_string();
    if (file.size() - at < 4) fail(name, "is cut short");
    const std::size_t size = read_u32(file, at);
    at += 4;
    if (size > file.size() - at) fail(name, "is damaged (an attribute is longer than the file)");
    const Bytes data = file.subspan(at, size);
    if (!has_its_size(type, data, name)) fail(name, "is damaged (an attribute has a size that is not its type's)");
    read_attribute(attribute, data, name, header);
    at += size;
  }
  const bool complete = header.width != 0 && header.has_channels && header.compression < std::size(kLinesInChunk);
  if (!complete) fail(name, "is damaged (its header lacks a window, channels or compression)");
  check_sizes(header, (version & kTiled) != 0, file.size() - at, name, limits);
}

}  // namespace shoal
