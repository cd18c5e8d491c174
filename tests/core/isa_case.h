// Test cases that are compiled once an instruction set: the name carries the set, and a machine without it skips them.
#pragma once

#include <catch2/catch.hpp>

#include "core/wide/isa_select.h"

#if defined(SHOAL_ISA_AVX512)
#define SHOAL_ISA_TEXT "avx512"
#elif defined(SHOAL_ISA_AVX2)
#define SHOAL_ISA_TEXT "avx2"
#elif defined(SHOAL_ISA_SSE42)
#define SHOAL_ISA_TEXT "sse4.2"
#elif defined(SHOAL_ISA_NEON)
#define SHOAL_ISA_TEXT "neon"
#else
#define SHOAL_ISA_TEXT "scalar"
#endif

namespace {

bool machine_runs_this_isa() {
#if defined(SHOAL_ISA_AVX512)
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512cd");
#elif defined(SHOAL_ISA_AVX2)
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2");
#elif defined(SHOAL_ISA_SSE42)
  return __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt");
#else
  return true;
#endif
}

}  // namespace

#define SHOAL_ISA_CASE(function, name)                      \
  static void function();                                   \
  TEST_CASE(SHOAL_ISA_TEXT ": " name) {                     \
    if (!machine_runs_this_isa()) {                         \
      WARN("skipped: this machine has no " SHOAL_ISA_TEXT); \
      return;                                               \
    }                                                       \
    function();                                             \
  }                                                         \
  static void function()
