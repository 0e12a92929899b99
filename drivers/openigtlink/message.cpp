#include "drivers/openigtlink/message.h"

#include <algorithm>
#include <array>

namespace fude::openigtlink {
namespace {

constexpr std::size_t type_length = 12;
constexpr std::size_t device_length = 20;
constexpr std::uint64_t longest_foreign = std::uint64_t{256} << 20;
constexpr std::string_view pose_types[] = {"TRANSFORM", "TDATA", "QTDATA", "POSITION", "QTRANS", "STATUS"};

constexpr auto checksum_table = [] {
  std::array<std::uint64_t, 256> table{};
  for (std::uint64_t i = 0; i < 256; ++i) {
    std::uint64_t crc = i << 56;
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 63 ? crc << 1 ^ 0x42f0e1eba9ea3693 : crc << 1;
    table[i] = crc;
  }
  return table;
}();

std::string text(Bytes bytes, std::size_t at, std::size_t length) {
  std::string value;
  for (std::size_t i = 0; i < length && bytes[at + i] != std::byte{0}; ++i)
    value.push_back(static_cast<char>(bytes[at + i]));
  return value;
}

// Printable up to the first zero, zeros behind.
bool is_name(Bytes bytes, std::size_t at, std::size_t length) {
  bool ended = false;
  for (std::size_t i = at; i < at + length; ++i) {
    const std::uint8_t c = octet(bytes, i);
    if (ended ? c != 0 : c != 0 && (c < 0x20 || c == 0x7f)) return false;
    ended = ended || c == 0;
  }
  return true;
}

bool is_header(Bytes bytes) {
  const auto version = big_endian<std::uint16_t>(bytes, 0);
  return version >= 1 && version <= 3 && bytes[2] != std::byte{0} && is_name(bytes, 2, type_length);
}

bool checksum_holds(Bytes message) {
  return checksum(message.subspan(header_length)) == big_endian<std::uint64_t>(message, 50);
}

// Since version 2 an extended header stands before the content and metadata behind it.
std::optional<Bytes> content_of(Bytes body) {
  constexpr std::size_t least = 12;
  if (body.size() < least) return std::nullopt;
  const std::size_t extended = big_endian<std::uint16_t>(body, 0);
  const std::size_t behind =
      std::size_t{big_endian<std::uint16_t>(body, 2)} + big_endian<std::uint32_t>(body, 4);
  if (extended < least || extended > body.size() || behind > body.size() - extended) return std::nullopt;
  return body.subspan(extended, body.size() - extended - behind);
}

void put_text(std::vector<std::byte>& bytes, std::string_view value, std::size_t length) {
  for (std::size_t i = 0; i < length; ++i)
    bytes.push_back(i < value.size() ? static_cast<std::byte>(value[i]) : std::byte{0});
}

}  // namespace

std::uint64_t checksum(Bytes bytes) {
  std::uint64_t crc = 0;
  for (std::byte byte : bytes)
    crc = crc << 8 ^ checksum_table[crc >> 56 ^ std::to_integer<std::uint64_t>(byte)];
  return crc;
}

FrameFit fit_message(Bytes bytes) {
  // What is there of a header must already look like one, or every 00 01 would be waited for.
  if (bytes.size() >= 1 && bytes[0] != std::byte{0}) return {FrameFit::Kind::none};
  if (bytes.size() >= 2 && (octet(bytes, 1) < 1 || octet(bytes, 1) > 3)) return {FrameFit::Kind::none};
  if (bytes.size() < header_length) return {FrameFit::Kind::needs_more};
  if (!is_header(bytes)) return {FrameFit::Kind::none};
  const auto body = big_endian<std::uint64_t>(bytes, 42);
  const std::string type = text(bytes, 2, type_length);
  if (std::find(std::begin(pose_types), std::end(pose_types), type) == std::end(pose_types)) {
    if (body > longest_foreign) return {FrameFit::Kind::damaged, header_length};
    return {FrameFit::Kind::foreign, header_length + static_cast<std::size_t>(body)};
  }
  if (body > longest_message - header_length) return {FrameFit::Kind::damaged, header_length};
  const std::size_t length = header_length + static_cast<std::size_t>(body);
  if (bytes.size() < length) return {FrameFit::Kind::needs_more};
  if (!checksum_holds(bytes.first(length))) return {FrameFit::Kind::damaged, header_length};
  return {FrameFit::Kind::whole, length};
}

std::optional<Message> read_message(Bytes bytes) {
  if (bytes.size() < header_length || bytes.size() > longest_message || !is_header(bytes))
    return std::nullopt;
  if (big_endian<std::uint64_t>(bytes, 42) != bytes.size() - header_length || !checksum_holds(bytes))
    return std::nullopt;
  const Bytes body = bytes.subspan(header_length);
  const bool extended = big_endian<std::uint16_t>(bytes, 0) >= 2;
  const auto content = extended ? content_of(body) : std::optional(body);
  if (!content) return std::nullopt;
  return Message{text(bytes, 2, type_length), text(bytes, 14, device_length),
                 big_endian<std::uint64_t>(bytes, 34), *content};
}

std::vector<std::byte> write_message(std::string_view type, std::string_view device, std::uint64_t stamp,
                                     Bytes content) {
  std::vector<std::byte> bytes;
  bytes.reserve(header_length + content.size());
  put_big_endian(bytes, std::uint16_t{1});
  put_text(bytes, type, type_length);
  put_text(bytes, device, device_length);
  put_big_endian(bytes, stamp);
  put_big_endian(bytes, std::uint64_t{content.size()});
  put_big_endian(bytes, checksum(content));
  append(bytes, content);
  return bytes;
}

std::uint64_t stamp_us(std::uint64_t stamp) {
  return (stamp >> 32) * 1'000'000 + (((stamp & 0xffffffff) * 1'000'000 + 0x80000000) >> 32);
}

std::uint64_t stamp_of_us(std::uint64_t microseconds) {
  return (microseconds / 1'000'000) << 32 | (((microseconds % 1'000'000) << 32) / 1'000'000);
}

}  // namespace fude::openigtlink
