// Floating-point mode guard: round to nearest, denormals kept, exceptions masked.
//
// Set on entry of every worker and of the caller, and restored on leaving: a host program may have set flush-to-zero or
// another rounding mode, and both change bits.
#pragma once

#include <cstdint>

namespace shoal {

class FloatModeGuard {
 public:
  FloatModeGuard();
  ~FloatModeGuard();
  FloatModeGuard(const FloatModeGuard&) = delete;
  FloatModeGuard& operator=(const FloatModeGuard&) = delete;

 private:
  std::uint64_t saved_;
};

}  // namespace shoal
