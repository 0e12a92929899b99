// The clock that a haptic loop lives by, and the pace it keeps.
#pragma once

#include <cstdint>
#include <optional>

#include "signal/timestamp.h"

namespace fude::falcon {

// Tests move it by hand.
class LoopClock {
 public:
  virtual ~LoopClock() = default;
  virtual Timestamp now() = 0;
  virtual void sleep_until(Timestamp time) = 0;
};

class MonotonicLoopClock final : public LoopClock {
 public:
  Timestamp now() override;
  void sleep_until(Timestamp time) override;
};

// One period after the other, begun at its time or late; periods that were missed are not made up for.
class Pace {
 public:
  struct Counts {
    std::uint64_t periods = 0;
    std::uint64_t late = 0;  // begun more than half a period after their time
    bool operator==(const Counts&) const = default;
  };

  explicit Pace(LoopClock& clock, Duration period = std::chrono::milliseconds(1))
      : clock_(clock), period_(period) {}

  // Sleeps until the next period's time; the first one's is now.
  void wait();

  const Counts& counts() const { return counts_; }

 private:
  LoopClock& clock_;
  Duration period_;
  std::optional<Timestamp> due_;
  Counts counts_;
};

}  // namespace fude::falcon
