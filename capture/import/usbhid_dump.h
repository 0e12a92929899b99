// Dumps by `usbhid-dump`: blocks that begin with bus:device:interface:STREAM (or DESCRIPTOR) and seconds,
// then bytes in hexadecimal up to an empty line. A dump does not name its device: that may stand beside it,
// as the DIGImend project writes it (index.md: VID, PID, product, working_area, pressure_levels).
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "capture/import/recording.h"
#include "signal/result.h"

namespace fude {

bool looks_like_usbhid_dump(std::string_view text);

// One recording for each bus:device:interface; a DESCRIPTOR block becomes its report descriptor, each STREAM
// block a hid_report. Errors: malformed where no block can be read.
Result<std::vector<RawRecording>> import_usbhid_dump(std::string_view text);

// The tablet that such a page describes, its area in counts from 0; none where it names no vendor and
// product.
std::optional<DeviceDescription> read_tablet_page(std::string_view text);

}  // namespace fude
