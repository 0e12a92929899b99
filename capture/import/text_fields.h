// Lines and fields of a text file, and numbers read exactly or not at all.
#pragma once

#include <charconv>
#include <cstddef>
#include <optional>
#include <string_view>
#include <system_error>

#include "signal/timestamp.h"

namespace fude {

// Takes one line off the front of `text`, without its line end (LF or CR LF).
inline std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

// Takes one field, bounded by blanks, off the front of `line`; empty at its end.
inline std::string_view take_field(std::string_view& line) {
  constexpr std::string_view blanks = " \t";
  const std::size_t begin = line.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return line = {};
  line.remove_prefix(begin);
  const std::string_view field = line.substr(0, line.find_first_of(blanks));
  line.remove_prefix(field.size());
  return field;
}

// The whole field as a number of type T, or none. An integer that T cannot hold is none.
template <class T>
std::optional<T> whole_integer(std::string_view field, int base = 10) {
  T value{};
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value, base);
  if (error != std::errc{} || end != field.data() + field.size()) return std::nullopt;
  return value;
}

inline std::optional<double> whole_real(std::string_view field) {
  double value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc{} || end != field.data() + field.size()) return std::nullopt;
  return value;
}

// Times beyond 136 years are refused: nanoseconds in 64 bits hold 292.
inline constexpr double longest_time_s = 4294967296.0;

// "1369413757.964832" to the nanosecond, in integers; none if negative, beyond longest_time_s, or
// with more than nine decimals.
std::optional<Duration> whole_seconds(std::string_view field);

// As above, or any other way to write a number of seconds (1e-3, more decimals), then rounded to the
// nanosecond.
std::optional<Duration> any_seconds(std::string_view field);

// "02" to "ff", with or without 0x before.
std::optional<std::byte> hexadecimal_byte(std::string_view field);

}  // namespace fude
