// Numbers inside a report. The caller has checked that the bytes are there.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <type_traits>
#include <vector>

namespace fude {

using Bytes = std::span<const std::byte>;

template <std::integral T>
T little_endian(Bytes bytes, std::size_t at) {
  std::make_unsigned_t<T> value = 0;
  for (std::size_t i = sizeof(T); i-- > 0;)
    value = static_cast<std::make_unsigned_t<T>>(std::uint64_t{value} << 8 |
                                                 std::to_integer<std::uint64_t>(bytes[at + i]));
  return static_cast<T>(value);
}

template <std::integral T>
T big_endian(Bytes bytes, std::size_t at) {
  std::make_unsigned_t<T> value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i)
    value = static_cast<std::make_unsigned_t<T>>(std::uint64_t{value} << 8 |
                                                 std::to_integer<std::uint64_t>(bytes[at + i]));
  return static_cast<T>(value);
}

inline std::uint8_t octet(Bytes bytes, std::size_t at) { return std::to_integer<std::uint8_t>(bytes[at]); }

template <std::integral T>
void put_little_endian(std::vector<std::byte>& bytes, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i)
    bytes.push_back(static_cast<std::byte>(
        static_cast<std::uint64_t>(static_cast<std::make_unsigned_t<T>>(value)) >> (8 * i)));
}

template <std::integral T>
void put_big_endian(std::vector<std::byte>& bytes, T value) {
  for (std::size_t i = sizeof(T); i-- > 0;)
    bytes.push_back(static_cast<std::byte>(
        static_cast<std::uint64_t>(static_cast<std::make_unsigned_t<T>>(value)) >> (8 * i)));
}

inline std::vector<std::byte> octets(std::initializer_list<unsigned> values) {
  std::vector<std::byte> bytes;
  bytes.reserve(values.size());
  for (unsigned value : values) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

inline void append(std::vector<std::byte>& bytes, Bytes more) {
  bytes.insert(bytes.end(), more.begin(), more.end());
}

}  // namespace fude
