// When frames arrived: frame_number and timestamp_unfiltered_s (or t_s). Other columns are not used.
#pragma once

#include <string_view>

#include "capture/import/recording.h"
#include "signal/result.h"

namespace fude {

bool looks_like_timestamps_csv(std::string_view text);

// One tick a row, with the frame number as the device's tick; times are kept as they stand, also where they
// run backwards. Errors: malformed where a column or every row is missing.
Result<RawRecording> import_timestamps_csv(std::string_view text);

}  // namespace fude
