// Recordings of Linux input devices by evemu (`evemu-record`), formats 1.0 to 1.3:
//   E: <seconds>.<microseconds> <type> <code> <value>    type and code hexadecimal
// after a description of the device that may also stand in a file of its own.
#pragma once

#include <string_view>

#include "capture/import/recording.h"
#include "signal/result.h"

namespace fude {

bool looks_like_evemu(std::string_view text);

// Without a description the events are kept raw; without events the recording is empty.
// Errors: malformed, with the line number.
Result<RawRecording> import_evemu(std::string_view text);

// Errors: malformed, with the line number; not_found when the text describes no device.
Result<DeviceDescription> read_evemu_description(std::string_view text);

}  // namespace fude
