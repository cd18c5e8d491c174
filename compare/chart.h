// Charts as inline SVG.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace shoal {

struct ChartSeries {
  std::string name;
  std::vector<double> x, y;  // of the same length; what is not finite is left out
  std::size_t color = 0;     // class "c0", "c1", ... of the page's style
};

struct ChartAxis {
  std::string label;
  bool log = false;  // values of 0 and below are drawn at the low end
  // The range; where both are 0 it is that of the values.
  double low = 0, high = 0;
  std::vector<std::string> names;  // at 0, 1, 2, ... instead of numbers
};

struct Chart {
  enum class Mark { kLine, kSteps, kPoints };  // steps: y[i] from x[i] to x[i + 1]; points have their names beside them
  std::string title;
  ChartAxis x, y;
  Mark mark = Mark::kLine;
  std::vector<ChartSeries> series;
};

// A <figure> with its title, the drawing and a legend. Text is taken as text, not as HTML.
std::string chart_figure(Chart chart);

// Round numbers that cover low to high: at most `most`, on a logarithmic axis powers of ten where there are two of
// them.
std::vector<double> axis_ticks(double low, double high, bool log, int most);

}  // namespace shoal
