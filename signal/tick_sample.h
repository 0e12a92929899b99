// An event of which only the time is known: a trigger, a frame counter, a metronome.
#pragma once

#include "signal/timestamp.h"

namespace fude {

struct TickSample {
  SampleTime time;
  bool after_gap = false;
  bool operator==(const TickSample&) const = default;
};

}  // namespace fude
