// What a device says now, as a page of text.
#pragma once

#include <optional>
#include <string>

#include "rig/stream_meter.h"
#include "signal/device.h"
#include "signal/sample.h"

namespace fude {

// Every column of the latest sample by name, rate and jitter with its histogram, losses; of a pen with tilt
// also where its upper end leans, seen from above, on a dial of 60° about the middle. Lines of at most 78
// characters, each ended.
std::string monitor_page(const DeviceDescription& device, const std::optional<Sample>& latest,
                         const StreamFigures& figures);

}  // namespace fude
