// What a device is and what it can sense. Identity is vendor, product and serial; a device that
// returns under another node is the same device.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "signal/units.h"

namespace fude {

enum class DeviceKind : std::uint8_t {
  pen_tablet,
  mouse,
  touch,
  tracker,
  imu,
  ultrasonic,
  puck,
  glove,
  haptic,
  camera,
  clock,  // only ticks
  other,
};

// One absolute axis as the kernel states it. `resolution` is counts per mm for positions and counts
// per radian for angles; 0 where the device does not say.
struct AxisRange {
  std::uint16_t code = 0;  // ABS_*
  std::int32_t minimum = 0;
  std::int32_t maximum = 0;
  std::int32_t fuzz = 0;
  std::int32_t flat = 0;
  std::int32_t resolution = 0;
  std::int32_t value = 0;  // where the axis stood when the device was described
  bool operator==(const AxisRange&) const = default;
};

// A device's own counter of time or of reports.
struct DeviceClock {
  int counter_bits = 64;               // it wraps after 8, 16 or 32 bits; 64: never
  std::optional<double> nominal_tick;  // seconds a tick, as the maker states it
  bool operator==(const DeviceClock&) const = default;
};

struct DeviceDescription {
  std::string id;    // "056a:0304:SERIAL"; the serial may be empty
  std::string name;  // as the device calls itself
  DeviceKind kind = DeviceKind::other;
  std::string transport;  // "evdev", "hidraw", "usb", "serial", "v4l2", "network", "text", "mouse"
  std::uint16_t bus = 0;
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::uint16_t version = 0;
  std::string serial;
  std::vector<std::uint16_t> keys;        // KEY_* and BTN_* codes, ascending
  std::vector<std::uint16_t> properties;  // INPUT_PROP_*
  std::vector<AxisRange> axes;            // ascending by code
  std::optional<Millimetres> width;       // active area, where known
  std::optional<Millimetres> height;
  // Millimetres per count, where the source of the recording fixes it (text formats).
  std::optional<double> mm_per_count;
  std::optional<DeviceClock> clock;       // none: its samples carry no ticks
  std::vector<std::byte> hid_descriptor;  // the HID report descriptor; empty where there is none
  bool operator==(const DeviceDescription&) const = default;
};

// The identity: "056a:0304:SERIAL", vendor and product in four hexadecimal digits each.
std::string device_id(const DeviceDescription& device);

}  // namespace fude
