// One complete report of a pen on a tablet: the state at the end of a SYN_REPORT frame.
#pragma once

#include <cstdint>
#include <optional>

#include "signal/timestamp.h"
#include "signal/units.h"

namespace fude {

enum class PenTool : std::uint8_t { none, pen, rubber, brush, pencil, airbrush };

// Positions are the device's counts: what they mean in millimetres is the mapping's business.
// Angles follow the kernel's signs: tilt_x > 0 leans the pen's upper end to the right, tilt_y > 0
// towards the painter; rotation > 0 turns it clockwise seen from above.
struct PenSample {
  SampleTime time;
  PenTool tool = PenTool::none;   // none: the pen has left
  std::uint64_t tool_serial = 0;  // 0 where the device does not say
  std::uint32_t tool_id = 0;      // ABS_MISC, the tool type of Wacom pens
  bool in_proximity = false;
  bool in_contact = false;
  double x_counts = 0;
  double y_counts = 0;
  Fraction pressure;  // of the device's own range
  std::int32_t pressure_raw = 0;
  std::optional<Radians> tilt_x;
  std::optional<Radians> tilt_y;
  std::optional<Radians> rotation;  // of the barrel
  std::optional<Fraction> distance;
  std::optional<Fraction> wheel;  // airbrush finger wheel
  std::uint32_t buttons = 0;      // bit 0 BTN_STYLUS, bit 1 BTN_STYLUS2, bit 2 BTN_STYLUS3
  bool after_gap = false;         // events were lost before this sample (SYN_DROPPED, unplug)
  bool operator==(const PenSample&) const = default;
};

}  // namespace fude
