// The report's pieces: text that stays text, base64 of RFC 4648, round ticks, and a page whose parts are there.
#include <catch2/catch.hpp>
#include <cmath>

#include "compare/chart.h"
#include "compare/html.h"
#include "compare/report.h"

namespace shoal::test {
namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

ReportMethod method_of(const std::string& name, double ms, double flip) {
  ReportMethod method;
  method.name = name;
  method.description = "about " + name;
  method.times = {ms, ms, 5};
  method.metrics.water = {flip, 30, std::nullopt};
  method.metrics.frame = {flip / 2, 40, std::nullopt};
  method.metrics.hits.water = {true, true, false, true};
  method.metrics.hits.error_map_px = {0.0f, 2.0f, -1.0f, -1.0f};
  method.metrics.hits.wrong = {0, 0, 0, 1};
  method.metrics.hits.error_px = {1, 2, 3};
  method.metrics.flip = {0.0f, 0.5f, 0.0f, 1.0f};
  method.picture_png = method.flip_png = method.hit_png = "not looked at";
  return method;
}

Report make_report() {
  Report report;
  report.scene = "a<b>&\"c\".glb";
  report.camera = "eye";
  report.command = "shoal compare 'a<b>' -o out";
  report.width_px = report.height_px = 2;
  report.water_pixels = 3;
  report.reference = method_of("truth", 100, 0);
  report.methods = {method_of("slow-and-right", 20, 0.01), method_of("fast-and-wrong", 2, 0.3)};
  report.settings = {{"spp", "1"}, {"tricky", "</script>"}};
  return report;
}

}  // namespace

TEST_CASE("html: escapes, base64, numbers", "[report]") {
  CHECK(html_escape("<a href=\"x\">'&") == "&lt;a href=&quot;x&quot;&gt;&#39;&amp;");
  CHECK(base64("") == "");
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foo") == "Zm9v");
  CHECK(base64("foobar") == "Zm9vYmFy");
  CHECK(base64(std::string("\xff\x00\xfe", 3)) == "/wD+");
  CHECK(short_number(0) == "0");
  CHECK(short_number(1234.5) == "1234");
  CHECK(short_number(99.96) == "100");
  CHECK(short_number(9.996) == "10.0");
  CHECK(short_number(0.012345) == "0.0123");
  CHECK(short_number(-2.5) == "-2.50");
  CHECK(short_number(1e-7) == "1.00e-07");
  CHECK(short_number(std::nan("")) == "\u2013");
  CHECK(percent(0.125) == "12.5 %");
}

TEST_CASE("chart: ticks are round and few", "[report]") {
  CHECK(axis_ticks(0, 1, false, 6) == std::vector<double>{0, 0.2, 0.2 * 2, 0.2 * 3, 0.2 * 4, 1});
  CHECK(axis_ticks(0.01, 100, true, 6).size() == 5);
  CHECK(axis_ticks(0.01, 100, true, 6).front() == Approx(0.01));
  CHECK(!std::signbit(axis_ticks(0, 1, false, 6).front()));
  for (double span = 0.001; span < 1e5; span *= 1.37) {
    for (const double low : {0.0, 0.3 * span, -span}) {
      const std::size_t n = axis_ticks(low, low + span, false, 6).size();
      CHECK((n >= 2 && n <= 6));
    }
    if (span > 1.2) {
      const std::size_t n = axis_ticks(1, span, true, 6).size();
      CHECK((n >= 2 && n <= 6));
    }
  }
}

TEST_CASE("chart: what is not finite is left out, names are text", "[report]") {
  Chart chart;
  chart.title = "a < b";
  chart.series.push_back({"<series>", {1, 2, std::nan("")}, {std::nan(""), 3, 4}, 0});
  const std::string svg = chart_figure(chart);
  CHECK(count(svg, "<circle") == 1);
  CHECK(count(svg, "nan") == 0);
  CHECK(count(svg, "<series>") == 0);
  CHECK(count(svg, "a &lt; b") >= 1);
  chart.series.clear();
  CHECK(count(chart_figure(chart), "nan") == 0);  // nothing to draw: still a chart
}

TEST_CASE("report: one page with everything in it", "[report]") {
  Report report = make_report();
  const std::string page = report_html(report);
  CHECK(page.rfind("<!doctype html>", 0) == 0);
  CHECK(count(page, "name=\"viewport\"") == 1);
  CHECK(count(page, "a<b>") == 0);
  CHECK(count(page, "</script>") == 1);
  CHECK(count(page, "src=\"http") == 0);
  CHECK(count(page, "<img id=") == 1 + 2 * 3);
  // The table is the first thing after two sentences, before any picture.
  CHECK(page.find("<table") < page.find("<img"));
  CHECK(count(page, "class=\"best\"") == 3);  // time, FLIP on water and over the frame; the rest is equal
  CHECK(count(page, "class=\"best\">2.00<") == 1);
  CHECK(count(page, "class=\"best\">0.0100<") == 1);
  CHECK(page.find("closest to the reference <code>slow-and-right</code>") != std::string::npos);
  CHECK(page.find("fastest <code>fast-and-wrong</code>") != std::string::npos);
  CHECK(page.find("not a ray-traced truth") != std::string::npos);
  CHECK(page.find("shoal compare &#39;a&lt;b&gt;&#39; -o out") != std::string::npos);
  report.methods[1].metrics.water.psnr_db = 31;
  CHECK(count(report_html(report), "class=\"best\">31.0<") == 1);
  report.reference_is_truth = true;
  CHECK(report_html(report).find("not a ray-traced truth") == std::string::npos);
}

TEST_CASE("report: a sweep as CSV", "[report]") {
  ReportSweep sweep{"slope", {"0.1", "a,b"}, {}};
  for (const std::string& value : sweep.values) {
    ReportSweepPoint point{value, "hybrid", {4, 3, 5}, {}};
    point.metrics.water.psnr_db = HUGE_VAL;
    point.metrics.water.flip = 0.25;
    sweep.points.push_back(point);
  }
  const std::string csv = sweep_csv(sweep);
  CHECK(csv.rfind("slope,method,ms_median,flip_water,", 0) == 0);
  CHECK(count(csv, "\n") == 3);
  CHECK(csv.find("\n0.1,hybrid,4,0.25,") != std::string::npos);
  CHECK(csv.find("\n\"a,b\",hybrid,4,0.25,") != std::string::npos);
  CHECK(count(csv, "inf") == 0);
  Report report = make_report();
  report.sweep = sweep;
  CHECK(count(report_html(report), "<td>a,b</td>") == 1);
}

}  // namespace shoal::test
