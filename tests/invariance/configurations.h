// The configurations over which digests must not change: every instruction set, count of threads and tile size that a
// program's options name, each with a file of its own.
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/error.h"
#include "core/isa.h"
#include "refraction/renderer.h"

namespace invariance {

struct Configurations {
  std::vector<shoal::Isa> isas{shoal::best_isa()};
  std::vector<int> threads{shoal::FrameSettings().threads};
  std::vector<int> tiles{shoal::FrameSettings().tile_px};
  std::string folder;  // where each configuration gets a file ISA-THREADS-TILE; empty: one configuration, to stdout
};

template <class Number>
Number parse_number(std::string_view option, std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) {
    throw shoal::UsageError(std::string(option) + ": '" + std::string(text) + "' is no number");
  }
  return value;
}

// The parts of a text between its commas.
inline std::vector<std::string_view> split(std::string_view text) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t comma = text.find(',');
    parts.push_back(text.substr(0, comma));
    if (comma == std::string_view::npos) return parts;
    text.remove_prefix(comma + 1);
  }
}

// Reads `--isa A,B`, `--threads N,M`, `--tile N,M` or `--out FOLDER`; false for any other option. Throws UsageError.
inline bool parse_configurations(std::string_view option, std::string_view value, Configurations& configurations) {
  if (option == "--out") {
    configurations.folder = value;
  } else if (option == "--isa") {
    configurations.isas.clear();
    for (const std::string_view name : split(value)) {
      const auto isa = shoal::parse_isa(name);
      if (!isa) throw shoal::UsageError("--isa: no instruction set '" + std::string(name) + "'");
      configurations.isas.push_back(*isa);
    }
  } else if (option == "--threads" || option == "--tile") {
    std::vector<int>& numbers = option == "--tile" ? configurations.tiles : configurations.threads;
    numbers.clear();
    for (const std::string_view text : split(value)) numbers.push_back(parse_number<int>(option, text));
  } else {
    return false;
  }
  return true;
}

// Calls `draw` for each configuration with settings that differ in nothing else, and the file that its lines go to.
// Throws UsageError for several configurations without a folder, Error where a file cannot be written.
inline void for_each_configuration(const Configurations& configurations, shoal::FrameSettings settings,
                                   const std::function<void(const shoal::FrameSettings&, std::FILE*)>& draw) {
  const std::size_t count = configurations.isas.size() * configurations.threads.size() * configurations.tiles.size();
  if (count != 1 && configurations.folder.empty()) throw shoal::UsageError("several configurations: expected --out");
  for (const shoal::Isa isa : configurations.isas) {
    for (const int threads : configurations.threads) {
      for (const int tile : configurations.tiles) {
        settings.isa = isa, settings.threads = threads, settings.tile_px = tile;
        if (configurations.folder.empty()) {
          draw(settings, stdout);
          continue;
        }
        const std::string path = configurations.folder + "/" + shoal::isa_name(isa) + "-" + std::to_string(threads) +
                                 "-" + std::to_string(tile);
        std::FILE* file = std::fopen(path.c_str(), "w");
        if (file == nullptr) throw shoal::Error(path + ": cannot be written; expected a folder that exists");
        draw(settings, file);
        if (std::fclose(file) != 0) throw shoal::Error(path + ": cannot be written; expected room on the disk");
      }
    }
  }
}

// A line a stage and a picture, each behind `prefix`.
inline void print_digests(std::FILE* out, const std::string& prefix, const shoal::Frame& frame) {
  for (const auto& [stage, hex] : frame.digests)
    std::fprintf(out, "%s %s %s\n", prefix.c_str(), stage.c_str(), hex.c_str());
  std::fprintf(out, "%s picture %s\n", prefix.c_str(), shoal::picture_digest(frame).c_str());
}

// The instruction sets of this machine, one a line.
inline void print_isas() {
  for (const shoal::Isa isa : shoal::supported_isas()) std::printf("%s\n", shoal::isa_name(isa));
}

}  // namespace invariance
