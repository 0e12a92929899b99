// Ctrl-C and kill, waited for in one place, so that work can be ended in good order.
#pragma once

#include <optional>

#include "signal/timestamp.h"

namespace fude {

// Holds SIGINT and SIGTERM back from every thread that is started after it.
class InterruptWatch {
 public:
  InterruptWatch();
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

  // Until one of them comes (true) or the time has passed (false; never, without one).
  bool wait(std::optional<Duration> duration);
};

}  // namespace fude
