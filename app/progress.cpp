#include "app/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace shoal::app {
namespace {

std::string duration_text(double seconds) {
  const auto s = static_cast<std::int64_t>(seconds + 0.5);
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return fmt::format("{} h {:02} min", s / 3600, s / 60 % 60);
}

}  // namespace

Progress::Progress(std::string what, std::int64_t total, bool quiet)
    : what_(std::move(what)), total_(total), begin_(Clock::now()), last_shown_(begin_) {
  shown_ = !quiet && total > 1 && isatty(STDERR_FILENO);
  if (shown_) show();
}

Progress::~Progress() {
  if (shown_) clear();
}

void Progress::step_done() {
  ++done_;
  const auto now = Clock::now();
  if (!shown_ || now - last_shown_ < std::chrono::milliseconds(100)) return;
  last_shown_ = now;
  show();
}

void Progress::show() {
  std::string line = fmt::format("\r\033[K{} {}/{}", what_, done_, total_);
  if (done_ > 0) {
    const double spent = std::chrono::duration<double>(Clock::now() - begin_).count();
    line += fmt::format(", {} left",
                        duration_text(spent / static_cast<double>(done_) * static_cast<double>(total_ - done_)));
  }
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
}

void Progress::clear() {
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
}

}  // namespace shoal::app
