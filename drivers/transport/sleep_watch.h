// Whether the machine has slept: CLOCK_BOOTTIME runs on while it is suspended, CLOCK_MONOTONIC stands still.
// Asking needs no right and no service, and no message can be missed. (A timer that is cancelled when the
// clock is set also fires on resume, but as well when a time server corrects the clock.)
#pragma once

#include <functional>

#include "signal/timestamp.h"

namespace fude {

class SleepWatch {
 public:
  using Clock = std::function<Duration()>;

  SleepWatch();                             // of the machine
  SleepWatch(Clock monotonic, Clock boot);  // the latter runs ahead of the former by all sleep so far

  // Since the last call, or since it was made.
  bool slept();

 private:
  Clock monotonic_, boot_;
  Duration most_;  // what had been slept in all at the last call was not more
};

}  // namespace fude
