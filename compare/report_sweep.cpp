#include "compare/report_sweep.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <functional>

#include "compare/chart.h"
#include "compare/html.h"

namespace shoal {

namespace {

struct Quantity {
  const char *csv, *title, *label;
  std::function<double(const ReportSweepPoint&)> value;
};

const std::vector<Quantity>& quantities() {
  using Point = ReportSweepPoint;
  static const std::vector<Quantity> list = {
      {"ms_median", "Time", "ms a frame", [](const Point& p) { return p.times.median_ms; }},
      {"flip_water", "FLIP on water", "mean FLIP", [](const Point& p) { return p.metrics.water.flip; }},
      {"hit_px_median", "Hit error, median", "px", [](const Point& p) { return p.metrics.hits.error_px.median; }},
      {"hit_px_p99", "Hit error, 99 of 100 below", "px", [](const Point& p) { return p.metrics.hits.error_px.p99; }},
      {"wrong_object", "Wrong object", "share of the water",
       [](const Point& p) { return p.metrics.hits.wrong_object; }},
      {"wrong_surface", "Wrong surface", "share of the water",
       [](const Point& p) { return p.metrics.hits.wrong_surface; }},
      {"flip_frame", "", "", [](const Point& p) { return p.metrics.frame.flip; }},
      {"psnr_water_db", "", "", [](const Point& p) { return p.metrics.water.psnr_db; }},
      {"psnr_frame_db", "", "", [](const Point& p) { return p.metrics.frame.psnr_db; }},
      {"hit_px_p95", "", "", [](const Point& p) { return p.metrics.hits.error_px.p95; }},
      {"hit_m_median", "", "", [](const Point& p) { return p.metrics.hits.error_m.median; }},
      {"hit_m_p95", "", "", [](const Point& p) { return p.metrics.hits.error_m.p95; }},
      {"hit_m_p99", "", "", [](const Point& p) { return p.metrics.hits.error_m.p99; }},
      {"ms_min", "", "", [](const Point& p) { return p.times.min_ms; }},
      {"water_pixels", "", "", [](const Point& p) { return static_cast<double>(p.metrics.hits.water_pixels); }},
  };
  return list;
}
constexpr std::size_t kCharts = 6;  // of them are drawn, the first ones

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::vector<std::string> methods_of(const ReportSweep& sweep) {
  std::vector<std::string> names;
  for (const ReportSweepPoint& p : sweep.points) {
    if (std::find(names.begin(), names.end(), p.method) == names.end()) names.push_back(p.method);
  }
  return names;
}

// The values as numbers; empty where one of them is none.
std::vector<double> numbers_of(const std::vector<std::string>& values) {
  std::vector<double> numbers;
  for (const std::string& text : values) {
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return {};
    numbers.push_back(number);
  }
  return numbers;
}

// Along the values: by number, logarithmic where they span more than a decade; by name where they are none.
ChartAxis value_axis(const ReportSweep& sweep, const std::vector<double>& numbers) {
  if (numbers.empty()) return {sweep.key, false, 0, 0, sweep.values};
  const auto [low, high] = std::minmax_element(numbers.begin(), numbers.end());
  return {sweep.key, *low > 0 && *high > 10 * *low, 0, 0, {}};
}

std::string chart_of(const ReportSweep& sweep, const Quantity& quantity, const std::vector<std::string>& methods) {
  const std::vector<double> numbers = numbers_of(sweep.values);
  Chart chart;
  chart.title = std::string(quantity.title) + " against " + sweep.key;
  chart.x = value_axis(sweep, numbers);
  chart.y = {quantity.label, false, 0, 0, {}};
  for (std::size_t m = 0; m < methods.size(); ++m) {
    ChartSeries series{methods[m], {}, {}, m};
    for (std::size_t v = 0; v < sweep.values.size(); ++v) {
      for (const ReportSweepPoint& p : sweep.points) {
        if (p.method != methods[m] || p.value != sweep.values[v]) continue;
        series.x.push_back(numbers.empty() ? static_cast<double>(v) : numbers[v]);
        series.y.push_back(quantity.value(p));
        break;
      }
    }
    chart.series.push_back(std::move(series));
  }
  return chart_figure(chart);
}

std::string table_of(const ReportSweep& sweep) {
  std::string out =
      "<div class=\"wide\"><table id=\"sweep\"><thead><tr><th>" + html_escape(sweep.key) + "</th><th>Method</th>";
  for (std::size_t i = 0; i < kCharts; ++i) {
    out += std::string("<th>") + quantities()[i].title + "<small>" + quantities()[i].label + "</small></th>";
  }
  out += "</tr></thead><tbody>\n";
  for (const ReportSweepPoint& p : sweep.points) {
    out += "<tr><td>" + html_escape(p.value) + "</td><td><code>" + html_escape(p.method) + "</code></td>";
    for (std::size_t i = 0; i < kCharts; ++i) out += "<td>" + short_number(quantities()[i].value(p)) + "</td>";
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

}  // namespace

std::string sweep_csv(const ReportSweep& sweep) {
  std::string out = csv_field(sweep.key) + ",method";
  for (const Quantity& quantity : quantities()) out += std::string(",") + quantity.csv;
  out += '\n';
  for (const ReportSweepPoint& p : sweep.points) {
    out += csv_field(p.value) + ',' + csv_field(p.method);
    for (const Quantity& quantity : quantities()) {
      const double value = quantity.value(p);
      char text[32] = "";
      if (std::isfinite(value)) std::snprintf(text, sizeof text, "%.9g", value);
      out += std::string(",") + text;
    }
    out += '\n';
  }
  return out;
}

std::string sweep_section(const ReportSweep& sweep) {
  std::string out = "<h2>Sweep: " + html_escape(sweep.key) +
                    "</h2>\n<p class=\"soft\">Everything else as in the "
                    "table above; each value has a reference of its own.</p>\n<div class=\"grid\">";
  const std::vector<std::string> methods = methods_of(sweep);
  for (std::size_t i = 0; i < kCharts; ++i) out += chart_of(sweep, quantities()[i], methods);
  return out + "</div>\n<h3>As a table</h3>\n" + table_of(sweep);
}

}  // namespace shoal
