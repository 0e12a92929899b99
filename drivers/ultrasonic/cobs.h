// Consistent Overhead Byte Stuffing (Cheshire and Baker 1999): a packet without zeros, so that a zero can
// end it and a reader that comes in the middle is right again at the next.
#pragma once

#include <optional>
#include <vector>

#include "drivers/byte_order.h"

namespace fude::ultrasonic {

// Without the zero at the end.
std::vector<std::byte> stuffed(Bytes packet);

// None where the bytes are no stuffed packet.
std::optional<std::vector<std::byte>> unstuffed(Bytes bytes);

}  // namespace fude::ultrasonic
