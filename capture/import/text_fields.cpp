#include "capture/import/text_fields.h"

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

}  // namespace fude
