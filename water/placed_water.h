// A body of water at one time.
#pragma once

#include <cstdint>

#include "water/body.h"
#include "water/surface_data.h"

namespace shoal {

// Both pointers outlive the view that holds them.
struct PlacedWater {
  const WaterBody* body = nullptr;
  const WaterSurface* surface = nullptr;  // at this time; null where the body is flat
  std::int32_t index = 0;                 // of the body in the scene
};

}  // namespace shoal
