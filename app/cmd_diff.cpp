// shoal diff: are two pictures equal, and if not, where and by how much.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "app/commands.h"
#include "app/json_report.h"
#include "app/output.h"
#include "app/pictures.h"
#include "compare/flip.h"
#include "compare/map_color.h"
#include "compare/statistics.h"
#include "core/error.h"
#include "shading/srgb.h"

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

// --- FLIP -----------------------------------------------------------------------------------------------------------

struct Flip {
  MapSummary summary;
  const char* kind = "ldr";
  float ppd = kDefaultPixelsPerDegree;
  std::vector<float> error;
};

// Linear light of a picture with red, green and blue; nothing for any other.
std::optional<LinearPicture> linear_picture(const Picture& picture) {
  LinearPicture linear{picture.width_px, picture.height_px, {}};
  const std::size_t pixels = picture.channels.front().bits.size();
  linear.rgb.resize(pixels * 3);
  for (std::size_t c = 0; c < 3; ++c) {
    const PictureChannel* channel = picture.find(std::string(1, "RGB"[c]));
    if (!channel) return std::nullopt;
    const bool encoded = picture.format == Picture::Format::kPng;
    for (std::size_t i = 0; i < pixels; ++i) {
      const double value = channel->value(i) / peak(*channel);
      linear.rgb[3 * i + c] = static_cast<float>(encoded ? srgb_to_linear(value) : value);
    }
  }
  return linear;
}

// LDR-FLIP of two PNGs, HDR-FLIP of two EXRs, with A as the reference.
std::optional<Flip> flip_pictures(const DiffArguments& arguments, const Picture& a, const Picture& b,
                                  const std::vector<bool>& counts) {
  const std::optional<LinearPicture> reference = linear_picture(a), test = linear_picture(b);
  if (!reference || !test) return std::nullopt;
  Flip flip;
  if (arguments.ppd) flip.ppd = read_float("--ppd", *arguments.ppd, 1, 10000);
  ThreadPool pool(available_threads());
  const FlipSettings settings{flip.ppd, best_isa()};
  if (a.format == Picture::Format::kPng) {
    flip.error = ldr_flip(*reference, *test, settings, pool);
  } else {
    flip.kind = "hdr";
    flip.error = hdr_flip(*reference, *test, settings, pool).error;
  }
  flip.summary = summarize(flip.error, counts);
  return flip;
}

Json flip_json(const std::optional<Flip>& flip) {
  if (!flip) return nullptr;
  Json json = Json::object();
  json["mean"] = json_double(flip->summary.mean);
  json["median"] = json_double(flip->summary.median);
  json["p95"] = json_double(flip->summary.p95);
  json["kind"] = flip->kind;
  json["ppd"] = json_float(flip->ppd);
  return json;
}

// The error itself for an EXR, its colours for a PNG.
std::vector<float> flip_map(const std::string& path, const Flip& flip, const std::vector<bool>& counts) {
  std::vector<float> rgb;
  if (has_ending(path, ".png")) {
    for (const std::uint8_t code : flip_map_rgb(flip.error, counts)) rgb.push_back(static_cast<float>(code) / 255.0f);
  } else {
    for (const float error : flip.error) rgb.insert(rgb.end(), 3, error);
  }
  return rgb;
}

// --- Report ---------------------------------------------------------------------------------------------------------

std::string sample_text(const PictureChannel& channel, std::size_t pixel) {
  const double value = channel.value(pixel);
  if (channel.type != SampleType::kFloat) return fmt::format("{:.0f}", value);
  return fmt::format("{} ({:a})", static_cast<float>(value), value);
}

std::string summary(const Picture& a, const Picture& b, const Difference& d, const std::optional<Flip>& flip) {
  if (d.pixels_differ == 0) return "equal\n";
  const auto width = static_cast<std::size_t>(a.width_px);
  const PictureChannel& ca = a.channels[d.first_channel];
  const PictureChannel& cb = b.channels[d.first_channel];
  return fmt::format("different\npixels {} of {}\nfirst {},{} {}: {} and {}\nmax_abs {}\npsnr_db {}\nflip {}\n",
                     d.pixels_differ, ca.bits.size(), d.first_pixel % width, d.first_pixel / width, ca.name,
                     sample_text(ca, d.first_pixel), sample_text(cb, d.first_pixel), d.max_abs,
                     std::isfinite(d.psnr_db) ? fmt::format("{:.4f}", d.psnr_db) : "none",
                     flip ? fmt::format("{:.6f}", flip->summary.mean) : "none");
}

Json report(const Picture& a, const Difference& d, const std::optional<Flip>& flip) {
  const auto width = static_cast<std::size_t>(a.width_px);
  Json json = Json::object();
  json["equal"] = d.pixels_differ == 0;
  json["pixels_differ"] = d.pixels_differ;
  json["max_abs"] = json_double(d.max_abs);
  json["first"] = nullptr;
  if (d.pixels_differ > 0) {
    json["first"] = {d.first_pixel % width, d.first_pixel / width, a.channels[d.first_channel].name};
  }
  json["flip"] = flip_json(flip);
  json["psnr_db"] = json_double(d.psnr_db);
  return json;
}

void check_map_name(const char* option, const std::optional<std::string>& name) {
  if (name && !has_ending(*name, ".png") && !has_ending(*name, ".exr")) {
    throw UsageError(fmt::format("{} '{}': not a picture's name; expected FILE.png or FILE.exr", option, *name));
  }
}

void check_arguments(const DiffArguments& arguments) {
  if (arguments.ppd) read_number("--ppd", *arguments.ppd, 1, 10000);
  check_map_name("--map", arguments.map);
  check_map_name("--flip-map", arguments.flip_map);
  const auto same = [](const auto& x, const auto& y) { return x && y && *x == *y; };
  if (same(arguments.map, arguments.json) || same(arguments.flip_map, arguments.json)) {
    throw UsageError(fmt::format("--json '{}': the map has that name; expected another", *arguments.json));
  }
  if (same(arguments.map, arguments.flip_map)) {
    throw UsageError(fmt::format("--flip-map '{}': the other map has that name; expected another", *arguments.map));
  }
}

// On the disk, not yet in its place.
std::unique_ptr<OutputFile> begin_map(const std::string& path, const Picture& size, const std::vector<float>& rgb) {
  auto map = std::make_unique<OutputFile>(path);
  write_map(map->stream(), path, size.width_px, size.height_px, rgb);
  map->finish();
  return map;
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
  const bool text = arguments.json != "-" && !arguments.quiet;
  std::optional<Flip> flip;
  if (text || arguments.json || arguments.flip_map) flip = flip_pictures(arguments, a, b, counts);

  std::unique_ptr<OutputFile> map, colors;
  if (arguments.map) map = begin_map(*arguments.map, a, difference_map(a, b, counts));
  if (arguments.flip_map) {
    if (!flip) throw Error(fmt::format("{}: has no red, green and blue; expected them for --flip-map", arguments.a));
    colors = begin_map(*arguments.flip_map, a, flip_map(*arguments.flip_map, *flip, counts));
  }
  if (arguments.json) write_text(*arguments.json, json_text(report(a, difference, flip)));
  if (map) map->commit();
  if (colors) colors->commit();
  if (text) write_stdout(summary(a, b, difference, flip));
  return difference.pixels_differ == 0 ? kExitEqual : kExitDifferent;
}

}  // namespace shoal::app
