// Recordings by `libinput record`: YAML, one or several devices in a file.
#pragma once

#include <string_view>
#include <vector>

#include "capture/import/recording.h"
#include "signal/result.h"

namespace fude {

bool looks_like_libinput_record(std::string_view text);

// One recording a device, in the order of the file; file version 1. What libinput itself said
// (`- libinput:`) is passed over: the kernel's events are kept whole.
// Errors: malformed, with the line number; unsupported for another file version.
Result<std::vector<RawRecording>> import_libinput_record(std::string_view text);

}  // namespace fude
