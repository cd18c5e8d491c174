// Writes a body of water as extras of a node.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "scene/scene.h"

namespace shoal {

// Returns the value of `extras.water`. Reading it gives the same bits.
nlohmann::ordered_json water_json(const WaterSpec& water);

}  // namespace shoal
