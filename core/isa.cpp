#include "core/isa.h"

#include <algorithm>
#include <initializer_list>
#include <string>

#include "core/error.h"
#include "core/isa_dispatch.h"

namespace shoal {

namespace {

constexpr Isa kAll[] = {Isa::kScalar, Isa::kSse42, Isa::kAvx2, Isa::kAvx512, Isa::kNeon};

#define SHOAL_LIST_ISA(kind, isa_namespace, table, name) Isa::kind,
constexpr std::initializer_list<Isa> kBuilt = {SHOAL_BUILT_ISAS(SHOAL_LIST_ISA, unused, unused)};  // least first
#undef SHOAL_LIST_ISA

#if defined(__x86_64__)
// The builtin also checks that the operating system saves the wide registers.
bool runs_v2() {
  return __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("ssse3") && __builtin_cpu_supports("popcnt");
}
bool runs_v3() {
  return runs_v2() && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") &&
         __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("fma");
}
bool runs_v4() {
  return runs_v3() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
}
#endif

// Whether this machine runs it.
bool runs(Isa isa) {
  switch (isa) {
    case Isa::kScalar:
      return true;
#if defined(__x86_64__)
    case Isa::kSse42:
      return runs_v2();
    case Isa::kAvx2:
      return runs_v3();
    case Isa::kAvx512:
      return runs_v4();
#elif defined(__aarch64__)
    case Isa::kNeon:
      return true;
#endif
    default:
      return false;
  }
}

std::string names_of(const std::vector<Isa>& isas) {
  std::string names;
  for (const Isa isa : isas) names += (names.empty() ? "" : ", ") + std::string(isa_name(isa));
  return names;
}

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

bool is_built(Isa isa) { return std::find(kBuilt.begin(), kBuilt.end(), isa) != kBuilt.end(); }

std::vector<Isa> supported_isas() {
  std::vector<Isa> isas;
  for (const Isa isa : kBuilt)
    if (runs(isa)) isas.insert(isas.begin(), isa);
  return isas;
}

Isa best_isa() {
  const std::vector<Isa> isas = supported_isas();
  if (isas.empty()) throw Error("this machine runs no instruction set of this build, which has: " + names_of(kBuilt));
  return isas.front();
}

void throw_isa_not_built(Isa isa) {
  throw UsageError(std::string("isa '") + isa_name(isa) +
                   "': this build does not have it; expected one of: " + names_of(supported_isas()));
}

}  // namespace shoal
