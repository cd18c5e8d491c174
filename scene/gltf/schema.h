// Checks the structure of a glTF file's JSON before the loader uses it.
#pragma once

#include <nlohmann/json.hpp>

#include "scene/gltf/internal.h"

namespace shoal::gltf {

// Checks every property that Shoal or the parser reads: its type and range, that an index refers to an existing
// element, that byte ranges lie inside their buffers, and that nodes form trees. Replaces whole numbers written as 3.0
// by integers. Throws
// Error.
void check_schema(Document& document, nlohmann::json& root);

}  // namespace shoal::gltf
