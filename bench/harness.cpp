#include "bench/harness.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "core/thread_pool.h"

namespace shoal::bench {

namespace {

Isa chosen_isa{};  // set by take_isa
double measured_hz = 0;

// Long enough for a sleeping core to speed up, in runs short enough that some are not interrupted.
double measure_clock_hz() {
  using Clock = std::chrono::steady_clock;
  constexpr int kAdditions = 1 << 16, kRuns = 10000;
  double best = 0;
  std::uint64_t x = 1;
  for (int run = 0; run < kRuns; ++run) {
    const auto begin = Clock::now();
    for (int i = 0; i < kAdditions / 64; ++i) {
      for (int k = 0; k < 64; ++k) {
        x += 3;
        asm volatile("" : "+r"(x));  // neither merged nor moved: each addition waits for the one before
      }
    }
    best = std::max(best, kAdditions / std::chrono::duration<double>(Clock::now() - begin).count());
  }
  return best;
}

// A line a benchmark: the median of its repetitions, their coefficient of variation, the counters' medians.
class MedianTable : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override {
    std::printf("| benchmark | median | spread | counters |\n| --- | ---: | ---: | --- |\n");
    return true;
  }

  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.error_occurred) {
        std::printf("| %s | failed: %s | | |\n", run.benchmark_name().c_str(), run.error_message.c_str());
      } else if (run.aggregate_name == "median" || (run.run_type == Run::RT_Iteration && run.repetitions < 2)) {
        print(run, runs);
      }
    }
    std::fflush(stdout);
  }

 private:
  static bool on_wall_clock(const Run& run) { return run.benchmark_name().find("/real_time") != std::string::npos; }
  static double time_of(const Run& run) {
    return on_wall_clock(run) ? run.GetAdjustedRealTime() : run.GetAdjustedCPUTime();
  }

  static void print(const Run& run, const std::vector<Run>& runs) {
    std::string name = run.run_name.str();
    for (const char* ending : {"/real_time", "/manual_time"}) {
      const std::size_t at = name.find(ending);
      if (at != std::string::npos) name.erase(at);
    }
    std::printf("| %s | %.4g %s | ", name.c_str(), time_of(run), benchmark::GetTimeUnitString(run.time_unit));
    for (const Run& other : runs)
      if (other.aggregate_name == "cv" && other.run_name.str() == run.run_name.str())
        std::printf("%.1f %%", 100.0 * (on_wall_clock(run) ? other.real_accumulated_time : other.cpu_accumulated_time));
    std::printf(" | ");
    const char* separator = "";
    for (const auto& [key, counter] : run.counters) {
      std::printf("%s%s %.4g", separator, key.c_str(), static_cast<double>(counter));
      separator = ", ";
    }
    std::printf(" |\n");
  }
};

}  // namespace

Isa isa() { return chosen_isa; }
int pool_threads() { return std::min(2, available_threads()); }
double clock_hz() { return measured_hz; }

void count_items(benchmark::State& state, const std::string& what, double work_items, int threads) {
  using Counter = benchmark::Counter;
  state.counters["M" + what + "/s"] = Counter(work_items * 1e-6, Counter::kIsIterationInvariantRate);
  state.counters["cycles/" + what] =
      Counter(work_items / (clock_hz() * threads), Counter::kIsIterationInvariantRate | Counter::kInvert);
}

// Takes --isa=NAME out of the arguments; false where it names nothing that runs here.
static bool take_isa(std::vector<char*>& arguments) {
  chosen_isa = best_isa();
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    if (std::strncmp(arguments[i], "--isa=", 6) != 0) continue;
    const std::optional<Isa> named = parse_isa(arguments[i] + 6);
    const std::vector<Isa> supported = supported_isas();
    if (!named || std::find(supported.begin(), supported.end(), *named) == supported.end()) return false;
    chosen_isa = *named;
    arguments.erase(arguments.begin() + static_cast<std::ptrdiff_t>(i));
    --i;
  }
  return true;
}

static int run(int count, char** values) {
  // Ours first, so that the caller's win.
  static char repetitions[] = "--benchmark_repetitions=9";
  static char min_time[] = "--benchmark_min_time=0.2";
  std::vector<char*> arguments = {values[0], repetitions, min_time};
  arguments.insert(arguments.end(), values + 1, values + count);
  if (!take_isa(arguments)) {
    std::fprintf(stderr, "%s: --isa: expected one that this machine runs (shoal list isas)\n", values[0]);
    return 2;
  }
  measured_hz = measure_clock_hz();
  int left = static_cast<int>(arguments.size());
  arguments.push_back(nullptr);
  benchmark::Initialize(&left, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(left, arguments.data())) return 2;
  char clock[32];
  std::snprintf(clock, sizeof clock, "%.3f", measured_hz * 1e-9);
  benchmark::AddCustomContext("isa", isa_name(chosen_isa));
  benchmark::AddCustomContext("clock_ghz", clock);
  std::printf("isa %s, %s GHz (dependent additions), stages on %d threads\n\n", isa_name(chosen_isa), clock,
              pool_threads());
  register_benchmarks();
  MedianTable table;
  benchmark::RunSpecifiedBenchmarks(&table);
  benchmark::Shutdown();
  const double drift = measure_clock_hz() / measured_hz;
  if (drift < 0.97 || drift > 1.03)
    std::printf("\nThe clock was %.3f GHz at the start and is %.3f GHz now: the cycles above are off by as much.\n",
                measured_hz * 1e-9, measured_hz * drift * 1e-9);
  return 0;
}

}  // namespace shoal::bench

int main(int count, char** values) { return shoal::bench::run(count, values); }
