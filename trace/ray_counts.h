// How many rays a frame traced, by kind.
#pragma once

#include <atomic>
#include <cstdint>

namespace shoal {

// The sum over all samples and threads.
struct RayCounts {
  enum Kind { kPrimary, kReflected, kRefracted, kShadow, kKinds };
  std::uint64_t of[kKinds] = {};
};
inline constexpr const char* kRayNames[RayCounts::kKinds] = {"primary", "reflected", "refracted", "shadow"};

// Adds to a count that several threads add to. Exact (tests/refraction/test_ray_traced.cpp).
inline void count_rays(RayCounts& counts, RayCounts::Kind kind, std::uint64_t rays) {
  std::atomic_ref<std::uint64_t>(counts.of[kind]).fetch_add(rays, std::memory_order_relaxed);
}

}  // namespace shoal
