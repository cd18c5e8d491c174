// The options of `shoal compare`: as typed, and as read (docs/command.md).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/options.h"

namespace shoal::app {

// As typed, beside the options that all commands with frames have.
struct CompareArguments {
  RawOptions options;  // its output is the folder
  std::optional<std::string> sweep, ppd;
  bool exr = false, yee = false;
  std::string command;  // the whole line, quoted for a shell
};

struct SweepOptions {
  std::string key;
  std::vector<std::string> values;
};

struct CompareOptions {
  std::string folder;
  Options reference;             // all options, with the reference as the method
  std::vector<Options> methods;  // the same, with each method and its own options
  std::optional<SweepOptions> sweep;
  float pixels_per_degree = 0;
  bool exr = false, yee = false;
};

// Frames that compare times where --repeat is not given: one alone would be the first, with cold caches.
inline constexpr const char* kCompareRepeat = "5";

// The reference where none is asked for: the ray tracer, or before it has come the method nearest to it.
std::string default_reference();

// Throws UsageError, as read_options.
CompareOptions read_compare_options(const CompareArguments& arguments);

// The options of one point of a sweep: every method's with KEY at that value.
//   view-angle is no option: it is checked, and left to the caller
CompareOptions options_at(const CompareArguments& arguments, const std::string& key, const std::string& value);

// The degrees of a view-angle, 1 to 90.
double read_view_angle(const std::string& value);
inline constexpr const char* kViewAngle = "view-angle";

}  // namespace shoal::app
