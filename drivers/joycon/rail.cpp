#include "drivers/joycon/rail.h"

namespace fude::joycon {
namespace {

constexpr std::size_t head_length = 12;

}  // namespace

std::uint8_t rail_checksum(Bytes bytes) {
  unsigned crc = 0;
  for (std::byte byte : bytes) {
    crc ^= std::to_integer<unsigned>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = crc & 0x80 ? (crc << 1 ^ 0x8d) & 0xff : crc << 1;
  }
  return static_cast<std::uint8_t>(crc);
}

// 19 81 03, the count of bytes that follow the fifth, seven bytes of which the last is the checksum of
// the body, the checksum of those seven, the body.
FrameFit fit_rail_packet(Bytes bytes) {
  constexpr std::uint8_t mark[] = {0x19, 0x81, 0x03};
  for (std::size_t i = 0; i < sizeof mark; ++i) {
    if (i == bytes.size()) return {FrameFit::Kind::needs_more};
    if (octet(bytes, i) != mark[i]) return {FrameFit::Kind::none};
  }
  if (bytes.size() < 5) return {FrameFit::Kind::needs_more};
  const std::size_t length = std::size_t{5} + little_endian<std::uint16_t>(bytes, 3);
  if (length < head_length || length > longest_rail_packet) return {FrameFit::Kind::damaged};
  if (bytes.size() < length) return {FrameFit::Kind::needs_more};
  const bool head_holds = rail_checksum(bytes.subspan(4, 7)) == octet(bytes, 11);
  const Bytes body = bytes.subspan(head_length, length - head_length);
  if (!head_holds || (!body.empty() && rail_checksum(body) != octet(bytes, 10)))
    return {FrameFit::Kind::damaged};
  return {FrameFit::Kind::whole, length};
}

Bytes rail_report(Bytes packet) {
  constexpr std::uint8_t controller_report = 0x92;
  if (packet.size() <= head_length || octet(packet, 5) != controller_report) return {};
  return packet.subspan(head_length);
}

}  // namespace fude::joycon
