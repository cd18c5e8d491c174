// The report of a comparison: one page that needs nothing else, no network, no other file.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compare/metrics.h"

namespace shoal {

struct ReportTimes {
  double median_ms = 0, min_ms = 0;
  std::size_t n = 0;
};

// Pictures are PNG files' bytes.
struct ReportMethod {
  std::string name, category, description, source;
  ReportTimes times;
  FrameMetrics metrics;  // of the reference: empty
  std::string picture_png, flip_png, hit_png;
};

struct ReportSweepPoint {
  std::string value, method;
  ReportTimes times;
  FrameMetrics metrics;  // without their maps
};
struct ReportSweep {
  std::string key;
  std::vector<std::string> values;
  std::vector<ReportSweepPoint> points;  // method after method within value after value
};

struct Report {
  std::string scene, camera, command;
  int width_px = 0, height_px = 0;
  std::uint64_t water_pixels = 0;
  float pixels_per_degree = 0;
  bool reference_is_truth = false;  // else one method is measured by another
  ReportMethod reference;
  std::vector<ReportMethod> methods;
  std::vector<std::pair<std::string, std::string>> settings;  // name, value
  std::optional<ReportSweep> sweep;
};

// The page, HTML 5 in UTF-8.
std::string report_html(const Report& report);

// The sweep as comma-separated values, with a line of names; empty where a number is none.
std::string sweep_csv(const ReportSweep& sweep);

}  // namespace shoal
