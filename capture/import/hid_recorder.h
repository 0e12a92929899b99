// Recordings by `hid-recorder`: for each device R: (length and bytes of its report descriptor), N:, P:, I:
// (bus, vendor, product in hexadecimal), then E: <seconds> <length> <bytes>, one input report. D: says whose
// lines follow.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "capture/import/recording.h"
#include "signal/result.h"

namespace fude {

bool looks_like_hid_recorder(std::string_view text);

// One recording a device, in the order of their first line. Reports are kept raw as hid_report transfers,
// those without numbers behind a 0. Lines that cannot be understood, reports shorter or longer than they say,
// and times that run backwards are passed over and counted. Errors: malformed where nothing is a line of that
// format.
Result<std::vector<RawRecording>> import_hid_recorder(std::string_view text);

// Whether a descriptor gives its reports numbers.
bool numbers_reports(std::span<const std::byte> descriptor);

}  // namespace fude
