// What has come for a reader, put there by any thread.
#pragma once

#include <deque>
#include <mutex>
#include <optional>

#include "drivers/transport/waker.h"
#include "signal/transfer.h"

namespace fude {

class Inbox {
 public:
  void put(Transfer transfer);
  std::optional<Transfer> take();
  // Ends the next wait() with `woken`.
  void wake();

  // Until the device (-1: none) is ready or gone, something was put, wake() was called, or the deadline.
  struct Outcome {
    bool ready = false;
    bool gone = false;
    bool woken = false;
    bool late = false;  // the deadline has passed
  };
  Outcome wait(int device, std::optional<Timestamp> deadline);

 private:
  Waker waker_;
  std::mutex mutex_;
  std::deque<Transfer> transfers_;
  bool woken_ = false;
};

}  // namespace fude
