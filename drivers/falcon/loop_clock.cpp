#include "drivers/falcon/loop_clock.h"

#include <ctime>

#include "drivers/transport/waker.h"

namespace fude::falcon {

Timestamp MonotonicLoopClock::now() { return monotonic_now(); }

void MonotonicLoopClock::sleep_until(Timestamp time) {
  const auto since = time.time_since_epoch();
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(since);
  const timespec until{static_cast<time_t>(whole.count()), static_cast<long>((since - whole).count())};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) != 0) continue;
}

void Pace::wait() {
  if (due_) clock_.sleep_until(*due_);
  const Timestamp now = clock_.now();
  if (due_ && now - *due_ > period_ / 2) {
    ++counts_.late;
    due_ = now;
  }
  due_ = due_.value_or(now) + period_;
  ++counts_.periods;
}

}  // namespace fude::falcon
