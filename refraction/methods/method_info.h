// Descriptions of the methods, for users of the library.
#pragma once

#include <string>
#include <vector>

#include "refraction/data/reflections.h"

namespace shoal {

// Registry of methods (refraction/methods/methods.def), in its order.
struct MethodOptionInfo {
  std::string key;
  std::string default_value;  // as it would be given
  std::string range;          // what is allowed, in words
  std::string meaning;        // one sentence without its full stop
};
struct MethodInfo {
  const char* name;
  const char* category;     // raster, volume, hybrid, traced
  Reflections reflections;  // by default
  const char* description;
  const char* source;
  std::vector<MethodOptionInfo> options;
};
const std::vector<MethodInfo>& method_infos();

}  // namespace shoal
