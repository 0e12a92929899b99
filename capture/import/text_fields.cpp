#include "capture/import/text_fields.h"

#include <cmath>
#include <cstdint>

namespace fude {

std::optional<Duration> whole_seconds(std::string_view field) {
  const std::size_t point = field.find('.');
  const auto whole = whole_integer<std::uint32_t>(field.substr(0, point));
  if (!whole) return std::nullopt;
  Duration time = std::chrono::seconds(*whole);
  if (point == std::string_view::npos) return time;

  const std::string_view decimals = field.substr(point + 1);
  const auto fraction = whole_integer<std::uint32_t>(decimals);
  if (!fraction || decimals.size() > 9) return std::nullopt;
  std::int64_t nanoseconds = *fraction;
  for (std::size_t i = decimals.size(); i < 9; ++i) nanoseconds *= 10;
  return time + Duration(nanoseconds);
}

std::optional<Duration> any_seconds(std::string_view field) {
  if (const auto exact = whole_seconds(field)) return exact;
  const auto real = whole_real(field);
  if (!real || !(*real >= 0 && *real < longest_time_s)) return std::nullopt;
  return Duration(std::llround(*real * 1e9));
}

std::optional<std::byte> hexadecimal_byte(std::string_view field) {
  if (field.starts_with("0x") || field.starts_with("0X")) field.remove_prefix(2);
  const auto number = whole_integer<std::uint8_t>(field, 16);
  return number ? std::optional(static_cast<std::byte>(*number)) : std::nullopt;
}

}  // namespace fude
