#include "drivers/falcon/message.h"

namespace fude::falcon {
namespace {

constexpr std::uint8_t begin_mark = '<';
constexpr std::uint8_t end_mark = '>';
constexpr std::uint8_t zero = 'A';  // what a nibble of nought is sent as
constexpr std::size_t numbers_at = 1;
constexpr std::size_t flags_at = 13;

bool is_number(Bytes message) {
  for (std::size_t i = numbers_at; i < flags_at; ++i)
    if (octet(message, i) < zero || octet(message, i) > zero + 15) return false;
  return octet(message, flags_at) >= zero;
}

// Four nibbles, the lowest first.
std::array<std::int16_t, 3> numbers(Bytes message) {
  std::array<std::int16_t, 3> values{};
  for (std::size_t i = 0; i < 3; ++i) {
    unsigned value = 0;
    for (std::size_t k = 0; k < 4; ++k)
      value |= static_cast<unsigned>(octet(message, numbers_at + 4 * i + k) - zero) << (4 * k);
    values[i] = static_cast<std::int16_t>(static_cast<std::uint16_t>(value));
  }
  return values;
}

std::vector<std::byte> written(const std::array<std::int16_t, 3>& values, unsigned flags) {
  auto message = octets({begin_mark});
  for (std::int16_t value : values)
    for (unsigned k = 0; k < 4; ++k)
      message.push_back(static_cast<std::byte>(zero + (static_cast<std::uint16_t>(value) >> (4 * k) & 15u)));
  message.push_back(static_cast<std::byte>(zero + flags));
  message.push_back(static_cast<std::byte>(zero));
  message.push_back(static_cast<std::byte>(end_mark));
  return message;
}

bool is_message(Bytes message) {
  return message.size() == message_length && octet(message, 0) == begin_mark &&
         octet(message, message_length - 1) == end_mark && is_number(message);
}

}  // namespace

FrameFit fit_message(Bytes bytes) {
  if (octet(bytes, 0) != begin_mark) return {FrameFit::Kind::none};
  if (bytes.size() < message_length) return {FrameFit::Kind::needs_more};
  if (!is_message(bytes.first(message_length))) return {FrameFit::Kind::damaged};
  return {FrameFit::Kind::whole, message_length};
}

std::optional<FromArm> read_from_arm(Bytes message) {
  if (!is_message(message)) return std::nullopt;
  const unsigned flags = octet(message, flags_at) - unsigned{zero};
  return FromArm{numbers(message), static_cast<std::uint8_t>(flags >> 4 & 7),
                 static_cast<std::uint8_t>(flags & 15)};
}

std::optional<ToArm> read_to_arm(Bytes message) {
  if (!is_message(message)) return std::nullopt;
  const unsigned flags = octet(message, flags_at) - unsigned{zero};
  return ToArm{numbers(message), static_cast<std::uint8_t>(flags & 14), (flags & 1) != 0};
}

std::vector<std::byte> write_from_arm(const FromArm& message) {
  return written(message.encoders, (message.homed & 7u) << 4 | (message.buttons & 15u));
}

std::vector<std::byte> write_to_arm(const ToArm& message) {
  return written(message.motors, (message.light & 14u) | (message.homing ? 1u : 0u));
}

}  // namespace fude::falcon
