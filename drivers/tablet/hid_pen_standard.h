// Pens whose report descriptor says where each value stands (HID Usage Tables, digitizer page).
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "drivers/tablet/hid_pen_wacom.h"
#include "drivers/transport/hid_descriptor.h"

namespace fude::hid_pen {

// The pen's values within one report; none where the descriptor has no such field.
struct StandardPen {
  hid::Field x, y;
  std::optional<hid::Field> tip, in_range, eraser, invert, barrel, second_barrel, pressure, tilt_x, tilt_y,
      twist, serial;
  std::size_t bytes = 0;  // of a report that holds all of them
};

// One for each report that holds a position of a pen. Errors never: a descriptor that cannot be read has
// none.
std::vector<StandardPen> standard_pens(Bytes descriptor);

// The report must begin with its number if it has one. One that ends before any of the values is malformed: a
// pen without its pressure would be one pressed to the full.
PenReport read_standard(const StandardPen& layout, Bytes report, PenSample& pen);

}  // namespace fude::hid_pen
