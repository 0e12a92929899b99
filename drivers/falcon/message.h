// The messages of a Novint Falcon that runs its firmware (firmware-notes/falcon.md): 16 characters each way.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/frame_stream.h"

namespace fude::falcon {

inline constexpr std::size_t message_length = 16;

enum Light : std::uint8_t { no_light = 0, green = 2, blue = 4, red = 8 };

struct FromArm {
  std::array<std::int16_t, 3> encoders{};
  std::uint8_t homed = 0;    // bit i: leg i knows its zero
  std::uint8_t buttons = 0;  // bit 0 plus, 1 forward, 2 centre, 3 minus
};

struct ToArm {
  std::array<std::int16_t, 3> motors{};
  std::uint8_t light = no_light;
  bool homing = true;  // kept on, or the arm forgets its zero
  bool operator==(const ToArm&) const = default;
};

// For a stream of messages of either direction.
FrameFit fit_message(Bytes bytes);

// None where the bytes are no message.
std::optional<FromArm> read_from_arm(Bytes message);
std::optional<ToArm> read_to_arm(Bytes message);

std::vector<std::byte> write_from_arm(const FromArm& message);
std::vector<std::byte> write_to_arm(const ToArm& message);

}  // namespace fude::falcon
