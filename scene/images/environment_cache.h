// The cache of filtered environments on disk.
#pragma once

#include <memory>
#include <string>

#include "shading/environment/build.h"

namespace shoal {

// Returns the key of a cached environment, 32 hexadecimal digits: a digest of the picture and kEnvironmentVersion.
std::string environment_key(const EquirectImage& image);

// Returns null where the folder has no environment of that key, or a damaged one.
std::shared_ptr<const Environment> read_cached_environment(const std::string& folder, const std::string& key);

// Writes an environment beside its place, then renames it. A failure is ignored.
void write_cached_environment(const std::string& folder, const std::string& key, const Environment& environment);

}  // namespace shoal
