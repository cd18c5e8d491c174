// One stage of a frame: runs its work on all threads, adds the digests of what it wrote, and takes its time.
#pragma once

#include <chrono>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "core/thread_pool.h"
#include "refraction/data/stage_digests.h"

namespace shoal {

// Wall time by stage of a frame. All threads work on one stage at a time, so a stage's wall time is the sum over the
// threads (waiting at its end included) divided by the threads.
class StageClock {
 public:
  using Clock = std::chrono::steady_clock;
  void reset() {
    stages_.clear();
    skipped_ms_ = 0;
    start_ = last_ = Clock::now();
  }
  // The time since the last call belongs to this stage.
  void lap(const char* stage) { add(stage, since_last()); }
  // The time since the last call belongs to several stages that ran region by region, in proportion to their shares.
  template <std::size_t n>
  void lap(const std::pair<const char*, double> (&shares)[n]) {
    const double ms = since_last();
    double sum = 0;
    for (const auto& [stage, share] : shares) sum += share;
    for (const auto& [stage, share] : shares)
      if (share > 0) add(stage, ms * share / sum);
  }
  // Time that belongs to no stage (digests) is left out.
  void skip() { skipped_ms_ += since_last(); }
  double total_ms() const { return std::chrono::duration<double, std::milli>(last_ - start_).count() - skipped_ms_; }
  const std::vector<std::pair<std::string, double>>& stages() const { return stages_; }

 private:
  double since_last() {
    const Clock::time_point now = Clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return ms;
  }
  void add(const char* stage, double ms) {
    for (auto& entry : stages_)
      if (entry.first == stage) {
        entry.second += ms;
        return;
      }
    stages_.emplace_back(stage, ms);
  }

  Clock::time_point start_, last_;
  double skipped_ms_ = 0;
  std::vector<std::pair<std::string, double>> stages_;
};

// What stages run with.
struct Run {
  ThreadPool& pool;
  StageClock& clock;
  StageDigests* digests;  // null: none are wanted

  // Adds the digests of targets, by their names, outside of the stages' time.
  void digest(std::initializer_list<const char*> names) const {
    if (digests == nullptr) return;
    for (const char* name : names) digests->add(name);
    clock.skip();
  }
};

// The scope of a stage: its time ends where the scope does.
class Stage {
 public:
  Stage(const Run& run, const char* name) : run_(run), name_(name) {}
  ~Stage() { run_.clock.lap(name_); }
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  // Calls body(i) for each i below count, on all threads.
  template <class Body>
  void for_each(std::size_t count, Body body) {
    run_.pool.for_each(count, [&](std::size_t i, int) { body(i); });
  }
  // The same with the number of the thread.
  template <class Body>
  void for_each_on_thread(std::size_t count, Body body) {
    run_.pool.for_each(count, body);
  }

 private:
  const Run& run_;
  const char* name_;
};

}  // namespace shoal
