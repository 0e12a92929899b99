// The reports of fude's brush handle (firmware-notes/brush-handle.md), both ways: a handle is simulated
// with the same text.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/byte_order.h"

namespace fude::handle {

inline constexpr std::uint8_t protocol_version = 1;
inline constexpr std::uint8_t motion_number = 1;
inline constexpr std::uint8_t scale_number = 2;
inline constexpr std::size_t motion_length = 34;
inline constexpr std::size_t scale_length = 32;

struct Motion {
  std::uint16_t sequence = 0;
  std::uint32_t tick_us = 0;
  std::array<std::int16_t, 3> turn_rate{};
  std::array<std::int16_t, 3> specific_force{};
  std::array<std::int16_t, 3> magnetic_field{};
  std::optional<double> temperature_c;  // of the sensor
  std::uint8_t buttons = 0;
  bool magnetic_field_is_new = false;
  bool measured = true;           // false: the sensor did not answer and the numbers say nothing
  std::optional<double> battery;  // 0 to 1
};

// What 32768 counts are, and who it is.
struct Scale {
  std::uint16_t turn_rate_degps = 0;
  std::uint16_t specific_force_mg = 0;
  std::uint16_t magnetic_field_ut = 0;
  std::uint16_t rate_hz = 0;
  std::uint8_t firmware_major = 0;
  std::uint8_t firmware_minor = 0;
  std::uint8_t buttons = 0;
  bool has_magnetometer = false;
  std::string serial;  // printable ASCII, 16 at most
};

// None for another length, number, version or a wrong checksum, or (the scale) a range of zero.
std::optional<Motion> read_motion(Bytes report);
std::optional<Scale> read_scale(Bytes report);

std::vector<std::byte> write_motion(const Motion& motion);
std::vector<std::byte> write_scale(const Scale& scale);

}  // namespace fude::handle
