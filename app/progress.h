// A line on the terminal for long work: what is done and how long the rest takes.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace shoal::app {

// Writes to standard error, and only where that is a terminal. The line is gone at the end.
class Progress {
 public:
  //   what   of one step, for the reader: "frame"
  //   total  steps in all
  Progress(std::string what, std::int64_t total, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void step_done();

 private:
  using Clock = std::chrono::steady_clock;

  void show();
  void clear();

  std::string what_;
  std::int64_t total_ = 0, done_ = 0;
  bool shown_ = false;
  Clock::time_point begin_, last_shown_;
};

}  // namespace shoal::app
