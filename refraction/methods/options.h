// A method's options: `--set KEY=VALUE` as numbers.
#pragma once

#include <map>
#include <string>

#include "refraction/kernels.h"

namespace shoal {

// Reads the options given into values[i], i the place in the method's list, the others from their defaults.
// Throws UsageError for a key that the method does not have, and for a value that is not of its kind or out of range.
void read_method_options(const Method& method, const std::map<std::string, std::string>& given,
                         float (&values)[kMaxMethodOptions]);

}  // namespace shoal
