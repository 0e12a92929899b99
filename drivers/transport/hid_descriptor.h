// A HID report descriptor read into the fields of its reports (Device Class Definition for HID 1.11, 6.2.2).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/byte_order.h"
#include "signal/result.h"

namespace fude::hid {

// A page in the upper sixteen bits, the usage on it in the lower.
using Usage = std::uint32_t;
constexpr Usage usage(std::uint16_t page, std::uint16_t id) { return Usage{page} << 16 | id; }

// One value in an input report. Arrays (keys of a keyboard) and padding are left out.
struct Field {
  std::uint8_t report = 0;      // its number; 0 where reports have none
  std::uint32_t first_bit = 0;  // after the number
  std::uint32_t bits = 0;       // 1 to 32
  Usage usage = 0;
  Usage application = 0;  // of the outermost collection
  std::int32_t logical_minimum = 0;
  std::int32_t logical_maximum = 0;
  std::int32_t physical_minimum = 0;  // both 0: the same as the logical ones
  std::int32_t physical_maximum = 0;
  std::uint32_t unit = 0;  // nibbles of powers; 0x11 centimetres, 0x13 inches, 0x14 degrees, 0x12 radians
  int unit_exponent = 0;   // powers of ten
  bool relative = false;
  bool operator==(const Field&) const = default;
};

struct Descriptor {
  bool numbered = false;  // each report begins with its number
  std::vector<Field> inputs;
};

// At most 4096 fields are kept and 64 collections nested; no descriptor needs more time than its length.
// Errors: malformed where an item is cut off, a pop has no push, a report is longer than 8 KiB or the limits
// are passed.
Result<Descriptor> parse_descriptor(Bytes descriptor);

// How many bytes a report has, its number included, that holds the whole of the field.
std::size_t bytes_through(const Field& field);

// The field's value in a report that begins with its number if it has one; none where the report is another
// or too short. Signed where the logical minimum is.
std::optional<std::int32_t> value(const Field& field, Bytes report);

// The length that the physical range states in millimetres; none where its unit is no length.
std::optional<double> span_mm(const Field& field);

}  // namespace fude::hid
