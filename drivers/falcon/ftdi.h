// The serial chip in a Falcon (FTDI): its control requests, and the status that it puts before what it has
// read.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/byte_order.h"
#include "signal/transfer.h"

namespace fude::falcon {

inline constexpr std::uint8_t bulk_in = 0x81;
inline constexpr std::uint8_t bulk_out = 0x02;

// Requests (vendor, to the device, no data) by number and value.
Transfer purge_received();
Transfer purge_sent();
Transfer latency_ms(std::uint8_t milliseconds);
Transfer baud_divisor(std::uint16_t divisor);
Transfer eight_bits();
Transfer no_flow_control();
Transfer rts(bool high);
Transfer dtr(bool high);

Transfer bulk(std::vector<std::byte> bytes);

// What the chip has read: each packet of 64 bytes in a transfer begins with two of status.
std::vector<std::byte> without_status(Bytes transfer);

}  // namespace fude::falcon
