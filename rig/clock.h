// What time it is, and waiting for a time: on the machine's own clock, or on one that moves only by being
// waited on.
#pragma once

#include <mutex>

#include "drivers/transport/waker.h"
#include "signal/timestamp.h"

namespace fude {

class Clock {
 public:
  virtual ~Clock() = default;
  virtual Timestamp now() const = 0;

  // Until `time`. False when the waker was woken instead.
  virtual bool wait(Timestamp time, Waker& waker) = 0;
};

// CLOCK_MONOTONIC.
class SystemClock final : public Clock {
 public:
  Timestamp now() const override { return monotonic_now(); }
  bool wait(Timestamp time, Waker& waker) override;
};

// Whoever waits on it has waited: the clock then stands at that time, never at an earlier one. Any thread.
class ManualClock final : public Clock {
 public:
  Timestamp now() const override;
  bool wait(Timestamp time, Waker& waker) override;

 private:
  mutable std::mutex mutex_;
  Timestamp now_{};
};

}  // namespace fude
