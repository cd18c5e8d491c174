// What every suite shares: its main, the ISA and the clock that it measures with, and its counters.
#pragma once

#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include "core/isa.h"

namespace shoal::bench {

// Each suite defines it and registers its benchmarks in it, as stage/scene/size.
void register_benchmarks();

// --isa NAME of the program's command line, by default the best that this machine runs.
Isa isa();

// Threads of the stages that run on a pool: two, where there are two. The targets of docs/PERFORMANCE.md are for two.
int pool_threads();

// Core clock while busy, Hz: one dependent integer addition a cycle, the fastest of many short runs at start. Not the
// time stamp counter, whose rate is fixed and is not the core's.
double clock_hz();

// Counters "M<what>/s" and "cycles/<what>" of `work_items` a benchmark's iteration. The cycles are all threads'
// together: seconds x threads x clock_hz() / work_items.
void count_items(benchmark::State& state, const std::string& what, double work_items, int threads = 1);

// Benchmarks on one thread report CPU time, those on a pool the wall's.
template <class Function>
benchmark::internal::Benchmark* add(const std::string& name, Function function) {
  return benchmark::RegisterBenchmark(name.c_str(), function);
}
template <class Function>
benchmark::internal::Benchmark* add_pooled(const std::string& name, Function function) {
  return add(name, function)->UseRealTime()->Unit(benchmark::kMillisecond);
}

// Reproducible numbers in [0, 1).
class Random {
 public:
  float next() {
    state_ = state_ * 1664525u + 1013904223u;
    return static_cast<float>(state_ >> 8) * 0x1p-24f;
  }
  float between(float lo, float hi) { return lo + (hi - lo) * next(); }

 private:
  std::uint32_t state_ = 1;
};

}  // namespace shoal::bench
