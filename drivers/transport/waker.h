// Waiting for a device in one thread, and ending the wait from another.
#pragma once

#include <optional>

#include "drivers/transport/file_descriptor.h"
#include "signal/timestamp.h"

namespace fude {

Timestamp monotonic_now();

class Waker {
 public:
  Waker();

  void wake();

  struct Outcome {
    bool ready = false;  // there is something to read
    bool gone = false;   // the other end has hung up; there may still be something to read
    bool woken = false;  // wake() was called, and is used up
  };
  // Until one of these, or the deadline (then none of them).
  Outcome wait(int device, std::optional<Timestamp> deadline);

 private:
  FileDescriptor event_;
};

}  // namespace fude
