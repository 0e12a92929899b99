// One contact on a touch surface at the end of a report; a report with five contacts gives five samples
// with one time and sequence.
#pragma once

#include <cstdint>
#include <optional>

#include "signal/timestamp.h"
#include "signal/units.h"

namespace fude {

// Counts are the device's own, as of a pen; sizes in the units of its axes.
struct TouchSample {
  SampleTime time;
  std::int32_t contact = 0;  // the same for as long as the finger stays down
  bool down = false;         // false once: the finger has left
  double x_counts = 0;
  double y_counts = 0;
  std::optional<double> major_counts;  // length and width of the contact
  std::optional<double> minor_counts;
  std::optional<Radians> orientation;  // of the major axis, from y away from the painter, clockwise
  std::optional<Fraction> pressure;
  bool palm = false;  // the device takes it for no finger
  bool after_gap = false;
  bool operator==(const TouchSample&) const = default;
};

}  // namespace fude
