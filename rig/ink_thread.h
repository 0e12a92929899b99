// The ink on a thread of its own: what is asked of it runs behind the caller, one thing after the other,
// so that the brush need not wait for a step.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "sim/ink/ink.h"

namespace fude {

// One caller at a time. What the ink threw (no memory, the card has gone) every later call throws again.
class InkThread {
 public:
  explicit InkThread(std::unique_ptr<Ink> ink);
  ~InkThread();  // does what was asked for first
  InkThread(const InkThread&) = delete;
  InkThread& operator=(const InkThread&) = delete;

  // Numbers that never change.
  double step_s() const { return step_s_; }

  // Behind the caller, in the order of the calls. A step waits where too many are to be done already.
  void step();
  void post(std::function<void(Ink&)> job);

  // Steps asked for and not done.
  int behind() const;

  // Answers to events since the last call. wait_for_answers() blocks until there is at least one; it gives
  // none where nothing is left to be done that could bring one.
  std::vector<Exchange> answers();
  std::vector<Exchange> wait_for_answers();

  // The ink when all is done; the caller's own until it asks for the next thing.
  Ink& caught_up();

  // Milliseconds of each step since the last call, in order.
  std::vector<double> step_ms();

 private:
  void serve();
  void do_next(std::unique_lock<std::mutex>& lock);
  void rethrow() const;

  std::unique_ptr<Ink> ink_;
  double step_s_;
  mutable std::mutex mutex_;
  std::condition_variable asked_;
  std::condition_variable done_;
  std::deque<std::function<void(Ink&)>> jobs_;  // the first is the one being done; empty: a step
  int behind_ = 0;
  std::vector<Exchange> answers_;
  std::vector<double> step_ms_;
  std::exception_ptr thrown_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace fude
