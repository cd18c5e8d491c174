// Strict readers of the values that a user types: the whole text or a UsageError, never a guess.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/vec.h"

namespace shoal::app {

// All of them throw UsageError, one line that names `option` and what was expected.
//
//   option  how the user knows the value: "--size", "--set ior"
//   text    what was typed; no blanks, signs or junk around it

// A decimal whole number from `low` to `high`.
std::int64_t read_integer(std::string_view option, std::string_view text, std::int64_t low, std::int64_t high);
// A finite decimal number from `low` to `high`.
double read_number(std::string_view option, std::string_view text, double low, double high);
// As read_number, rounded to float.
float read_float(std::string_view option, std::string_view text, double low, double high);
// Finite numbers with commas between; brackets round all of them are allowed, as in JSON.
std::vector<float> read_floats(std::string_view option, std::string_view text, std::size_t count, double low,
                               double high);
Vec3f read_triple(std::string_view option, std::string_view text, double low, double high);

// "1280x720".
struct SizePx {
  int width = 0, height = 0;
};
SizePx read_size(std::string_view option, std::string_view text);

// "3:7": frames 3 to 7, both included.
struct FrameRange {
  std::int64_t first = 0, last = 0;
};
FrameRange read_frames(std::string_view option, std::string_view text);

// Parts between separators; an empty text is one empty part.
std::vector<std::string> split(std::string_view text, char separator);

// Lower-case ASCII ending test: "A.PNG" ends with ".png".
bool has_ending(std::string_view path, std::string_view ending);

// "a, b, c".
std::string join(const std::vector<std::string>& names);

// A file name with one integer conversion: "frame.%04d.png".
class NamePattern {
 public:
  // Throws UsageError unless there is exactly one %d, %Nd or %0Nd. "%%" is a percent sign.
  NamePattern(std::string_view option, std::string_view text);
  std::string name(std::int64_t number) const;

 private:
  std::string before_, after_;
  int width_ = 0;
  char fill_ = ' ';
};

}  // namespace shoal::app
