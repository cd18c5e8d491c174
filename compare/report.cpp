// The sections of the page, from the top; the sweep's are in report_sweep.cpp.
#include "compare/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "compare/chart.h"
#include "compare/html.h"
#include "compare/map_color.h"
#include "compare/report_assets.h"
#include "compare/report_sweep.h"

namespace shoal {

namespace {

std::string code(const std::string& text) { return "<code>" + html_escape(text) + "</code>"; }

// --- The table ------------------------------------------------------------------------------------------------------

struct Column {
  const char *title, *unit;
  std::function<double(const ReportMethod&)> value;
  bool is_share = false;
  bool more_is_better = false;
};

std::vector<Column> columns(const Report& report) {
  std::vector<Column> list = {
      {"Time", "ms a frame", [](const ReportMethod& m) { return m.times.median_ms; }},
      {"FLIP, water", "0 to 1", [](const ReportMethod& m) { return m.metrics.water.flip; }},
      {"FLIP, frame", "0 to 1", [](const ReportMethod& m) { return m.metrics.frame.flip; }},
      {"PSNR, water", "dB, more is better", [](const ReportMethod& m) { return m.metrics.water.psnr_db; }, false, true},
      {"Hit error", "px, median", [](const ReportMethod& m) { return m.metrics.hits.error_px.median; }},
      {"Hit error", "px, 95 %", [](const ReportMethod& m) { return m.metrics.hits.error_px.p95; }},
      {"Hit error", "px, 99 %", [](const ReportMethod& m) { return m.metrics.hits.error_px.p99; }},
      {"Hit error", "m, median", [](const ReportMethod& m) { return m.metrics.hits.error_m.median; }},
      {"Wrong object", "of the water", [](const ReportMethod& m) { return m.metrics.hits.wrong_object; }, true},
      {"Wrong surface", "of the water", [](const ReportMethod& m) { return m.metrics.hits.wrong_surface; }, true},
  };
  const auto yee = [](const ReportMethod& m) {
    return m.metrics.water.yee_failed ? static_cast<double>(*m.metrics.water.yee_failed) : std::nan("");
  };
  if (!report.methods.empty() && report.methods.front().metrics.water.yee_failed) {
    list.push_back({"Yee, water", "px that show", yee});
  }
  return list;
}

std::string cell_text(const Column& column, const ReportMethod& method) {
  const double value = column.value(method);
  if (std::isinf(value)) return "equal";
  return column.is_share ? percent(value) : short_number(value);
}

std::string table(const Report& report) {
  std::string out = "<div class=\"wide\"><table id=\"numbers\"><thead><tr><th>Method</th><th>Category</th>";
  const std::vector<Column> list = columns(report);
  for (const Column& c : list) {
    out += std::string("<th>") + c.title + "<small>" + c.unit + "</small></th>";
  }
  out += "</tr></thead>\n<tbody>\n";
  for (const ReportMethod& method : report.methods) {
    out += "<tr><td>" + code(method.name) + "</td><td>" + html_escape(method.category) + "</td>";
    for (const Column& c : list) {
      const double own = c.value(method);
      const auto any_other = [&](bool better) {
        return std::any_of(report.methods.begin(), report.methods.end(), [&](const ReportMethod& other) {
          if (other.category != method.category) return false;
          const double v = c.value(other);
          return better == c.more_is_better ? v > own : v < own;
        });
      };
      // Of its category: better than some, and none is better.
      const bool best = any_other(false) && !any_other(true);
      out += std::string("<td") + (best ? " class=\"best\"" : "") + ">" + cell_text(c, method) + "</td>";
    }
    out += "</tr>\n";
  }
  out += "<tr><td>" + code(report.reference.name) + " <span class=\"soft\">(reference)</span></td><td>" +
         html_escape(report.reference.category) + "</td><td>" + short_number(report.reference.times.median_ms) +
         "</td><td colspan=\"" + std::to_string(list.size() - 1) +
         "\" class=\"soft\">what the others are measured by</td></tr>\n";
  return out + "</tbody></table></div>\n";
}

std::string column_notes(const Report& report) {
  std::string out = "<details open><summary>What the columns mean</summary><dl>\n";
  const auto note = [&](const char* term, const std::string& text) {
    out += std::string("<dt>") + term + "</dt><dd>" + text + "</dd>\n";
  };
  note("Category",
       "What a method may use. Raster: rasterized buffers alone. Volume: rays marched through voxels. Hybrid: rays "
       "against "
       "the scene for what the water refracts and reflects. Traced: rays alone. The best number of each category is "
       "bold.");
  note("Time", "From the scene in memory and a new camera to the finished picture: the median of " +
                   std::to_string(report.reference.times.n) + " frames. Less is faster.");
  note("FLIP", "How much one would notice on flipping between the two pictures, 0 to 1, seen from where a degree is " +
                   short_number(static_cast<double>(report.pixels_per_degree)) +
                   " pixels wide; the mean over the water&#39;s pixels, or over all. 0 is no difference.");
  note("PSNR", "The classic measure of pixel differences. Above 40 dB one hardly sees any.");
  note("Hit error",
       "Through each pixel of water one sees a point of the scene. How far is the point that the method shows from the "
       "one that the reference shows, in pixels on the screen and in metres? The median, and what 95 and 99 of 100 "
       "pixels stay below. Only pixels where both show a surface.");
  note("Wrong object",
       "The share of water pixels that show another object than the reference does, or sky instead of "
       "an object, or nothing.");
  note("Wrong surface", "The share whose point is more than 10 cm off, or of another kind.");
  return out + "</dl></details>\n";
}

std::string method_notes(const Report& report) {
  std::string out = "<details open><summary>What the methods are</summary><dl>\n";
  const auto note = [&](const ReportMethod& m) {
    out += "<dt>" + code(m.name) + "</dt><dd>" + html_escape(m.description) + "</dd>\n";
  };
  for (const ReportMethod& method : report.methods) note(method);
  note(report.reference);
  return out + "</dl></details>\n";
}

// What the water does, as the settings say it.
std::string water_in_words(const Report& report) {
  const auto setting = [&](const std::string& key) {
    for (const auto& [name, value] : report.settings)
      if (name == key) return value;
    return std::string();
  };
  std::string surface = setting("surface");
  if (surface.empty()) return "";
  surface.erase(std::remove(surface.begin(), surface.end(), '"'), surface.end());
  if (surface == "flat") return " The water is flat.";
  const std::string slope = setting("slope");
  return " The water has waves: " + code(surface) +
         (slope.empty() || slope == "null" ? "" : ", RMS slope " + html_escape(slope)) + ".";
}

// In words: which is closest and which is fastest of each category that has several methods.
std::string verdict(const Report& report) {
  std::vector<std::string> categories;
  for (const ReportMethod& m : report.methods)
    if (std::find(categories.begin(), categories.end(), m.category) == categories.end())
      categories.push_back(m.category);
  std::string out;
  for (const std::string& category : categories) {
    std::vector<ReportMethod> of;
    for (const ReportMethod& m : report.methods)
      if (m.category == category) of.push_back(m);
    if (of.size() < 2) continue;
    const auto least = [&](auto value) {
      return *std::min_element(of.begin(), of.end(),
                               [&](const ReportMethod& a, const ReportMethod& b) { return value(a) < value(b); });
    };
    const ReportMethod close = least([](const ReportMethod& m) {
      return std::isfinite(m.metrics.water.flip) ? m.metrics.water.flip : m.metrics.frame.flip;
    });
    const ReportMethod fast = least([](const ReportMethod& m) { return m.times.median_ms; });
    out += "<p>Of the category " + html_escape(category) + ": <strong>closest to the reference " + code(close.name) +
           "</strong> (FLIP on water " + short_number(close.metrics.water.flip) + ", " +
           short_number(close.times.median_ms) + " ms), <strong>fastest " + code(fast.name) + "</strong> (" +
           short_number(fast.times.median_ms) + " ms, FLIP on water " + short_number(fast.metrics.water.flip) +
           ").</p>\n";
  }
  return out;
}

std::string introduction(const Report& report) {
  std::string out = "<h1>How right is the water in " + html_escape(report.scene) +
                    "?</h1>\n<p>Every method draws the same frame of " + code(report.scene) + " (camera " +
                    code(report.camera) + ", " + std::to_string(report.width_px) + " x " +
                    std::to_string(report.height_px) + " pixels, " + std::to_string(report.water_pixels) +
                    " of them water) and is measured by " + code(report.reference.name) + ", the reference";
  out += report.reference_is_truth
             ? ": rays followed through the water one by one." + water_in_words(report) +
                   " In the table less is better, except for PSNR; the best of a column is blue.</p>\n"
             : ". That is a method like the others, not a ray-traced truth: the numbers say how far the methods are "
               "apart, not how wrong each is." +
                   water_in_words(report) +
                   " In the table less is nearer, except for PSNR; the nearest of a column is blue.</p>\n";
  return out;
}

// --- Pictures -------------------------------------------------------------------------------------------------------

std::string image(const Report& report, const std::string& id, const std::string& alt, const std::string& png) {
  return "<img id=\"" + html_escape(id) + "\" width=\"" + std::to_string(report.width_px) + "\" height=\"" +
         std::to_string(report.height_px) + "\" alt=\"" + html_escape(alt) + "\" src=\"data:image/png;base64," +
         base64(png) + "\">";
}

std::string options(const Report& report, const std::string& selected) {
  std::string out;
  const auto add = [&](const std::string& id, const std::string& label) {
    out += "<option value=\"" + html_escape(id) + "\"" + (id == selected ? " selected" : "") + ">" +
           html_escape(label) + "</option>";
  };
  add("reference", report.reference.name + " (reference)");
  for (const ReportMethod& m : report.methods) add(m.name, m.name);
  for (const ReportMethod& m : report.methods) add(m.name + ".flip", m.name + ": FLIP map");
  for (const ReportMethod& m : report.methods) add(m.name + ".hit", m.name + ": hit error map");
  return out;
}

std::string slider(const Report& report) {
  const std::string size =
      "width=\"" + std::to_string(report.width_px) + "\" height=\"" + std::to_string(report.height_px) + "\"";
  // Until the script gives them pictures: a pixel of nothing.
  const std::string empty =
      "src=\"data:image/gif;base64,R0lGODlhAQABAAAAACH5BAEKAAEALAAAAAABAAEAAAICTAEAOw==\" alt=\"\"";
  return "<h2>Side by side</h2>\n<figure><div class=\"pick\"><label>Left<select id=\"left\">" +
         options(report, "reference") + "</select></label><label>Right<select id=\"right\">" +
         options(report, report.methods.front().name) +
         "</select></label></div>\n<div class=\"slider\" id=\"slider\"><img class=\"under\" " + size + " " + empty +
         "><img class=\"over\" " + size + " " + empty +
         "><div class=\"bar\"></div><input type=\"range\" min=\"0\" max=\"100\" step=\"0.1\" value=\"50\" "
         "aria-label=\"Where the left picture ends\"></div>\n<figcaption>Drag the line, or use the arrow "
         "keys.</figcaption></figure>\n";
}

std::string legends() {
  const auto plain = [](double v) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", v);
    return std::string(text);
  };
  const auto box = [](Rgb8 c) {
    return "<i class=\"box\" style=\"background: rgb(" + std::to_string(c.r) + " " + std::to_string(c.g) + " " +
           std::to_string(c.b) + ")\"></i> ";
  };
  return "<div class=\"grid\"><div><h3>FLIP maps</h3><div class=\"scale\"></div><p class=\"ends\"><span>0: no "
         "difference</span><span>1: the greatest</span></p></div>\n<div><h3>Hit error maps</h3><div "
         "class=\"scale\"></div><p class=\"ends\"><span>" +
         plain(kHitScaleLow_px) + " px and less</span><span>1 px</span><span>" + plain(kHitScaleHigh_px) +
         " px and more</span></p><p class=\"soft\">" + box(kWrongKindColor) +
         "shows something of another kind (sky, a mirror image, nothing) &nbsp; " + box(kSameKindColor) +
         "both show sky or a mirror image &nbsp; " + box(kNoWaterColor) + "no water</p></div></div>\n";
}

// Places and sizes; the script draws them, from the pictures that are there.
std::string spots(const ReportMethod& method) {
  if (method.metrics.spots.empty()) return "";
  std::string out = "<details class=\"spots\" data-method=\"" + html_escape(method.name) +
                    "\"><summary>Its largest differences, close up (" + std::to_string(method.metrics.spots.size()) +
                    ")</summary>\n<p class=\"soft\">Touching pixels with a FLIP of " +
                    short_number(static_cast<double>(kSpotFlip)) +
                    " or more. Left the reference, right this method.</p>\n<div class=\"closeups\">\n";
  for (const Spot& spot : method.metrics.spots) {
    out += "<figure data-x=\"" + std::to_string(spot.x) + "\" data-y=\"" + std::to_string(spot.y) +
           "\"><figcaption>at " + std::to_string(spot.x) + ", " + std::to_string(spot.y) + ": " +
           std::to_string(spot.size_px) + " px, FLIP up to " + short_number(static_cast<double>(spot.greatest)) +
           "</figcaption></figure>\n";
  }
  return out + "</div></details>\n";
}

std::string gallery(const Report& report) {
  std::string out =
      "<h2>Pictures and error maps</h2>\n" + legends() + "<h3>" + code(report.reference.name) +
      " (reference)</h3>\n<p class=\"soft\">" + html_escape(report.reference.description) +
      "</p>\n<div class=\"grid one\"><figure>" +
      image(report, "reference", report.reference.name + ", the reference", report.reference.picture_png) +
      "<figcaption>Picture</figcaption></figure></div>\n";
  for (const ReportMethod& m : report.methods) {
    out += "<h3>" + code(m.name) + "</h3>\n<p class=\"soft\">" + html_escape(m.description) + " (" +
           html_escape(m.source) + ")</p>\n<div class=\"grid\">\n<figure>" +
           image(report, m.name, m.name, m.picture_png) + "<figcaption>Picture</figcaption></figure>\n<figure>" +
           image(report, m.name + ".flip", m.name + ": FLIP map", m.flip_png) + "<figcaption>FLIP map: mean " +
           short_number(m.metrics.water.flip) + " on water, " + short_number(m.metrics.frame.flip) +
           " over the frame</figcaption></figure>\n<figure>" +
           image(report, m.name + ".hit", m.name + ": hit error map", m.hit_png) +
           "<figcaption>Hit error map: median " + short_number(m.metrics.hits.error_px.median) +
           " px</figcaption></figure>\n</div>\n" + spots(m);
  }
  return out;
}

// --- Charts ---------------------------------------------------------------------------------------------------------

// Shares of the values between consecutive edges; values beyond the ends count in the first and last.
ChartSeries histogram(const std::string& name, std::size_t color, const std::vector<float>& values,
                      const std::vector<double>& edges) {
  std::vector<double> share(edges.size() - 1, 0.0);
  for (const float value : values) {
    const auto after = std::upper_bound(edges.begin(), edges.end(), static_cast<double>(value));
    const auto bin =
        std::clamp<std::ptrdiff_t>(after - edges.begin() - 1, 0, static_cast<std::ptrdiff_t>(share.size()) - 1);
    share[static_cast<std::size_t>(bin)] += 100.0 / static_cast<double>(values.size());
  }
  share.push_back(share.back());
  return {name, edges, share, color};
}

std::string histograms(const Report& report) {
  std::vector<double> px_edges, flip_edges;
  for (int i = -15; i <= 15; ++i) px_edges.push_back(std::pow(10.0, i / 5.0));
  for (int i = 0; i <= 50; ++i) flip_edges.push_back(i / 50.0);
  Chart hit, flip;
  hit.title = "Hit error: shares of the water pixels where both show a surface";
  hit.x = {"hit error, px", true, px_edges.front(), px_edges.back(), {}};
  flip.title = "FLIP: shares of the water pixels";
  flip.x = {"FLIP", false, 0, 1, {}};
  for (Chart* chart : {&hit, &flip}) {
    chart->mark = Chart::Mark::kSteps;
    chart->y = {"% of pixels", true, 0.01, 100, {}};
  }
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    const ReportMethod& m = report.methods[i];
    PixelMask compared;
    for (const float px : m.metrics.hits.error_map_px) compared.push_back(px >= 0.0f);
    hit.series.push_back(histogram(m.name, i, masked_values(m.metrics.hits.error_map_px, compared), px_edges));
    flip.series.push_back(histogram(m.name, i, masked_values(m.metrics.flip, m.metrics.hits.water), flip_edges));
  }
  return "<h2>How the errors are spread</h2>\n<div class=\"grid\">" + chart_figure(hit) + chart_figure(flip) +
         "</div>\n<p class=\"soft\">Both heights are logarithmic; the first and last step also hold what is "
         "beyond.</p>\n";
}

// A logarithmic axis where all values can be on it.
ChartAxis fitting_axis(const std::string& label, const std::vector<double>& values) {
  const bool positive = std::all_of(values.begin(), values.end(), [](double v) { return v > 0 || std::isnan(v); });
  return {label, positive, 0, 0, {}};
}

std::string quality_against_time(const Report& report) {
  std::string out =
      "<h2>Quality against time</h2>\n<p class=\"soft\">Down is better, left is faster.</p>\n<div class=\"grid\">";
  const auto chart_of = [&](const char* title, const char* label, auto value) {
    Chart chart;
    chart.title = title;
    chart.mark = Chart::Mark::kPoints;
    chart.x = {"time a frame, ms", true, 0, 0, {}};
    std::vector<double> values;
    for (std::size_t i = 0; i < report.methods.size(); ++i) {
      const ReportMethod& m = report.methods[i];
      values.push_back(value(m));
      chart.series.push_back({m.name, {m.times.median_ms}, {values.back()}, i});
    }
    chart.y = fitting_axis(label, values);
    out += chart_figure(chart);
  };
  chart_of("What one would notice", "mean FLIP on water", [](const ReportMethod& m) { return m.metrics.water.flip; });
  chart_of("Where the points are", "median hit error, px",
           [](const ReportMethod& m) { return m.metrics.hits.error_px.median; });
  return out + "</div>\n";
}

std::string reproduction(const Report& report) {
  std::string out = "<h2>To reproduce</h2>\n<pre>" + html_escape(report.command) +
                    "</pre>\n<div class=\"wide\"><table class=\"settings\"><tbody>\n";
  for (const auto& [name, value] : report.settings) {
    out += "<tr><td>" + html_escape(name) + "</td><td>" + code(value) + "</td></tr>\n";
  }
  return out +
         "</tbody></table></div>\n<p class=\"soft\">The pictures are the same bytes on every machine; the times "
         "are this one&#39;s.</p>\n";
}

}  // namespace

std::string report_html(const Report& report) {
  std::string page =
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<link rel=\"icon\" href=\"data:,\">\n<title>Shoal: " +
      html_escape(report.scene) + "</title>\n<style>\n" + kReportStyle + "</style>\n</head>\n<body>\n<main>\n";
  page += introduction(report) + verdict(report) + table(report) + method_notes(report) + column_notes(report);
  page += slider(report) + quality_against_time(report);
  if (report.sweep) page += sweep_section(*report.sweep);
  page += histograms(report) + gallery(report) + reproduction(report);
  return page + "</main>\n<script>\n" + kReportScript + "</script>\n</body>\n</html>\n";
}

}  // namespace shoal
