// Checks and strips PNG files before a library reads them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace shoal {

// Returns a PNG with only the chunks that hold pixels: IHDR, PLTE, tRNS, IDAT, IEND.
//
// Checks structure, header fields and every checksum, because libpng writes messages of its own to standard error.
// Gamma, colour profile and text chunks are dropped: colours are sRGB, as glTF requires.
// Throws Error ("NAME: what; expected").
// Source: W3C, Portable Network Graphics (2nd edition), 5 and 11.
std::vector<std::uint8_t> png_pixels_only(std::span<const std::uint8_t> file, const std::string& name);

}  // namespace shoal
