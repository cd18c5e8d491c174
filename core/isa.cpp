#include "core/isa.h"

namespace shoal {

namespace {

constexpr Isa kAll[] = {Isa::kScalar, Isa::kSse42, Isa::kAvx2, Isa::kAvx512, Isa::kNeon};

#if defined(__x86_64__)
// The builtin also asks the operating system whether it saves the wide registers.
[[maybe_unused]] bool runs_v2() {
  return __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("ssse3") && __builtin_cpu_supports("popcnt");
}
[[maybe_unused]] bool runs_v3() {
  return runs_v2() && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") &&
         __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("fma");
}
[[maybe_unused]] bool runs_v4() {
  return runs_v3() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
}
#endif

}  // namespace

const char* isa_name(Isa isa) {
  switch (isa) {
    case Isa::kScalar:
      return "scalar";
    case Isa::kSse42:
      return "sse4.2";
    case Isa::kAvx2:
      return "avx2";
    case Isa::kAvx512:
      return "avx512";
    case Isa::kNeon:
      return "neon";
  }
  return "unknown";
}

std::optional<Isa> parse_isa(std::string_view name) {
  for (const Isa isa : kAll)
    if (name == isa_name(isa)) return isa;
  return std::nullopt;
}

std::vector<Isa> supported_isas() {
  std::vector<Isa> isas;
#if defined(SHOAL_BUILDS_AVX512)
  if (runs_v4()) isas.push_back(Isa::kAvx512);
#endif
#if defined(SHOAL_BUILDS_AVX2)
  if (runs_v3()) isas.push_back(Isa::kAvx2);
#endif
#if defined(SHOAL_BUILDS_SSE42)
  if (runs_v2()) isas.push_back(Isa::kSse42);
#endif
#if defined(SHOAL_BUILDS_NEON)
  isas.push_back(Isa::kNeon);
#endif
  isas.push_back(Isa::kScalar);
  return isas;
}

}  // namespace shoal
