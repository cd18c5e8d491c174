#include "scene/images/environment.h"

#include <cstdlib>
#include <filesystem>

#include "core/float_mode.h"
#include "core/thread_pool.h"
#include "scene/images/environment_cache.h"
#include "scene/images/images.h"

namespace shoal {
namespace {

constexpr ImageLimits kLimits{8192, std::uint64_t{8192} * 4096};
constexpr float kMaxRadiance = 1e9f;

// Replaces radiances that are negative, NaN or above kMaxRadiance. Returns the number of texels with one.
std::size_t clamp_radiance(std::vector<float>& rgb) {
  std::size_t replaced = 0;
  for (std::size_t i = 0; i + 2 < rgb.size(); i += 3) {
    bool odd = false;
    for (std::size_t c = i; c < i + 3; ++c) {
      if (rgb[c] >= 0 && rgb[c] <= kMaxRadiance) continue;
      odd = true;
      rgb[c] = rgb[c] > kMaxRadiance ? kMaxRadiance : 0.0f;
    }
    if (odd) ++replaced;
  }
  return replaced;
}

}  // namespace

std::shared_ptr<const Environment> load_environment(const std::string& path, const std::string& cache, ThreadPool& pool,
                                                    std::string& warning) {
  const FloatModeGuard mode;
  LinearImage decoded = decode_linear(read_image_file(path), path, kLimits);
  EquirectImage image{decoded.width, decoded.height, std::move(decoded.rgb)};
  warning.clear();
  if (const std::size_t replaced = clamp_radiance(image.rgb); replaced != 0) {
    warning = std::to_string(replaced) + " texels are negative or no numbers (they count as 0) or above 1e9 (as that)";
  }
  if (cache.empty()) return std::make_shared<const Environment>(make_environment(image, pool));
  const std::string key = environment_key(image);
  if (auto kept = read_cached_environment(cache, key)) return kept;
  auto made = std::make_shared<const Environment>(make_environment(image, pool));
  write_cached_environment(cache, key, *made);
  return made;
}

std::string default_cache_folder() {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::filesystem::path(value != nullptr ? value : "");
  };
  // The XDG base directory specification: a path that is not absolute is ignored.
  if (const auto base = variable("XDG_CACHE_HOME"); base.is_absolute()) return (base / "shoal").string();
  const auto home = variable("HOME");
  return home.is_absolute() ? (home / ".cache" / "shoal").string() : std::string();
}

}  // namespace shoal
