// core/: math on sixteen lanes, the thread pool between two stages, digests.
#include <vector>

#include "bench/harness.h"
#include "bench/kernels.h"
#include "core/digest.h"
#include "core/thread_pool.h"

namespace shoal::bench {

static void math(benchmark::State& state, const MathKernel& kernel) {
  constexpr std::size_t kCount = 2048;  // both arrays stay in the first-level cache
  AlignedArray<float> in(kCount), out(kCount);
  Random random;
  for (std::size_t i = 0; i < kCount; ++i) in[i] = random.between(kernel.lo, kernel.hi);
  for (auto _ : state) {
    kernel.run(in.data(), out.data(), kCount);
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
  count_items(state, "16lanes", kCount / 16);
}

// One stage of `tasks` empty tasks: with as many as threads, what a stage costs over its work.
static void stage(benchmark::State& state, std::size_t tasks, int threads) {
  ThreadPool pool(threads);
  for (auto _ : state) pool.for_each(tasks, [](std::size_t index, int) { benchmark::DoNotOptimize(index); });
  count_items(state, "task", static_cast<double>(tasks), threads);
}

static void digest(benchmark::State& state) {
  const std::vector<std::uint8_t> data(static_cast<std::size_t>(state.range(0)), 7);
  for (auto _ : state) benchmark::DoNotOptimize(digest_hex(data.data(), data.size()));
  state.counters["GB/s"] =
      benchmark::Counter(static_cast<double>(data.size()) * 1e-9, benchmark::Counter::kIsIterationInvariantRate);
}

void register_benchmarks() {
  const CoreKernels& kernels = core_kernels(isa());
  for (std::size_t i = 0; i < kernels.math_count; ++i)
    add(std::string("math/") + kernels.math[i].name + "/2048",
        [kernel = kernels.math[i]](auto& state) { math(state, kernel); });
  for (const std::size_t tasks : {std::size_t{2}, std::size_t{1000}})
    for (int threads = 1; threads <= pool_threads(); ++threads)
      add("pool/empty/" + std::to_string(tasks) + "/threads:" + std::to_string(threads), [=](auto& state) {
        stage(state, tasks, threads);
      })->UseRealTime();
  add("digest/bytes", digest)->Arg(4 << 10)->Arg(8 << 20);
}

}  // namespace shoal::bench
