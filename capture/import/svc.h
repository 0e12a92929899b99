// Handwriting as `.svc` files: the number of rows, then rows of seven fields between blanks: x mm, y mm
// (taken to grow towards the painter), t s, status (1 down, 0 hovering), azimuth and altitude in tenths of a
// degree, pressure 0 to 1.
#pragma once

#include <string_view>

#include "capture/import/recording.h"
#include "signal/result.h"

namespace fude {

bool looks_like_svc(std::string_view text);

// Rows that cannot be understood are passed over and counted, as is a number of rows that is not the stated
// one. Errors: malformed where the first line or every row is.
Result<RawRecording> import_svc(std::string_view text);

}  // namespace fude
