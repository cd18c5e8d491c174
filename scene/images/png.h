// PNG files, checked and stripped before a library sees them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace shoal {

// A PNG with only the chunks that hold pixels: IHDR, PLTE, tRNS, IDAT, IEND.
//
// Structure, header fields and every checksum are checked, because libpng writes its own lines to standard error for
// what it finds. Gamma, colour profile and text chunks are left out: colours are taken as sRGB, as glTF says.
// Throws Error ("NAME: what; expected"). Source: W3C, Portable Network Graphics (2nd edition), 5 and 11.
std::vector<std::uint8_t> png_pixels_only(std::span<const std::uint8_t> file, const std::string& name);

}  // namespace shoal
