// JSON as the command writes it: keys in a fixed order, floats by their shortest text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/load.h"
#include "app/options.h"
#include "refraction/renderer.h"

namespace shoal::app {

using Json = nlohmann::ordered_json;

// A float as the shortest number that reads back as it; null where it is not finite.
Json json_float(float value);
Json json_double(double value);
Json json_vector(Vec2f v);
Json json_vector(Vec3f v);

// The same values in hexadecimal notation, "0x1.8p+0": no digit is lost.
std::string hex_float(float value);
Json json_hex(const std::vector<float>& values);

// Indented text with a line break at its end. Text that is no UTF-8 is repaired.
std::string json_text(const Json& json);

// What this program was compiled with.
std::string compiler_name();

// What a run of frames took.
struct RunTimes {
  std::vector<double> frames_ms;
  std::vector<std::vector<std::pair<std::string, double>>> stages_ms;  // of each frame
  std::vector<std::string> frame_digests;
  double load_ms = 0, build_ms = 0, write_ms = 0;
};

double median(std::vector<double> values);

// The report of `render --json`: the order of its keys is part of the format.
Json render_report(const Options& options, const LoadedScene& loaded, const PlacedCamera& camera, int threads,
                   const Frame& first_frame, const RunTimes& times);

// Every option and water key in force.
Json settings_json(const Options& options, const LoadedScene& loaded, const PlacedCamera& camera, int threads);

// One body's water keys.
Json water_json(const WaterBody& body);

}  // namespace shoal::app
