// The shape of a glTF file's JSON, checked before anything is made of it.
#pragma once

#include <nlohmann/json.hpp>

#include "scene/gltf/internal.h"

namespace shoal::gltf {

// Checks every property that Shoal or the parser reads: type, range, that an index has something to point at, that byte
// ranges lie in their buffers, that nodes form trees. Whole numbers written as 3.0 become integers. Throws Error.
void check_schema(Document& document, nlohmann::json& root);

}  // namespace shoal::gltf
