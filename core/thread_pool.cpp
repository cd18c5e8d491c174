#include "core/thread_pool.h"

#include <sched.h>

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "core/float_mode.h"

namespace shoal {

namespace {
// About 20 to 50 microseconds: longer than the gap between two stages, shorter than anyone notices.
constexpr int kSpins = 4000;

void relax() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#else
  asm volatile("yield");
#endif
}
}  // namespace

// One job at a time. A generation number announces it; `next` hands out indices; `busy` counts the workers inside.
struct ThreadPool::Shared {
  std::mutex mutex;
  std::condition_variable wake, done;
  std::atomic<std::uint64_t> generation{0};
  std::atomic<bool> stop{false};
  std::atomic<int> busy{0};

  std::atomic<std::size_t> next{0};
  std::size_t count = 0;
  void* context = nullptr;
  Invoke invoke = nullptr;
  std::exception_ptr error;  // guarded by mutex

  std::vector<std::thread> workers;

  void work(int thread) {
    const FloatModeGuard mode;
    for (;;) {
      const std::size_t index = next.fetch_add(1, std::memory_order_relaxed);
      if (index >= count) return;
      try {
        invoke(context, index, thread);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!error) error = std::current_exception();
        next.store(count, std::memory_order_relaxed);
      }
    }
  }

  void worker_main(int thread) {
    std::uint64_t seen = 0;
    for (;;) {
      for (int i = 0; i < kSpins && generation.load(std::memory_order_acquire) == seen && !stop.load(); ++i) relax();
      if (generation.load(std::memory_order_acquire) == seen) {
        std::unique_lock lock(mutex);
        wake.wait(lock, [&] { return generation.load(std::memory_order_acquire) != seen || stop.load(); });
      }
      if (stop.load()) return;
      seen = generation.load(std::memory_order_acquire);
      work(thread);
      if (busy.fetch_sub(1, std::memory_order_acq_rel) == 1) {
        const std::lock_guard lock(mutex);
        done.notify_one();
      }
    }
  }
};

ThreadPool::ThreadPool(int threads) : threads_(threads), shared_(std::make_unique<Shared>()) {
  for (int i = 1; i < threads; ++i) shared_->workers.emplace_back([this, i] { shared_->worker_main(i); });
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard lock(shared_->mutex);
    shared_->stop.store(true);
  }
  shared_->wake.notify_all();
  for (std::thread& worker : shared_->workers) worker.join();
}

void ThreadPool::run(std::size_t count, void* context, Invoke invoke) {
  Shared& s = *shared_;
  s.count = count;
  s.context = context;
  s.invoke = invoke;
  s.error = nullptr;
  s.next.store(0, std::memory_order_relaxed);
  if (threads_ > 1 && count > 1) {
    s.busy.store(threads_ - 1, std::memory_order_relaxed);
    {
      const std::lock_guard lock(s.mutex);
      s.generation.fetch_add(1, std::memory_order_acq_rel);
    }
    s.wake.notify_all();
    s.work(0);
    for (int i = 0; i < kSpins && s.busy.load(std::memory_order_acquire) != 0; ++i) relax();
    if (s.busy.load(std::memory_order_acquire) != 0) {
      std::unique_lock lock(s.mutex);
      s.done.wait(lock, [&] { return s.busy.load(std::memory_order_acquire) == 0; });
    }
  } else {
    s.work(0);
  }
  if (s.error) std::rethrow_exception(s.error);
}

int available_threads() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) == 0) {
    const int n = CPU_COUNT(&set);
    if (n > 0) return n;
  }
  const unsigned n = std::thread::hardware_concurrency();
  return n > 0 ? static_cast<int>(n) : 1;
}

}  // namespace shoal
