// Reports that carry a 16-bit number and a 32-bit tick in microseconds: what was lost, what came twice,
// and whether the device has started again.
#pragma once

#include <cstdint>

#include "drivers/wrapping_counter.h"
#include "signal/timestamp.h"

namespace fude {

class NumberedStream {
 public:
  struct Place {
    bool repeated = false;       // the report before, once more: nothing else holds
    bool restarted = false;      // the device's clock began anew
    std::uint64_t lost = 0;      // reports between; at least one where the device restarted
    std::uint64_t sequence = 0;  // goes on by one a report, and by those lost
    std::uint64_t tick_us = 0;   // carried past its 71 minutes; as the device says after a restart
    bool after_gap = false;
  };

  // `host` tells a wrapped tick from a restarted clock: where the two clocks' steps differ by more than
  // five seconds, or the number goes back, the device has restarted.
  Place place(std::uint16_t number, std::uint32_t tick_us, Timestamp host);

  // The device went away; the next report is after a gap of nobody knows how many.
  void interrupted();

 private:
  WrappingCounter number_{16};
  WrappingCounter tick_{32};
  Timestamp host_{};
  std::uint64_t sequence_ = 0;
  bool interrupted_ = false;
};

}  // namespace fude
