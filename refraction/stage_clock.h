// Wall time by stage of a frame. Every thread works on one stage at a time, so a stage's wall time is the sum over the
// threads (waiting at its end included) divided by the threads.
#pragma once

#include <chrono>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace shoal {

class StageClock {
 public:
  using Clock = std::chrono::steady_clock;
  void start() {
    stages_.clear();
    start_ = last_ = Clock::now();
  }
  // The time since the last call (or start) belongs to this stage.
  void lap(const char* stage) {
    const Clock::time_point now = Clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    for (auto& entry : stages_) {
      if (entry.first == stage) {
        entry.second += ms;
        return;
      }
    }
    stages_.emplace_back(stage, ms);
  }
  // Time that belongs to no stage (digests) is left out.
  void skip() {
    const Clock::time_point now = Clock::now();
    skipped_ms_ += std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
  }
  double total_ms() const { return std::chrono::duration<double, std::milli>(last_ - start_).count() - skipped_ms_; }
  const std::vector<std::pair<std::string, double>>& stages() const { return stages_; }
  void reset() {
    skipped_ms_ = 0;
    start();
  }

 private:
  Clock::time_point start_, last_;
  double skipped_ms_ = 0;
  std::vector<std::pair<std::string, double>> stages_;
};

}  // namespace shoal
