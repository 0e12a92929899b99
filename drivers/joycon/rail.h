// The wire between a Joy-Con and the rail it slides into (UART): packets that hold the same reports,
// each with a checksum of its head and of its body.
#pragma once

#include "drivers/frame_stream.h"

namespace fude::joycon {

inline constexpr std::size_t longest_rail_packet = 64;

// Whole: a packet from the controller whose checksums hold.
FrameFit fit_rail_packet(Bytes bytes);

// The HID report inside a whole packet; empty where it carries none.
Bytes rail_report(Bytes packet);

// CRC-8, polynomial 0x8d, from zero.
std::uint8_t rail_checksum(Bytes bytes);

}  // namespace fude::joycon
