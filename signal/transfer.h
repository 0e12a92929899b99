// The byte seam: what crossed the wire, with direction, kind and time, so that a whole dialogue can
// be recorded and replayed through the same decoding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "signal/result.h"
#include "signal/timestamp.h"

namespace fude {

enum class Direction : std::uint8_t { from_device, to_device };

enum class TransferKind : std::uint8_t {
  evdev_frame,    // events up to and including one SYN_REPORT (or SYN_DROPPED): see EvdevEvent
  hid_report,     // one input report (from) or output report (to); the first byte is its number, 0 without
  hid_feature,    // one feature report: the answer (from) or a new value (to); first byte as above
  hid_ask,        // to: asks for the feature report whose number is the only byte
  usb_control,    // the 8 bytes of the setup packet, then the data of its own direction, if any
  usb_bulk,       // one transfer of `endpoint`
  usb_interrupt,  // one transfer of `endpoint`
  serial,         // bytes as they came: neither their beginning nor their end means anything
  message,        // one whole network message with its header
  picture,        // one camera frame as it came, or as a recording was asked to keep it
  plugged,        // payload empty; the device appeared
  unplugged,      // payload empty; the device went away
  suspended,      // payload empty; the machine or the device slept, until `plugged`
};

struct Transfer {
  Timestamp time{};
  StampedBy stamped_by = StampedBy::kernel;
  Direction direction = Direction::from_device;
  TransferKind kind = TransferKind::evdev_frame;
  std::vector<std::byte> payload;
  std::uint8_t endpoint = 0;  // a USB endpoint's address; else 0
  bool operator==(const Transfer&) const = default;
};

// One input event without its time: the frame's SYN_REPORT carries it. In a payload each event is
// eight bytes, little-endian: type u16, code u16, value i32.
struct EvdevEvent {
  std::uint16_t type = 0;
  std::uint16_t code = 0;
  std::int32_t value = 0;
  bool operator==(const EvdevEvent&) const = default;
};

std::vector<std::byte> pack_events(std::span<const EvdevEvent> events);

// Errors: malformed when the length is no multiple of eight.
Result<std::vector<EvdevEvent>> unpack_events(std::span<const std::byte> payload);

}  // namespace fude
