#include "core/float_mode.h"

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace shoal {

#if defined(__x86_64__)
namespace {
constexpr unsigned kDefaultMxcsr = 0x1F80;  // nearest, all exceptions masked, FTZ and DAZ off
}
FloatModeGuard::FloatModeGuard() : saved_(_mm_getcsr()) { _mm_setcsr(kDefaultMxcsr); }
FloatModeGuard::~FloatModeGuard() { _mm_setcsr(static_cast<unsigned>(saved_)); }
#elif defined(__aarch64__)
FloatModeGuard::FloatModeGuard() {
  asm volatile("mrs %0, fpcr" : "=r"(saved_));
  const std::uint64_t nearest_with_denormals = 0;
  asm volatile("msr fpcr, %0" : : "r"(nearest_with_denormals));
}
FloatModeGuard::~FloatModeGuard() { asm volatile("msr fpcr, %0" : : "r"(saved_)); }
#else
#error "Shoal does not know this architecture's floating-point control register"
#endif

}  // namespace shoal
