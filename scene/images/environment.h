// Reads a picture as the environment of a scene and caches the filtered result on disk.
#pragma once

#include <memory>
#include <string>

#include "shading/environment/environment.h"

namespace shoal {

class ThreadPool;

// Reads an equirectangular picture and filters it (shading/environment/build.h).
//
//   path     PNG or JPEG (sRGB, 1 is white), Radiance HDR or OpenEXR (linear); 8192 x 4096 texels at most
//   cache    folder of the cache, created where it is missing; empty: no cache
//   warning  receives one line where texels are negative, NaN or above 1e9; they are replaced by 0, or by 1e9
//
// Returns the same result with and without a cache: a cached file is used only if its digest shows that it is complete
// and belongs to this picture and this version; otherwise the environment is filtered again. A cache that cannot be
// written is no error.
// Throws Error for a file that cannot be read as a picture.
std::shared_ptr<const Environment> load_environment(const std::string& path, const std::string& cache, ThreadPool& pool,
                                                    std::string& warning);

// Returns $XDG_CACHE_HOME/shoal where that is an absolute path, else ~/.cache/shoal; empty without a home folder.
std::string default_cache_folder();

}  // namespace shoal
