// What the eye's ray shows at a water pixel.
#pragma once

#include <cstdint>

namespace shoal {

// kSky: the background; kMirror: a surface seen by total reflection; kMiss: the method found nothing where there may be
// something.
enum class HitKind : std::uint32_t { kNoWater = 0, kSurface = 1, kSky = 2, kMirror = 3, kMiss = 4 };

}  // namespace shoal
