// Threads for steps of a millisecond or two: they wait for work spinning, then yielding, then asleep, so
// that a step costs no system call while painting and an idle program costs no processor.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <thread>
#include <vector>

namespace fude {

class ThreadPool {
 public:
  // threads >= 1, the calling one included.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const { return static_cast<int>(workers_.size()) + 1; }

  // Calls work(i) once for every i in [0, count), in no fixed order, and returns when all are done. One
  // caller at a time; work must not throw.
  template <class Work>
  void for_each(std::size_t count, const Work& work) {
    run(
        count, [](const void* context, std::size_t i) { (*static_cast<const Work*>(context))(i); }, &work);
  }

 private:
  using Call = void (*)(const void* context, std::size_t index);

  void run(std::size_t count, Call call, const void* context);
  void serve();
  void drain();
  unsigned await_round(unsigned last);

  std::vector<std::thread> workers_;
  Call call_ = nullptr;
  const void* context_ = nullptr;
  std::size_t count_ = 0;
  bool stopping_ = false;
  alignas(64) std::atomic<std::size_t> next_{0};
  alignas(64) std::atomic<unsigned> round_{0};
  alignas(64) std::atomic<int> busy_{0};
  alignas(64) std::mutex mutex_;
  std::condition_variable woken_;
};

}  // namespace fude
