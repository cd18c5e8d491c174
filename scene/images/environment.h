// A picture's file as the environment of a scene, kept filtered on disk from one run to the next.
#pragma once

#include <memory>
#include <string>

#include "shading/environment/environment.h"

namespace shoal {

class ThreadPool;

// Reads an equirectangular picture and filters it (shading/environment/build.h).
//
//   path     PNG or JPEG (sRGB, 1 is white), Radiance HDR or OpenEXR (linear); 8192 x 4096 texels at most
//   cache    folder for the filtered result, made where it is missing; empty: none
//   warning  receives one line where texels are negative, no numbers, infinite or above 1e9: they count as 0, or as 1e9
//
// The result is the same with and without the cache: a file there is taken only if it is of this picture, this version
// and whole, by its digest; any other is made anew. A cache that cannot be written is no error.
// Throws Error for a file that cannot be read as a picture.
std::shared_ptr<const Environment> load_environment(const std::string& path, const std::string& cache, ThreadPool& pool,
                                                    std::string& warning);

// $XDG_CACHE_HOME/shoal where that is an absolute path, else ~/.cache/shoal; empty where there is no home.
std::string default_cache_folder();

}  // namespace shoal
