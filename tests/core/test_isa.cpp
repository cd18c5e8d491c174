// Names of instruction sets, and what this machine supports.
#include "core/isa.h"

#include <algorithm>
#include <fstream>
#include <string>

#include <catch2/catch.hpp>

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

TEST_CASE("supported isas are best first and end with scalar") {
  const std::vector<Isa> isas = shoal::supported_isas();
  REQUIRE(!isas.empty());
  CHECK(isas.back() == Isa::kScalar);
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
#elif defined(__aarch64__)
  CHECK(isas.front() == Isa::kNeon);
#endif
}
