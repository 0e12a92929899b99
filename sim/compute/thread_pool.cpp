#include "sim/compute/thread_pool.h"

#include <algorithm>
#include <stdexcept>

namespace fude {
namespace {

constexpr int spins = 4000;   // some microseconds
constexpr int yields = 2000;  // about a millisecond on an idle machine

inline void relax() { __builtin_ia32_pause(); }

}  // namespace

ThreadPool::ThreadPool(int threads) {
  if (threads < 1) throw std::invalid_argument("a thread pool needs at least one thread");
  for (int i = 1; i < threads; ++i) workers_.emplace_back([this] { serve(); });
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    round_.fetch_add(1, std::memory_order_release);
  }
  woken_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void ThreadPool::run(std::size_t count, Call call, const void* context) {
  if (count == 0) return;
  call_ = call;
  context_ = context;
  count_ = count;
  next_.store(0, std::memory_order_relaxed);
  busy_.store(static_cast<int>(workers_.size()), std::memory_order_relaxed);
  if (!workers_.empty()) {
    // The lock orders this round after a worker that is about to sleep.
    {
      const std::lock_guard lock(mutex_);
      round_.fetch_add(1, std::memory_order_release);
    }
    woken_.notify_all();
  }
  drain();
  for (int i = 0; busy_.load(std::memory_order_acquire) != 0; ++i) {
    if (i < spins)
      relax();
    else
      std::this_thread::yield();
  }
}

void ThreadPool::drain() {
  // Runs of neighbours, short enough that no thread waits long for the last one.
  const std::size_t run = std::max<std::size_t>(1, count_ / (8 * static_cast<std::size_t>(threads())));
  for (std::size_t first; (first = next_.fetch_add(run, std::memory_order_relaxed)) < count_;)
    for (std::size_t i = first; i < std::min(first + run, count_); ++i) call_(context_, i);
}

unsigned ThreadPool::await_round(unsigned last) {
  for (int i = 0; i < spins + yields; ++i) {
    const unsigned round = round_.load(std::memory_order_acquire);
    if (round != last) return round;
    if (i < spins)
      relax();
    else
      std::this_thread::yield();
  }
  std::unique_lock lock(mutex_);
  woken_.wait(lock, [&] { return round_.load(std::memory_order_acquire) != last; });
  return round_.load(std::memory_order_acquire);
}

void ThreadPool::serve() {
  unsigned round = 0;
  for (;;) {
    round = await_round(round);
    if (stopping_) return;
    drain();
    busy_.fetch_sub(1, std::memory_order_release);
  }
}

}  // namespace fude
