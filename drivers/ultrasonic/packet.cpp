#include "drivers/ultrasonic/packet.h"

#include <cmath>

#include "drivers/crc16.h"
#include "drivers/ultrasonic/cobs.h"

namespace fude::ultrasonic {
namespace {

constexpr std::size_t head_length = 12;
constexpr std::size_t receiver_length = 6;
constexpr std::size_t board_length = 27;
constexpr std::size_t serial_length = 16;
constexpr std::uint32_t not_heard = 0xffffffff;
constexpr std::uint32_t longest_flight_ns = 100'000'000;  // 34 m
constexpr std::int16_t no_temperature = INT16_MIN;

}  // namespace

std::optional<PacketKind> kind_of(Bytes packet) {
  if (packet.size() < 4 || octet(packet, 0) != protocol_version || !crc16_holds(packet)) return std::nullopt;
  return static_cast<PacketKind>(octet(packet, 1));
}

std::optional<Pulse> read_pulse(Bytes packet) {
  if (kind_of(packet) != PacketKind::pulse || packet.size() < head_length + 2) return std::nullopt;
  Pulse pulse;
  pulse.receivers = octet(packet, 10);
  if (pulse.receivers > most_receivers ||
      packet.size() != head_length + pulse.receivers * receiver_length + 2)
    return std::nullopt;
  pulse.emitter = octet(packet, 11);
  pulse.sequence = little_endian<std::uint16_t>(packet, 2);
  pulse.tick_us = little_endian<std::uint32_t>(packet, 4);
  const auto hundredths = little_endian<std::int16_t>(packet, 8);
  if (hundredths != no_temperature) pulse.temperature_c = hundredths / 100.0;
  for (std::size_t i = 0; i < pulse.receivers; ++i) {
    const std::size_t at = head_length + i * receiver_length;
    const auto flight_ns = little_endian<std::uint32_t>(packet, at);
    if (flight_ns <= longest_flight_ns) pulse.flight_ns[i] = flight_ns;
    pulse.amplitude[i] = little_endian<std::uint16_t>(packet, at + 4);
  }
  return pulse;
}

std::optional<Board> read_board(Bytes packet) {
  if (kind_of(packet) != PacketKind::board || packet.size() != board_length) return std::nullopt;
  Board board;
  board.firmware_major = octet(packet, 2);
  board.firmware_minor = octet(packet, 3);
  board.receivers = octet(packet, 4);
  board.resolution_ns = little_endian<std::uint16_t>(packet, 5);
  board.rate_hz = little_endian<std::uint16_t>(packet, 7);
  for (std::size_t i = 0; i < serial_length; ++i) {
    const char c = static_cast<char>(octet(packet, 9 + i));
    if (c == 0) break;
    if (c < 0x21 || c > 0x7e) return std::nullopt;
    board.serial.push_back(c);
  }
  if (board.receivers > most_receivers) return std::nullopt;
  return board;
}

std::vector<std::byte> write_pulse(const Pulse& pulse) {
  auto packet = octets({protocol_version, static_cast<unsigned>(PacketKind::pulse)});
  put_little_endian(packet, pulse.sequence);
  put_little_endian(packet, pulse.tick_us);
  put_little_endian(packet, pulse.temperature_c
                                ? static_cast<std::int16_t>(std::lround(*pulse.temperature_c * 100))
                                : no_temperature);
  packet.push_back(static_cast<std::byte>(pulse.receivers));
  packet.push_back(static_cast<std::byte>(pulse.emitter));
  for (std::size_t i = 0; i < pulse.receivers; ++i) {
    put_little_endian(packet, pulse.flight_ns[i].value_or(not_heard));
    put_little_endian(packet, pulse.amplitude[i]);
  }
  put_crc16(packet);
  return packet;
}

std::vector<std::byte> write_board(const Board& board) {
  auto packet = octets({protocol_version, static_cast<unsigned>(PacketKind::board), board.firmware_major,
                        board.firmware_minor, board.receivers});
  put_little_endian(packet, board.resolution_ns);
  put_little_endian(packet, board.rate_hz);
  for (std::size_t i = 0; i < serial_length; ++i)
    packet.push_back(i < board.serial.size() ? static_cast<std::byte>(board.serial[i]) : std::byte{0});
  put_crc16(packet);
  return packet;
}

std::vector<std::byte> write_command(PacketKind command) {
  auto packet = octets({protocol_version, static_cast<unsigned>(command)});
  put_crc16(packet);
  return packet;
}

std::vector<std::byte> framed(Bytes packet) {
  auto bytes = stuffed(packet);
  bytes.push_back(std::byte{0});
  return bytes;
}

}  // namespace fude::ultrasonic
