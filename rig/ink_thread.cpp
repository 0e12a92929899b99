#include "rig/ink_thread.h"

#include <chrono>
#include <iterator>
#include <utility>

namespace fude {
namespace {

constexpr int most_behind = 64;

}  // namespace

InkThread::InkThread(std::unique_ptr<Ink> ink)
    : ink_(std::move(ink)), step_s_(ink_->step_s()), thread_([this] { serve(); }) {}

InkThread::~InkThread() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  asked_.notify_one();
  thread_.join();
}

void InkThread::rethrow() const {
  if (thrown_) std::rethrow_exception(thrown_);
}

void InkThread::step() {
  {
    std::unique_lock lock(mutex_);
    done_.wait(lock, [this] { return thrown_ || behind_ < most_behind; });
  }
  post({});
}

void InkThread::post(std::function<void(Ink&)> job) {
  {
    const std::lock_guard lock(mutex_);
    rethrow();
    if (!job) ++behind_;
    jobs_.push_back(std::move(job));
  }
  asked_.notify_one();
}

int InkThread::behind() const {
  const std::lock_guard lock(mutex_);
  rethrow();
  return behind_;
}

std::vector<Exchange> InkThread::answers() {
  const std::lock_guard lock(mutex_);
  rethrow();
  return std::exchange(answers_, {});
}

std::vector<Exchange> InkThread::wait_for_answers() {
  std::unique_lock lock(mutex_);
  done_.wait(lock, [this] { return thrown_ || !answers_.empty() || jobs_.empty(); });
  rethrow();
  return std::exchange(answers_, {});
}

Ink& InkThread::caught_up() {
  std::unique_lock lock(mutex_);
  done_.wait(lock, [this] { return thrown_ || jobs_.empty(); });
  rethrow();
  return *ink_;
}

std::vector<double> InkThread::step_ms() {
  const std::lock_guard lock(mutex_);
  return std::exchange(step_ms_, {});
}

void InkThread::serve() {
  std::unique_lock lock(mutex_);
  for (;;) {
    asked_.wait(lock, [this] { return stopping_ || !jobs_.empty(); });
    if (jobs_.empty()) return;
    try {
      do_next(lock);
    } catch (...) {
      lock.lock();
      thrown_ = std::current_exception();
      done_.notify_all();
      return;
    }
    done_.notify_all();
  }
}

// Gives the lock back while the ink works; where that throws, it is left unlocked.
void InkThread::do_next(std::unique_lock<std::mutex>& lock) {
  using Clock = std::chrono::steady_clock;
  const std::function<void(Ink&)> job = std::move(jobs_.front());
  lock.unlock();
  const auto start = Clock::now();
  if (job)
    job(*ink_);
  else
    ink_->step();
  std::vector<Exchange> answers = ink_->collect();
  const double ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  lock.lock();
  jobs_.pop_front();
  std::move(answers.begin(), answers.end(), std::back_inserter(answers_));
  if (job) return;
  --behind_;
  step_ms_.push_back(ms);
}

}  // namespace fude
