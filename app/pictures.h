// PNG and EXR files: frames out, pictures in. OpenImageIO stays behind this file.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "refraction/renderer.h"

namespace shoal::app {

// 8-bit RGB of the finished picture.
void write_png(std::FILE* file, const std::string& path, const Frame& frame);

// The same as bytes in memory, of any codes.
//   rgb  3 a pixel
std::string png_bytes(int width_px, int height_px, const std::vector<std::uint8_t>& rgb);

// Linear float R, G, B, A and the frame's AOVs as layers, in one part, rows top to bottom; ids, kinds and masks are
// uint32. Neither file holds a date or a path: the same picture is the same file.
//
//   path  for messages only
// Both throw Error where the library refuses; bytes that do not reach the disk are OutputFile::finish()'s to find.
void write_exr(std::FILE* file, const std::string& path, const Frame& frame);

enum class SampleType : std::uint8_t { kUint8, kUint16, kUint32, kFloat };

// One channel as its samples' bits, row by row from the top; a half float is widened to float.
struct PictureChannel {
  std::string name;
  SampleType type = SampleType::kFloat;
  std::vector<std::uint32_t> bits;

  // As a number: code values for integers (0 to 255 in a PNG), the value of a float.
  double value(std::size_t pixel) const;
};

struct Picture {
  enum class Format : std::uint8_t { kPng, kExr } format = Format::kPng;
  int width_px = 0, height_px = 0;
  std::vector<PictureChannel> channels;

  const PictureChannel* find(const std::string& name) const;
};

// Reads a PNG or an EXR of one part, told by its first bytes. Throws Error.
Picture read_picture(const std::string& path);

// An 8-bit RGB PNG, or an EXR of float R, G and B, by the ending of `path`.
//
//   rgb  3 a pixel; for a PNG in [0, 1], rounded to nearest
void write_map(std::FILE* file, const std::string& path, int width_px, int height_px, const std::vector<float>& rgb);

}  // namespace shoal::app
