// shoal diff: are two pictures equal, and if not, where and by how much.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "app/commands.h"
#include "app/json_report.h"
#include "app/output.h"
#include "app/pictures.h"
#include "core/error.h"

namespace shoal::app {
namespace {

constexpr int kExitEqual = 0, kExitDifferent = 3;

struct Difference {
  std::uint64_t pixels_differ = 0;
  double max_abs = 0;  // infinite where a difference is no number
  std::size_t first_pixel = 0;
  std::size_t first_channel = 0;
  double psnr_db = 0;  // not finite where there is nothing to say: no difference in colour, or one that is no number
};

std::vector<std::string> channel_names(const Picture& picture) {
  std::vector<std::string> names;
  for (const PictureChannel& channel : picture.channels) names.push_back(channel.name);
  return names;
}

void require_comparable(const DiffArguments& files, const Picture& a, const Picture& b) {
  const auto format_name = [](const Picture& p) { return p.format == Picture::Format::kPng ? "a PNG" : "an EXR"; };
  if (a.format != b.format) {
    throw Error(fmt::format("{}: is {}; expected {}, as {} is", files.b, format_name(b), format_name(a), files.a));
  }
  if (a.width_px != b.width_px || a.height_px != b.height_px) {
    throw Error(fmt::format("{}: is {}x{}; expected {}x{}, as {} is", files.b, b.width_px, b.height_px, a.width_px,
                            a.height_px, files.a));
  }
  bool same = a.channels.size() == b.channels.size();
  for (std::size_t c = 0; same && c < a.channels.size(); ++c) {
    same = a.channels[c].name == b.channels[c].name && a.channels[c].type == b.channels[c].type;
  }
  if (!same) {
    throw Error(fmt::format("{}: has the channels {}; expected {}, of the same types, as {} has", files.b,
                            join(channel_names(b)), join(channel_names(a)), files.a));
  }
}

// Which pixels count: those of the mask that are not black (or not 0 in its `water.mask`); all without one.
std::vector<bool> read_mask(const DiffArguments& files, const Picture& a) {
  const std::size_t pixels = a.channels.front().bits.size();
  if (!files.mask) return std::vector<bool>(pixels, true);
  const Picture mask = read_picture(*files.mask);
  if (mask.width_px != a.width_px || mask.height_px != a.height_px) {
    throw Error(fmt::format("{}: is {}x{}; expected {}x{}, as {} is", *files.mask, mask.width_px, mask.height_px,
                            a.width_px, a.height_px, files.a));
  }
  std::vector<bool> counts(pixels, false);
  const PictureChannel* water = mask.find("water.mask");
  for (const PictureChannel& channel : mask.channels) {
    if (water ? &channel != water : channel.name == "A") continue;
    for (std::size_t i = 0; i < pixels; ++i) counts[i] = counts[i] || channel.value(i) != 0;
  }
  return counts;
}

// Red, green and blue; all channels where a picture has none of these.
std::vector<std::size_t> color_channels(const Picture& picture) {
  std::vector<std::size_t> color;
  for (std::size_t c = 0; c < picture.channels.size(); ++c) {
    const std::string& name = picture.channels[c].name;
    if (name == "R" || name == "G" || name == "B") color.push_back(c);
  }
  for (std::size_t c = 0; color.empty() && c < picture.channels.size(); ++c) color.push_back(c);
  return color;
}

// What a value of 1 is: a PNG's greatest code, or 1 in linear light.
double peak(const PictureChannel& channel) {
  if (channel.type == SampleType::kUint8) return 255;
  return channel.type == SampleType::kUint16 ? 65535 : 1;
}

double psnr_db(const Picture& a, const Picture& b, const std::vector<bool>& counts) {
  double sum = 0;
  std::uint64_t n = 0;
  for (const std::size_t c : color_channels(a)) {
    for (std::size_t i = 0; i < counts.size(); ++i) {
      if (!counts[i]) continue;
      const double d = (a.channels[c].value(i) - b.channels[c].value(i)) / peak(a.channels[c]);
      sum += d * d;
      ++n;
    }
  }
  return -10 * std::log10(sum / static_cast<double>(n));
}

// Samples are equal when their bits are: what is not a number equals itself, and -0 is not 0.
Difference compare_pictures(const Picture& a, const Picture& b, const std::vector<bool>& counts) {
  Difference difference;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (!counts[i]) continue;
    bool differs = false;
    for (std::size_t c = 0; c < a.channels.size(); ++c) {
      if (a.channels[c].bits[i] == b.channels[c].bits[i]) continue;
      if (!differs && difference.pixels_differ == 0) {
        difference.first_pixel = i;
        difference.first_channel = c;
      }
      differs = true;
      const double d = std::fabs(a.channels[c].value(i) - b.channels[c].value(i));
      difference.max_abs = std::max(difference.max_abs, std::isnan(d) ? HUGE_VAL : d);
    }
    difference.pixels_differ += differs ? 1 : 0;
  }
  difference.psnr_db = psnr_db(a, b, counts);
  return difference;
}

// Absolute differences of the colours, 1 where one is no number; a PNG's in parts of its greatest code. Black where
// the mask is.
std::vector<float> difference_map(const Picture& a, const Picture& b, const std::vector<bool>& counts) {
  const std::vector<std::size_t> color = color_channels(a);
  std::vector<float> rgb(counts.size() * 3, 0.0f);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    for (std::size_t k = 0; counts[i] && k < 3; ++k) {
      const std::size_t c = color[std::min(k, color.size() - 1)];
      if (a.channels[c].bits[i] == b.channels[c].bits[i]) continue;
      const double d = std::fabs(a.channels[c].value(i) - b.channels[c].value(i)) / peak(a.channels[c]);
      rgb[i * 3 + k] = std::isfinite(d) ? static_cast<float>(d) : 1.0f;
    }
  }
  return rgb;
}

std::string sample_text(const PictureChannel& channel, std::size_t pixel) {
  const double value = channel.value(pixel);
  if (channel.type != SampleType::kFloat) return fmt::format("{:.0f}", value);
  return fmt::format("{} ({:a})", static_cast<float>(value), value);
}

std::string summary(const Picture& a, const Picture& b, const Difference& d) {
  if (d.pixels_differ == 0) return "equal\n";
  const auto width = static_cast<std::size_t>(a.width_px);
  const PictureChannel& ca = a.channels[d.first_channel];
  const PictureChannel& cb = b.channels[d.first_channel];
  return fmt::format("different\npixels {} of {}\nfirst {},{} {}: {} and {}\nmax_abs {}\npsnr_db {}\n", d.pixels_differ,
                     ca.bits.size(), d.first_pixel % width, d.first_pixel / width, ca.name,
                     sample_text(ca, d.first_pixel), sample_text(cb, d.first_pixel), d.max_abs,
                     std::isfinite(d.psnr_db) ? fmt::format("{:.4f}", d.psnr_db) : "none");
}

Json report(const Picture& a, const Difference& d) {
  const auto width = static_cast<std::size_t>(a.width_px);
  Json json = Json::object();
  json["equal"] = d.pixels_differ == 0;
  json["pixels_differ"] = d.pixels_differ;
  json["max_abs"] = json_double(d.max_abs);
  json["first"] = nullptr;
  if (d.pixels_differ > 0) {
    json["first"] = {d.first_pixel % width, d.first_pixel / width, a.channels[d.first_channel].name};
  }
  json["flip"] = nullptr;
  json["psnr_db"] = json_double(d.psnr_db);
  return json;
}

void check_arguments(const DiffArguments& arguments) {
  if (arguments.ppd) read_number("--ppd", *arguments.ppd, 1, 10000);
  if (arguments.map && !has_ending(*arguments.map, ".png") && !has_ending(*arguments.map, ".exr")) {
    throw UsageError(fmt::format("--map '{}': not a picture's name; expected FILE.png or FILE.exr", *arguments.map));
  }
  if (arguments.map && arguments.json && *arguments.map == *arguments.json) {
    throw UsageError(fmt::format("--json '{}': the map has that name; expected another", *arguments.json));
  }
}

}  // namespace

int run_diff(const DiffArguments& arguments) {
  check_arguments(arguments);
  const Picture a = read_picture(arguments.a), b = read_picture(arguments.b);
  require_comparable(arguments, a, b);
  const std::vector<bool> counts = read_mask(arguments, a);
  if (std::find(counts.begin(), counts.end(), true) == counts.end()) {
    throw Error(fmt::format("{}: is black all over; expected a mask with at least one pixel", *arguments.mask));
  }
  const Difference difference = compare_pictures(a, b, counts);

  std::unique_ptr<OutputFile> map;
  if (arguments.map) {
    map = std::make_unique<OutputFile>(*arguments.map);
    write_map(map->stream(), *arguments.map, a.width_px, a.height_px, difference_map(a, b, counts));
    map->finish();
  }
  if (arguments.json) write_text(*arguments.json, json_text(report(a, difference)));
  if (map) map->commit();
  if (arguments.json != "-" && !arguments.quiet) write_stdout(summary(a, b, difference));
  return difference.pixels_differ == 0 ? kExitEqual : kExitDifferent;
}

}  // namespace shoal::app
