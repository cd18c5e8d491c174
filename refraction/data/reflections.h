// What rays show that water reflects (`--reflections`).
#pragma once

#include <cstdint>

namespace shoal {

// kEnvironment  the background alone; where the mirror is total (an eye under water) the scene: by the planar layer for
//               raster and volume methods, by rays for the others
// kPlanar       the scene, rasterized as the plane mirrors it; each method samples that layer by its own narrow phase
// kTraced       the scene, by rays against the BVH; where the layer is valid (flat water) it gives the hit
enum class Reflections : std::uint8_t { kEnvironment, kPlanar, kTraced };

}  // namespace shoal
