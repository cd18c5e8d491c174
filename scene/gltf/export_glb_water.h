// A body of water as extras.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "scene/scene.h"

namespace shoal {

// What `extras.water` says of a body: read back, the same bits.
nlohmann::ordered_json water_json(const WaterSpec& water);

}  // namespace shoal
