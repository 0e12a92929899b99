// The packets of fude's receiver board (firmware-notes/ultrasonic.md), both ways: a board is simulated
// with the same text.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/byte_order.h"
#include "signal/range_sample.h"

namespace fude::ultrasonic {

inline constexpr std::uint8_t protocol_version = 1;
inline constexpr std::size_t longest_packet = 64;

enum class PacketKind : std::uint8_t { pulse = 1, board = 2, describe = 0x10, start = 0x11, stop = 0x12 };

struct Pulse {
  std::uint16_t sequence = 0;
  std::uint32_t tick_us = 0;  // when the pulse left
  std::optional<double> temperature_c;
  std::uint8_t emitter = 0;
  std::uint8_t receivers = 0;
  std::array<std::optional<std::uint32_t>, most_receivers> flight_ns{};
  std::array<std::uint16_t, most_receivers> amplitude{};  // of 65535
};

struct Board {
  std::uint8_t firmware_major = 0;
  std::uint8_t firmware_minor = 0;
  std::uint8_t receivers = 0;
  std::uint16_t resolution_ns = 0;
  std::uint16_t rate_hz = 0;
  std::string serial;  // printable ASCII, 16 at most
};

// Of a packet that stands: version, checksum. None else.
std::optional<PacketKind> kind_of(Bytes packet);

// None for another kind or length, or a count of receivers beyond eight.
std::optional<Pulse> read_pulse(Bytes packet);
std::optional<Board> read_board(Bytes packet);

std::vector<std::byte> write_pulse(const Pulse& pulse);
std::vector<std::byte> write_board(const Board& board);
std::vector<std::byte> write_command(PacketKind command);

// On the wire: stuffed, with the zero that ends it.
std::vector<std::byte> framed(Bytes packet);

}  // namespace fude::ultrasonic
