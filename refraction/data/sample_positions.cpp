#include "refraction/data/sample_positions.h"

#include <cstdint>

namespace shoal {

Vec2f sample_position(int s, int n) {
  if (n <= 1) return {0, 0};
  // floor(2^32 / 1.3247179572...) and floor(2^32 / 1.3247179572...^2)
  constexpr std::uint32_t kStepX = 3242174889u, kStepY = 2447445414u;
  const std::uint32_t k = static_cast<std::uint32_t>(s) + 1u;
  const std::uint32_t x = 0x80000000u + k * kStepX, y = 0x80000000u + k * kStepY;
  return {static_cast<float>(static_cast<int>(x >> 24) - 128) / 256.0f,
          static_cast<float>(static_cast<int>(y >> 24) - 128) / 256.0f};
}

}  // namespace shoal
