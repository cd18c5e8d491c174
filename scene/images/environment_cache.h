// Filtered environments on disk.
#pragma once

#include <memory>
#include <string>

#include "shading/environment/build.h"

namespace shoal {

// What a cached result depends on, in 32 hexadecimal digits: the picture's numbers and kEnvironmentVersion.
std::string environment_key(const EquirectImage& image);

// Null where the folder has none of that key, or one that is damaged.
std::shared_ptr<const Environment> read_cached_environment(const std::string& folder, const std::string& key);

// Written beside its place, then renamed. Silent where it cannot be.
void write_cached_environment(const std::string& folder, const std::string& key, const Environment& environment);

}  // namespace shoal
