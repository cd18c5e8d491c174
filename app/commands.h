// The commands behind `shoal NAME`, one file each. They return the exit code and throw for errors: UsageError is 2,
// anything else 1.
#pragma once

#include <optional>
#include <string>

#include "app/compare_options.h"
#include "app/options.h"

namespace shoal::app {

struct DiffArguments {
  std::string a, b;
  std::optional<std::string> json, mask, map, flip_map, ppd;
  bool quiet = false;
};

struct ProbeArguments {
  RawOptions options;
  std::optional<std::string> pixel, point;
};

int run_render(const RawOptions& raw);
int run_compare(const CompareArguments& arguments);
int run_diff(const DiffArguments& arguments);
int run_probe(const ProbeArguments& arguments);
int run_scene(const RawOptions& raw);
int run_info(const RawOptions& raw);
int run_list(const std::string& kind, bool verbose);

}  // namespace shoal::app
