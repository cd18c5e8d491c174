#include "compare/chart.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "compare/html.h"

namespace shoal {

namespace {

// The drawing is 480 by 300 of its units; this part of it holds the values.
constexpr double kHeight = 300, kLeft = 62, kRight = 458, kTop = 10, kBottom = 252;

std::string px(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", v);
  return text;
}

// Ticks are round numbers: no zeros at the end.
std::string tick_text(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", v);
  return text;
}

bool usable(double v, bool log) { return std::isfinite(v) && (!log || v > 0); }

// Fills in a range that was left open.
void fit_axis(ChartAxis& axis, const std::vector<ChartSeries>& series, bool is_x) {
  if (!axis.names.empty()) {
    axis.low = -0.3;
    axis.high = static_cast<double>(axis.names.size()) - 0.7;
  }
  if (axis.low != 0 || axis.high != 0) return;
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const ChartSeries& s : series) {
    for (const double v : is_x ? s.x : s.y) {
      if (!usable(v, axis.log)) continue;
      low = std::min(low, v);
      high = std::max(high, v);
    }
  }
  if (!(low <= high)) {
    low = axis.log ? 0.1 : 0;
    high = 1;
  }
  if (axis.log) {
    axis.low = low / 1.5;
    axis.high = high * 1.5;
    return;
  }
  if (!is_x && low > 0) low = 0;  // a height is read against nothing
  const double margin = high > low ? 0.05 * (high - low) : std::max(std::fabs(high), 1.0) * 0.5;
  axis.low = low == 0 ? 0 : low - margin;
  axis.high = high + margin;
}

// Value to place, from a to b.
double place(const ChartAxis& axis, double value, double a, double b) {
  double low = axis.low, high = axis.high, v = value;
  if (axis.log) {
    low = std::log10(low);
    high = std::log10(high);
    v = v > 0 ? std::log10(v) : low;
  }
  return a + (std::clamp(v, low, high) - low) / (high - low) * (b - a);
}

class Drawing {
 public:
  explicit Drawing(const Chart& chart) : chart_(chart) {}

  std::string svg() {
    out_ = "<svg viewBox=\"0 0 480 300\" role=\"img\" aria-label=\"" + html_escape(chart_.title) + "\">\n";
    axes();
    for (const ChartSeries& s : chart_.series) {
      if (chart_.mark == Chart::Mark::kPoints) {
        points(s);
      } else {
        line(s);
      }
    }
    return out_ + "</svg>\n";
  }

 private:
  double x_of(double v) const { return place(chart_.x, v, kLeft, kRight); }
  double y_of(double v) const { return place(chart_.y, v, kBottom, kTop); }

  void text(double x, double y, const char* anchor, const std::string& content, const std::string& more = "") {
    out_ += "<text x=\"" + px(x) + "\" y=\"" + px(y) + "\" text-anchor=\"" + anchor + "\"" + more + ">" +
            html_escape(content) + "</text>\n";
  }
  void rule(double x1, double y1, double x2, double y2, const char* type) {
    out_ += std::string("<path class=\"") + type + "\" d=\"M" + px(x1) + " " + px(y1) + "L" + px(x2) + " " + px(y2) +
            "\"/>\n";
  }

  void axes() {
    const ChartAxis &x = chart_.x, &y = chart_.y;
    for (const double v : axis_ticks(y.low, y.high, y.log, 6)) {
      rule(kLeft, y_of(v), kRight, y_of(v), "grid");
      text(kLeft - 6, y_of(v) + 4, "end", tick_text(v));
    }
    if (x.names.empty()) {
      for (const double v : axis_ticks(x.low, x.high, x.log, 7)) {
        rule(x_of(v), kTop, x_of(v), kBottom, "grid");
        text(x_of(v), kBottom + 16, "middle", tick_text(v));
      }
    }
    for (std::size_t i = 0; i < x.names.size(); ++i) {
      text(x_of(static_cast<double>(i)), kBottom + 16, "middle", x.names[i]);
    }
    rule(kLeft, kBottom, kRight, kBottom, "axis");
    rule(kLeft, kTop, kLeft, kBottom, "axis");
    text((kLeft + kRight) / 2, kHeight - 12, "middle", x.label);
    const double middle = (kTop + kBottom) / 2;
    text(14, middle, "middle", y.label, " transform=\"rotate(-90 14 " + px(middle) + ")\"");
  }

  static std::string color(const ChartSeries& s) { return "c" + std::to_string(s.color % 10); }

  void line(const ChartSeries& s) {
    const bool steps = chart_.mark == Chart::Mark::kSteps;
    std::string path;
    for (std::size_t i = 0; i < s.y.size(); ++i) {
      if (!std::isfinite(s.x[i]) || !std::isfinite(s.y[i])) continue;
      path += (path.empty() ? "M" : "L") + px(x_of(s.x[i])) + " " + px(y_of(s.y[i]));
      if (steps && i + 1 < s.x.size()) path += "H" + px(x_of(s.x[i + 1]));
    }
    if (path.empty()) return;
    out_ +=
        "<path class=\"line " + color(s) + "\" d=\"" + path + "\"><title>" + html_escape(s.name) + "</title></path>\n";
    for (std::size_t i = 0; !steps && i < s.y.size(); ++i) {
      if (std::isfinite(s.x[i]) && std::isfinite(s.y[i])) dot(s, i, 3);
    }
  }

  void points(const ChartSeries& s) {
    for (std::size_t i = 0; i < s.y.size(); ++i) {
      if (!std::isfinite(s.x[i]) || !std::isfinite(s.y[i])) continue;
      dot(s, i, 6);
      const double x = x_of(s.x[i]);
      const bool left = x > (kLeft + 2 * kRight) / 3;
      text(x + (left ? -10 : 10), y_of(s.y[i]) - 8, left ? "end" : "start", s.name);
    }
  }

  void dot(const ChartSeries& s, std::size_t i, double radius) {
    out_ += "<circle class=\"" + color(s) + "\" cx=\"" + px(x_of(s.x[i])) + "\" cy=\"" + px(y_of(s.y[i])) + "\" r=\"" +
            px(radius) + "\"><title>" +
            html_escape(s.name + ": " + short_number(s.x[i]) + ", " + short_number(s.y[i])) + "</title></circle>\n";
  }

  const Chart& chart_;
  std::string out_;
};

}  // namespace

std::vector<double> axis_ticks(double low, double high, bool log, int most) {
  std::vector<double> ticks;
  if (log) {
    const int first = static_cast<int>(std::ceil(std::log10(low) - 1e-9));
    const int last = static_cast<int>(std::floor(std::log10(high) + 1e-9));
    const int every = std::max(1, (last - first + most) / most);
    for (int e = first; e <= last; e += every) ticks.push_back(std::pow(10.0, e));
    if (ticks.size() >= 2) return ticks;
    ticks.clear();
  }
  double step = std::pow(10.0, std::floor(std::log10((high - low) / most)));
  for (const double factor : {1.0, 2.0, 5.0, 10.0, 20.0}) {
    if ((high - low) / (step * factor) > most - 1) continue;
    step *= factor;
    break;
  }
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1) {
    ticks.push_back(k * step + 0.0);  // no -0
  }
  return ticks;
}

std::string chart_figure(Chart chart) {
  fit_axis(chart.x, chart.series, true);
  fit_axis(chart.y, chart.series, false);
  std::string out = "<figure class=\"chart\"><figcaption>" + html_escape(chart.title) + "</figcaption>\n";
  out += Drawing(chart).svg();
  if (chart.mark != Chart::Mark::kPoints) {
    out += "<p class=\"legend\">";
    for (const ChartSeries& s : chart.series) {
      out += "<span><i class=\"c" + std::to_string(s.color % 10) + "\"></i>" + html_escape(s.name) + "</span> ";
    }
    out += "</p>\n";
  }
  return out + "</figure>\n";
}

}  // namespace shoal
