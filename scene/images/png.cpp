#include "scene/images/png.h"

#include <array>
#include <cstring>

#include "core/error.h"

namespace shoal {
namespace {

using Bytes = std::span<const std::uint8_t>;

[[noreturn]] void fail(const std::string& name, const std::string& what) {
  throw Error(name + ": " + what + "; expected a whole PNG");
}

std::uint32_t read_u32(Bytes bytes, std::size_t at) {
  return static_cast<std::uint32_t>(bytes[at]) << 24 | static_cast<std::uint32_t>(bytes[at + 1]) << 16 |
         static_cast<std::uint32_t>(bytes[at + 2]) << 8 | static_cast<std::uint32_t>(bytes[at + 3]);
}

constexpr std::array<std::uint32_t, 256> make_crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t n = 0; n < 256; ++n) {
    std::uint32_t c = n;
    for (int bit = 0; bit < 8; ++bit) c = (c & 1u) != 0 ? 0xEDB88320u ^ (c >> 1) : c >> 1;
    table[n] = c;
  }
  return table;
}
constexpr std::array<std::uint32_t, 256> kCrcTable = make_crc_table();

// The checksum of a chunk. Source: the specification's annex D.
std::uint32_t crc_of(Bytes bytes) {
  std::uint32_t crc = 0xFFFFFFFFu;
  for (const std::uint8_t byte : bytes) crc = kCrcTable[(crc ^ byte) & 0xFFu] ^ (crc >> 8);
  return ~crc;
}

bool is(Bytes type, const char* name) { return std::memcmp(type.data(), name, 4) == 0; }

// Checks the bit depth for the colour type, and the other fields. Source: the specification, 11.2.2.
void check_header(Bytes data, const std::string& name) {
  if (data.size() != 13) fail(name, "has a header of the wrong size");
  const std::string size = std::to_string(read_u32(data, 0)) + " x " + std::to_string(read_u32(data, 4));
  if (read_u32(data, 0) == 0 || read_u32(data, 4) == 0) fail(name, "has " + size + " texels");
  const int depth = data[8], color = data[9];
  const bool deep = depth == 8 || depth == 16, shallow = depth == 1 || depth == 2 || depth == 4;
  const bool ok = (color == 0 && (deep || shallow)) || (color == 3 && (shallow || depth == 8)) ||
                  ((color == 2 || color == 4 || color == 6) && deep);
  if (!ok || data[10] != 0 || data[11] != 0 || data[12] > 1) fail(name, "has a header with invalid fields");
}

// Checks that the compressed data can hold the pixels: Deflate expands two bits to at most 258 bytes.
void check_compressed_size(Bytes header, std::size_t data_bytes, const std::string& name) {
  constexpr double kMostOfAByte = 258.0 * 8 / 2;
  constexpr int kChannels[] = {1, 0, 3, 1, 2, 0, 4};
  const double texels = static_cast<double>(read_u32(header, 0)) * read_u32(header, 4);
  if (texels * kChannels[header[9]] * header[8] / 8 > kMostOfAByte * static_cast<double>(data_bytes)) {
    fail(name, "is cut short (its " + std::to_string(data_bytes) + " bytes of data cannot hold " +
                   std::to_string(read_u32(header, 0)) + " x " + std::to_string(read_u32(header, 4)) + " texels)");
  }
}

}  // namespace

std::vector<std::uint8_t> png_pixels_only(Bytes file, const std::string& name) {
  constexpr std::size_t kSignature = 8;
  if (file.size() < kSignature) fail(name, "is cut short");
  std::vector<std::uint8_t> kept;
  kept.reserve(file.size());
  kept.assign(file.data(), file.data() + kSignature);
  std::size_t data_bytes = 0;
  bool has_palette = false;
  for (std::size_t at = kSignature; file.size() - at >= 12;) {
    const std::size_t length = read_u32(file, at);
    if (length > file.size() - at - 12) break;
    const Bytes type = file.subspan(at + 4, 4), data = file.subspan(at + 8, length);
    if (crc_of(file.subspan(at + 4, length + 4)) != read_u32(file, at + 8 + length)) {
      fail(name, "is damaged (a checksum is wrong)");
    }
    const bool first = at == kSignature;
    if (first != is(type, "IHDR")) fail(name, "is damaged (its header is not where it belongs)");
    if (first) check_header(data, name);
    const bool critical = (type[0] & 0x20u) == 0;
    const bool known = first || is(type, "PLTE") || is(type, "IDAT") || is(type, "IEND");
    if (critical && !known) fail(name, "has a critical chunk that is not known");
    const Bytes chunk = file.subspan(at, length + 12);
    if (known || is(type, "tRNS")) kept.insert(kept.end(), chunk.begin(), chunk.end());
    has_palette = has_palette || is(type, "PLTE");
    if (is(type, "IDAT")) {
      if (file[kSignature + 8 + 9] == 3 && !has_palette) fail(name, "has no palette before its pixels");
      data_bytes += length;
    }
    if (is(type, "IEND")) {
      if (data_bytes == 0) fail(name, "holds no pixels");
      check_compressed_size(file.subspan(kSignature + 8, 13), data_bytes, name);
      return kept;
    }
    at += length + 12;
  }
  fail(name, "is cut short");
}

}  // namespace shoal
