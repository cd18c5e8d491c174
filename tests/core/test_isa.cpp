// Names of instruction sets, and what this machine supports.
#include "core/isa_dispatch.h"

#include <algorithm>
#include <fstream>
#include <string>

#include <catch2/catch.hpp>

#include "core/error.h"

using shoal::Isa;

TEST_CASE("isa names go both ways") {
  const Isa all[] = {Isa::kScalar, Isa::kSse42, Isa::kAvx2, Isa::kAvx512, Isa::kNeon};
  const std::string names[] = {"scalar", "sse4.2", "avx2", "avx512", "neon"};
  for (int i = 0; i < 5; ++i) {
    CHECK(shoal::isa_name(all[i]) == names[i]);
    CHECK(shoal::parse_isa(names[i]) == all[i]);
  }
  for (const char* word : {"", "AVX2", "sse42", "avx", "scalar ", "best"})
    CHECK_FALSE(shoal::parse_isa(word).has_value());
}

TEST_CASE("supported isas are best first and end with scalar where that is built") {
  const std::vector<Isa> isas = shoal::supported_isas();
  REQUIRE(!isas.empty());
  CHECK(shoal::best_isa() == isas.front());
  for (const Isa isa : isas) CHECK(shoal::is_built(isa));
#if defined(SHOAL_BUILDS_SCALAR)
  CHECK(isas.back() == Isa::kScalar);
#else
  CHECK(std::find(isas.begin(), isas.end(), Isa::kScalar) == isas.end());
  CHECK_FALSE(shoal::is_built(Isa::kScalar));
#endif
#if defined(__x86_64__)
  CHECK(std::is_sorted(isas.rbegin(), isas.rend()));
  CHECK(std::find(isas.begin(), isas.end(), Isa::kNeon) == isas.end());
  // The kernel's own list is the oracle.
  std::ifstream file("/proc/cpuinfo");
  std::string line;
  while (std::getline(file, line) && line.rfind("flags", 0) != 0) {
  }
  if (line.empty()) return;
  const auto has = [&line](const std::string& flag) {
    return (line + " ").find(" " + flag + " ") != std::string::npos;
  };
  const auto listed = [&isas](Isa isa) { return std::find(isas.begin(), isas.end(), isa) != isas.end(); };
#if defined(SHOAL_BUILDS_SSE42)
  CHECK(listed(Isa::kSse42) == (has("sse4_2") && has("popcnt")));
#endif
#if defined(SHOAL_BUILDS_AVX2)
  CHECK(listed(Isa::kAvx2) == (has("avx2") && has("bmi2") && has("fma")));
#endif
#if defined(SHOAL_BUILDS_AVX512)
  CHECK(listed(Isa::kAvx512) ==
        (has("avx512f") && has("avx512bw") && has("avx512cd") && has("avx512dq") && has("avx512vl")));
#endif
#elif defined(SHOAL_BUILDS_NEON)
  CHECK(isas.front() == Isa::kNeon);
#endif
}

// Tables as a room has them, filled here for each instruction set that is built.
namespace shoal_test {
struct Names {
  const char* name;
};
SHOAL_ISA_TABLE(Names, names)
#define SHOAL_TEST_NAMES(kind, isa_namespace, Table, unused) \
  const Table& names_##isa_namespace() {                     \
    static constexpr Table table{#isa_namespace};            \
    return table;                                            \
  }
SHOAL_BUILT_ISAS(SHOAL_TEST_NAMES, Names, unused)
}  // namespace shoal_test

TEST_CASE("isa dispatch gives each instruction set that is built its own table, and refuses the others") {
  const Isa all[] = {Isa::kScalar, Isa::kSse42, Isa::kAvx2, Isa::kAvx512, Isa::kNeon};
  const char* const names[] = {"isa_scalar", "isa_sse42", "isa_avx2", "isa_avx512", "isa_neon"};
  int built = 0;
  for (int i = 0; i < 5; ++i) {
    CAPTURE(names[i]);
    if (shoal::is_built(all[i])) {
      ++built;
      CHECK(shoal_test::names(all[i]).name == std::string(names[i]));
    } else {
      CHECK_THROWS_AS(shoal_test::names(all[i]), shoal::UsageError);
    }
  }
  CHECK(built > 0);
  CHECK(built < 5);  // no build has x86 and NEON
}
