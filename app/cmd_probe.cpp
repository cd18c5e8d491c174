// shoal probe: what every stage makes of one pixel, or of one world point.
#include <fmt/format.h>

#include <algorithm>

#include "app/commands.h"
#include "app/json_report.h"
#include "app/load.h"
#include "app/output.h"
#include "core/error.h"

namespace shoal::app {
namespace {

constexpr double kMaxCoordinate_m = 1e12;

struct PixelPx {
  int x = 0, y = 0;
};

PixelPx read_pixel(const std::string& text, const FrameSettings& frame) {
  const std::vector<std::string> parts = split(text, ',');
  if (parts.size() != 2) {
    throw UsageError(fmt::format("--pixel '{}': not understood; expected X,Y from the top left, 0,0 the first", text));
  }
  return {static_cast<int>(read_integer("--pixel X", parts[0], 0, frame.width_px - 1)),
          static_cast<int>(read_integer("--pixel Y", parts[1], 0, frame.height_px - 1))};
}

// A value under its name, its digits and, for floats, its bits.
class Values {
 public:
  Values() { json = Json::object(); }

  // One number stands for itself, several are a list. Not a finite number: null, and its name in the hexadecimal list.
  void add(const std::string& name, const std::vector<float>& values) {
    Json decimal = Json::array();
    for (const float v : values) decimal.push_back(json_float(v));
    const Json hex = json_hex(values);
    json[name] = values.size() == 1 ? decimal[0] : decimal;
    json[name + "_hex"] = values.size() == 1 ? hex[0] : hex;
    text += fmt::format("{:<16} {}", name, fmt::join(values, " "));
    for (const float v : values) text += " " + hex_float(v);
    text += '\n';
  }
  void add_none(const std::string& name) {
    json[name] = nullptr;
    json[name + "_hex"] = nullptr;
    text += fmt::format("{:<16} none\n", name);
  }
  void add(const std::string& name, const std::vector<std::uint32_t>& values) {
    json[name] = values.size() == 1 ? Json(values[0]) : Json(values);
    text += fmt::format("{:<16} {}\n", name, fmt::join(values, " "));
  }
  void add_word(const std::string& name, const std::string& word) {
    json[name] = word;
    text += fmt::format("{:<16} {}\n", name, word);
  }

  Json json;
  std::string text;
};

template <class T>
std::vector<T> at_pixel(const std::vector<T>& samples, std::size_t pixel, std::size_t channels) {
  const auto first = samples.begin() + static_cast<std::ptrdiff_t>(pixel * channels);
  return {first, first + static_cast<std::ptrdiff_t>(channels)};
}

// The whole frame is drawn with every buffer kept: what a pixel shows depends on its neighbours' triangles.
Values probe_pixel(const Options& options, const RenderScene& scene, const Camera& camera, PixelPx pixel) {
  FrameSettings settings = options.frame;
  settings.keep_linear = true;
  for (const AovInfo& info : aov_infos()) settings.aovs |= 1u << static_cast<int>(info.aov);
  Renderer renderer(scene, settings);
  Frame frame;
  renderer.render(camera, options.time_s, frame);

  const std::size_t index =
      static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(frame.width_px) + static_cast<std::size_t>(pixel.x);
  Values values;
  values.add("pixel",
             std::vector<std::uint32_t>{static_cast<std::uint32_t>(pixel.x), static_cast<std::uint32_t>(pixel.y)});
  for (const AovInfo& info : aov_infos()) {
    const auto image =
        std::find_if(frame.aovs.begin(), frame.aovs.end(), [&](const auto& i) { return i.aov == info.aov; });
    if (image == frame.aovs.end()) continue;
    const auto channels = static_cast<std::size_t>(image->channels);
    if (info.is_uint) {
      values.add(info.name, at_pixel(image->uints, index, channels));
    } else {
      values.add(info.name, at_pixel(image->floats, index, channels));
    }
  }
  values.add("lit", at_pixel(frame.linear, index, 4));
  const std::vector<std::uint8_t> final8 = at_pixel(frame.srgb8, index, 3);
  values.add("final", std::vector<std::uint32_t>(final8.begin(), final8.end()));
  return values;
}

Values probe_world_point(const Options& options, const RenderScene& scene, const Camera& camera, Vec3f point) {
  const PointProbe probe = probe_point(scene, camera, options.frame.width_px, options.frame.height_px, point);
  const auto list = [](Vec3f v) { return std::vector<float>{v.x, v.y, v.z}; };
  Values values;
  values.add("world", list(probe.world));
  values.add("virtual", list(probe.virtual_world));
  if (probe.refracted) {
    values.add("crossing", list(probe.crossing_world));
  } else {
    values.add_none("crossing");
  }
  values.add("pixel", std::vector<float>{probe.pixel.x, probe.pixel.y});
  values.add("path_m", std::vector<float>{probe.path_m});
  values.add_word("side", probe.side);
  return values;
}

}  // namespace

int run_probe(const ProbeArguments& arguments) {
  if (arguments.pixel.has_value() == arguments.point.has_value()) {
    throw UsageError("probe: expected one of --pixel X,Y and --point X,Y,Z");
  }
  const Options options = read_options(arguments.options);
  PixelPx pixel;
  Vec3f point{0, 0, 0};
  if (arguments.pixel) pixel = read_pixel(*arguments.pixel, options.frame);
  if (arguments.point) point = read_triple("--point", *arguments.point, -kMaxCoordinate_m, kMaxCoordinate_m);

  LoadedScene loaded = load_scene(options.scene, options.quiet);
  loaded.scene = Scene{};
  update_render_scene(loaded.render, options.time_s);
  const Camera& camera = pick_camera(loaded.render, options.camera).camera;
  const Values values = arguments.pixel ? probe_pixel(options, loaded.render, camera, pixel)
                                        : probe_world_point(options, loaded.render, camera, point);
  if (options.json) write_text(*options.json, json_text(values.json));
  if (options.json != "-" && !options.quiet) write_stdout(values.text);
  return 0;
}

}  // namespace shoal::app
