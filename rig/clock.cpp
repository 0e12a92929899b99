#include "rig/clock.h"

#include <algorithm>

namespace fude {
namespace {

constexpr int no_device = -1;

}  // namespace

bool SystemClock::wait(Timestamp time, Waker& waker) {
  // A signal may end a wait early.
  for (;;) {
    if (waker.wait(no_device, time).woken) return false;
    if (now() >= time) return true;
  }
}

Timestamp ManualClock::now() const {
  const std::lock_guard lock(mutex_);
  return now_;
}

bool ManualClock::wait(Timestamp time, Waker& waker) {
  constexpr Timestamp long_ago{};
  if (waker.wait(no_device, long_ago).woken) return false;
  const std::lock_guard lock(mutex_);
  now_ = std::max(now_, time);
  return true;
}

}  // namespace fude
