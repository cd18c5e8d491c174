// A small pool of worker threads that spins briefly between the stages of a frame and then parks.
#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>

namespace shoal {

class ThreadPool {
 public:
  //   threads  1 to 256, the caller included: threads - 1 workers are started
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const { return threads_; }

  // Calls task(index, thread) once for each index in [0, count), on any thread (0 to threads() - 1, the caller is 0),
  // in any order, each on its own; returns when all are done. The first exception thrown by a task is thrown again
  // here. Not reentrant. The floating-point mode is Shoal's inside of the tasks (core/float_mode.h).
  template <class Task>
  void for_each(std::size_t count, Task&& task) {
    using Callable = std::remove_reference_t<Task>;
    run(count, const_cast<void*>(static_cast<const void*>(&task)),
        [](void* context, std::size_t index, int thread) { (*static_cast<Callable*>(context))(index, thread); });
  }

 private:
  using Invoke = void (*)(void* context, std::size_t index, int thread);
  void run(std::size_t count, void* context, Invoke invoke);

  struct Shared;
  int threads_;
  std::unique_ptr<Shared> shared_;
};

// Number of processors that this process may use, at least 1.
int available_threads();

}  // namespace shoal
