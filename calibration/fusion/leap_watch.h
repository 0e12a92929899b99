// One time stamp far ahead of all others is a slip of a clock; several are a pause.
#pragma once

#include "signal/timestamp.h"

namespace fude {

class LeapWatch {
 public:
  // False: over 5 s after `newest`, and the sample before was not. Believed once another one agrees.
  bool believes(Timestamp newest, Timestamp time) {
    const bool far = time - newest > farthest;
    const Duration apart = time - ahead_;
    const bool agreed = leapt_ && -farthest <= apart && apart <= farthest;
    leapt_ = far;
    ahead_ = time;
    return !far || agreed;
  }

 private:
  static constexpr Duration farthest = std::chrono::seconds(5);
  bool leapt_ = false;
  Timestamp ahead_{};  // the sample before
};

}  // namespace fude
