// Files as they come, packed or not.
#pragma once

#include <string>
#include <string_view>

#include "signal/result.h"

namespace fude {

// What an import may take, packed or not: about three hours of a pen at 200 reports a second.
inline constexpr std::size_t largest_import = std::size_t{256} << 20;

bool is_gzip(std::string_view bytes);

// The content of a gzip file of one or more members.
// Errors: malformed when it is damaged or cut short, unsupported beyond largest_import.
Result<std::string> unpack_gzip(std::string_view bytes);

}  // namespace fude
